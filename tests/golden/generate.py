"""Writes subspaces.txt: affine subspaces fitted to sets of images, and their distances, for the tests of the C library.

Independent of the library: double precision, numpy's SVD, the definitions as they are written. Run it in its own directory with
`python3 generate.py`; the output is committed, so that the tests need no Python.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[Any]

TOLERANCE = 1e-5  # singular values at most this fraction of the set's Frobenius norm are absent directions

HEADER = """\
# Written by generate.py. Numbers are exact single-precision values in their shortest decimal form. A case:
#
#     case NAME
#     basis centred|raw n N alpha A D d m mA mB
#     mA lines of d numbers, one image each, then mB lines: the second set
#     ranks rA rB          directions present, of n
#     angles t1 .. tn      principal angles, radians, ascending
#     geodesic g           2-norm of the angles
#     mahalanobis q        2 d'd - |UA'd|^2 - |UB'd|^2, d = mean A - mean B
#     distance g + alpha q
#     end
"""


def fit(images: Matrix, centred: bool, n: int) -> tuple[Matrix, Matrix]:
    """Mean and the present ones of n basis vectors, of images in rows."""
    columns = images.astype(np.float64).T
    mean = columns.mean(axis=1)
    about = columns - mean[:, None] if centred else columns
    u, values, _ = np.linalg.svd(about, full_matrices=False)
    rank = int(np.sum(values[:n] > TOLERANCE * np.linalg.norm(columns)))
    return mean, u[:, :rank]


def principal_angles(a: Matrix, b: Matrix, n: int) -> Matrix:
    """Of n directions: those absent from both at 0, those of one alone at pi/2, the rest from the singular values of a'b."""
    ranks = a.shape[1], b.shape[1]
    angles = [0.0] * (n - max(ranks))
    if min(ranks) > 0:
        cosines = np.linalg.svd(a.T @ b, compute_uv=False)
        angles += list(np.arccos(np.clip(cosines, 0.0, 1.0)))
    return np.array(angles + [np.pi / 2] * (max(ranks) - min(ranks)))


def text(value: float) -> str:
    """The shortest decimal that reads back as the same single-precision number."""
    return np.format_float_positional(np.float32(value), unique=True, trim="-")


def write_case(out: TextIO, name: str, basis: str, n: int, alpha: float, first: Matrix, second: Matrix) -> None:
    """One case: both sets, and what their subspaces and the distance between them are."""
    first, second = np.asarray(first, dtype=np.float32), np.asarray(second, dtype=np.float32)
    if first.shape[1] != second.shape[1]:
        raise ValueError(f"{name}: images of {first.shape[1]} and of {second.shape[1]} numbers")
    mean_a, a = fit(first, basis == "centred", n)
    mean_b, b = fit(second, basis == "centred", n)
    angles = principal_angles(a, b, n)
    geodesic = np.sqrt(np.sum(angles**2))
    d = mean_a - mean_b
    mahalanobis = 2 * d @ d - np.sum((a.T @ d) ** 2) - np.sum((b.T @ d) ** 2)

    print(f"case {name}-{basis}", file=out)
    print(f"basis {basis} n {n} alpha {alpha} D {first.shape[1]} m {len(first)} {len(second)}", file=out)
    for image in (*first, *second):
        print(" ".join(text(value) for value in image), file=out)
    print(f"ranks {a.shape[1]} {b.shape[1]}", file=out)
    print("angles", " ".join(f"{angle:.12g}" for angle in angles), file=out)
    print(f"geodesic {geodesic:.12g}", file=out)
    print(f"mahalanobis {mahalanobis:.12g}", file=out)
    print(f"distance {geodesic + alpha * mahalanobis:.12g}", file=out)
    print("end", file=out)


def pixels(rng: np.random.Generator, count: int, dim: int) -> Matrix:
    """Grey values, 0 to 255."""
    return rng.integers(0, 256, (count, dim))


def unit(rng: np.random.Generator, count: int, dim: int) -> Matrix:
    """Numbers in [0, 1) of four digits."""
    return np.round(rng.random((count, dim)), 4)


def at_angles(rng: np.random.Generator, dim: int, angles: Sequence[float]) -> list[Matrix]:
    """Two sets, each of the corners base +- direction, whose centred subspaces have these principal angles."""
    n = len(angles)
    q = np.linalg.qr(rng.standard_normal((dim, 2 * n)))[0]
    turned = q[:, :n] * np.cos(angles) + q[:, n:] * np.sin(angles)
    base = rng.random(dim)
    return [np.vstack([base + u.T, base - u.T]) for u in (q[:, :n], turned)]


def cases(rng: np.random.Generator) -> Iterator[tuple[str, int, float, Matrix, Matrix]]:
    """(name, n, alpha, first set, second set), each for both kinds of basis."""
    for n in range(1, 6):
        yield f"pixels-n{n}", n, 0.01, pixels(rng, n + 1, 100), pixels(rng, n + 2, 100)
        first = unit(rng, 2 * n, 36)
        yield f"near-n{n}", n, 0.64, first, np.round(first + 1e-3 * rng.standard_normal(first.shape), 5)
    for count in (2, 7, 10):
        yield f"count{count}", 3, 10.0, unit(rng, count, 25), unit(rng, 12 - count, 25)

    # Sets that cannot have n directions.
    yield "one-image-each", 3, 0.64, unit(rng, 1, 30), unit(rng, 1, 30)
    yield "one-image-against-five", 4, 0.64, unit(rng, 1, 30), unit(rng, 5, 30)
    yield "two-images-n5", 5, 0.64, unit(rng, 2, 30), unit(rng, 3, 30)
    yield "fewer-pixels-than-images", 2, 0.64, unit(rng, 7, 3), unit(rng, 5, 3)
    yield "two-pixels-n4", 4, 0.64, unit(rng, 5, 2), unit(rng, 3, 2)
    yield "one-pixel", 1, 0.64, unit(rng, 3, 1), unit(rng, 2, 1)

    # One set inside the other's affine hull: angles zero, and pi/2 for what is missing.
    outer = pixels(rng, 5, 50)
    weights = np.array([[0.5, 0.5, 0, 0, 0], [0, 0.5, 0.5, 0, 0], [0, 0, 0.5, 0.5, 0]])
    yield "inside-the-other", 4, 0.01, outer, weights @ outer
    shared = unit(rng, 6, 40)
    yield "shared-images", 3, 0.64, shared[:4], shared[2:]
    yield "repeated-images", 3, 0.64, shared[[0, 1, 1, 1, 2]], shared[[0, 2, 2, 3]]
    yield "permuted", 3, 0.64, shared, shared[[3, 5, 0, 1, 4, 2]]
    yield "shifted", 3, 0.64, shared, shared + np.float32(0.25)
    yield "identical", 3, 0.64, shared, shared

    angles = np.array([0.0, 0.01, 0.3, 1.2, np.pi / 2])
    yield "known-angles", 5, 0.64, *at_angles(rng, 32, angles)

    # Degenerate light.
    tenth = np.full((3, 30), 0.1)
    yield "frozen-flat", 2, 0.64, tenth, tenth
    yield "frozen-against-moving", 3, 0.64, np.repeat(unit(rng, 1, 30), 6, axis=0), unit(rng, 4, 30)
    yield "black-against-white", 2, 0.64, np.zeros((3, 30)), np.ones((4, 30))
    yield "black-against-moving", 3, 0.64, np.zeros((4, 30)), unit(rng, 4, 30)
    yield "bright-and-still", 3, 0.64, 250 + rng.integers(0, 2, (5, 60)), 250 + rng.integers(0, 2, (5, 60))

    # Directions of very different lengths, the least on either side of the tolerance.
    lengths = np.array([1, 1e-1, 1e-2, 1e-3])[:, None]
    yield "graded", 4, 0.64, lengths * rng.standard_normal((4, 64)), lengths * rng.standard_normal((4, 64))
    for name, length in (("above", 2e-5), ("below", 5e-6)):
        base = np.zeros((2, 30))
        base[:, 0] = 1
        base[:, 1] = length, -length
        yield f"{name}-the-tolerance", 2, 0.64, base, unit(rng, 3, 30)


def main() -> None:
    """All cases with both kinds of basis."""
    rng = np.random.default_rng(20130617)
    with Path("subspaces.txt").open("w", encoding="ascii") as out:
        out.write(HEADER)
        for name, n, alpha, first, second in cases(rng):
            for basis in ("centred", "raw"):
                write_case(out, name, basis, n, alpha, first, second)


if __name__ == "__main__":
    main()
