"""The geometry functions against numpy's SVD in float64."""

from typing import Any, Literal

import numpy as np
import pytest
from numpy.typing import NDArray

from asttrack import Distance, Subspace, Tracker, subspace_distance, subspace_fit
from short_scene import BOXES, FRAMES

Array = NDArray[np.float64]
Kind = Literal["centred", "raw"]


def reference_fit(images: Array, kind: Kind, n: int) -> tuple[Array, Array]:
    """Mean, and the basis vectors that are present, of images in rows: the definition, by numpy's SVD."""
    mean = images.mean(axis=0)
    columns = (images - mean if kind == "centred" else images).T
    left, values, _ = np.linalg.svd(columns, full_matrices=False)
    rank = int((values[:n] > 1e-5 * np.linalg.norm(images)).sum())
    return mean, left[:, :rank]


def reference_distance(a: tuple[Array, Array], b: tuple[Array, Array], n: int, alpha: float) -> tuple[Array, float, float, float]:
    """Paper eq. 2 to 5 in float64, absent directions as the interface states them."""
    (mean_a, basis_a), (mean_b, basis_b) = a, b
    absent = sorted((n - basis_a.shape[1], n - basis_b.shape[1]))
    cosines = np.linalg.svd(basis_a.T @ basis_b, compute_uv=False) if absent[1] < n else np.zeros(0)
    angles = np.concatenate([np.zeros(absent[0]), np.arccos(np.clip(cosines, 0, 1)), np.full(absent[1] - absent[0], np.pi / 2)])
    difference = mean_a - mean_b
    mahalanobis = 2 * difference @ difference - np.sum((basis_a.T @ difference) ** 2) - np.sum((basis_b.T @ difference) ** 2)
    geodesic = float(np.linalg.norm(angles))
    return angles, geodesic, float(mahalanobis), geodesic + alpha * float(mahalanobis)


def images_of(random: np.random.Generator, count: int, dim: int) -> Array:
    """Float32 numbers in float64, so that both sides see the same input."""
    return random.normal(size=(count, dim)).astype(np.float32).astype(np.float64)


CASES = [(4, 64, 3), (4, 1024, 3), (16, 256, 8), (2, 100, 1), (1, 50, 2), (3, 50, 8), (9, 6, 6), (5, 1, 1), (7, 3, 8)]


@pytest.mark.parametrize("kind", ["centred", "raw"])
@pytest.mark.parametrize(("count", "dim", "n"), CASES)
def test_the_fit_is_numpys(kind: Kind, count: int, dim: int, n: int) -> None:
    images = images_of(np.random.default_rng(count * dim + n), count, dim)
    fitted = subspace_fit(images, kind, n)
    mean, basis = reference_fit(images, kind, n)
    assert fitted.mean.dtype == fitted.basis.dtype == np.dtype(np.float32)
    assert fitted.basis.shape == (dim, n)
    assert fitted.rank == basis.shape[1]
    np.testing.assert_allclose(fitted.mean, mean, atol=1e-6)
    present = fitted.basis[:, : fitted.rank].astype(np.float64)
    # Each vector is numpy's up to its sign: random images have distinct singular values.
    np.testing.assert_allclose(np.abs(np.sum(present * basis, axis=0)), 1, atol=1e-5)
    np.testing.assert_allclose(present.T @ present, np.eye(fitted.rank), atol=1e-5)
    assert not fitted.basis[:, fitted.rank :].any()


@pytest.mark.parametrize(
    ("images", "kind", "rank"),
    [
        (np.ones((4, 30)), "centred", 0),
        (np.ones((4, 30)), "raw", 1),
        (np.zeros((4, 30)), "raw", 0),
        (np.array([[1.0, 0, 0], [-1, 0, 0], [2, 0, 0]]), "centred", 1),
        (np.eye(3), "centred", 2),
        (np.eye(3), "raw", 3),
        (np.array([[1e-30, 0], [0, 2e-30]]), "raw", 2),
    ],
)
def test_degenerate_sets_have_the_rank_they_have(images: Array, kind: Kind, rank: int) -> None:
    fitted = subspace_fit(images, kind, 3)
    assert fitted.rank == rank == reference_fit(images, kind, 3)[1].shape[1]


def check_distance(got: Distance, expected: tuple[Array, float, float, float]) -> None:
    angles, geodesic, mahalanobis, distance = expected
    # float32 bases: near angle 0 an error of 1e-7 in a cosine is one of 5e-4 in the angle.
    np.testing.assert_allclose(got.angles, angles, atol=1e-3)
    assert got.geodesic == pytest.approx(geodesic, abs=2e-3)
    assert got.mahalanobis == pytest.approx(mahalanobis, rel=1e-5, abs=1e-5)
    assert got.distance == pytest.approx(distance, rel=1e-5, abs=2e-3)


@pytest.mark.parametrize("kind", ["centred", "raw"])
@pytest.mark.parametrize(("count", "dim", "n"), CASES)
def test_the_distance_is_numpys(kind: Kind, count: int, dim: int, n: int) -> None:
    random = np.random.default_rng(count + dim + n)
    first, second = images_of(random, count, dim), images_of(random, count, dim)
    got = subspace_distance(subspace_fit(first, kind, n), subspace_fit(second, kind, n), 0.7)
    check_distance(got, reference_distance(reference_fit(first, kind, n), reference_fit(second, kind, n), n, 0.7))
    assert got.angles.shape == (n,)


@pytest.mark.parametrize(("rank_a", "rank_b"), [(0, 0), (0, 3), (3, 0), (1, 3), (2, 1), (2, 2)])
def test_absent_directions_are_numpys(rank_a: int, rank_b: int) -> None:
    random = np.random.default_rng(rank_a * 4 + rank_b)
    first = images_of(random, max(rank_a, 1), 40)[: rank_a or 1] * (rank_a > 0)
    second = images_of(random, max(rank_b, 1), 40) * (rank_b > 0)
    a, b = subspace_fit(first, "raw", 3), subspace_fit(second, "raw", 3)
    assert (a.rank, b.rank) == (rank_a, rank_b)
    check_distance(
        subspace_distance(a, b, 1.0), reference_distance(reference_fit(first, "raw", 3), reference_fit(second, "raw", 3), 3, 1.0)
    )


def test_known_angles() -> None:
    turn = 0.3
    a = Subspace(np.zeros(4, np.float32), np.eye(4, 2, dtype=np.float32), 2)
    turned = np.array([[np.cos(turn), 0], [0, 1], [np.sin(turn), 0], [0, 0]], np.float32)
    b = Subspace(np.array([0, 0, 0, 2], np.float32), turned, 2)
    got = subspace_distance(a, b, 0.5)
    np.testing.assert_allclose(got.angles, [0, turn], atol=1e-3)
    assert got.geodesic == pytest.approx(turn, abs=1e-3)
    assert got.mahalanobis == pytest.approx(8)  # the means differ by 2 along a direction outside both
    assert got.distance == pytest.approx(turn + 4, abs=1e-3)


def test_the_distance_is_symmetric_and_zero_to_itself() -> None:
    random = np.random.default_rng(1)
    a, b = subspace_fit(images_of(random, 4, 90)), subspace_fit(images_of(random, 4, 90))
    assert subspace_distance(a, b, 1.0).distance == pytest.approx(subspace_distance(b, a, 1.0).distance, rel=1e-5)
    assert subspace_distance(a, a, 1.0).distance == pytest.approx(0, abs=2e-3)


def test_images_come_in_every_shape_and_dtype() -> None:
    stack = np.random.default_rng(2).integers(0, 256, (4, 8, 9), dtype=np.uint8)
    expected = subspace_fit(stack.reshape(4, 72).astype(np.float32))
    for images in (
        stack,
        list(stack),
        stack.astype(np.float64),
        np.asfortranarray(stack),
        stack[:, :, :].tolist(),
        stack.astype(">f4"),
    ):
        got = subspace_fit(images)
        np.testing.assert_array_equal(got.basis, expected.basis)
        np.testing.assert_array_equal(got.mean, expected.mean)


def test_subspaces_come_in_every_layout() -> None:
    random = np.random.default_rng(3)
    a, b = subspace_fit(images_of(random, 4, 50)), subspace_fit(images_of(random, 4, 50))
    expected = subspace_distance(a, b, 1.0)
    wide = np.zeros((60, 3), np.float32, order="F")
    wide[:50] = a.basis
    layouts: list[Any] = [np.ascontiguousarray(a.basis), a.basis.astype(np.float64), wide[:50], np.repeat(a.basis, 2, axis=0)[::2]]
    for basis in layouts:
        got = subspace_distance(Subspace(np.repeat(a.mean, 2)[::2], basis, np.int64(a.rank)), b, np.float64(1))  # type: ignore[arg-type]
        np.testing.assert_array_equal(got.angles, expected.angles)
        assert got.distance == expected.distance


def test_one_column_and_one_pixel_work_in_c_order() -> None:
    a = Subspace(np.zeros(5, np.float32), np.ascontiguousarray(np.eye(5, 1, dtype=np.float32)), 1)
    b = Subspace(np.zeros(5, np.float32), np.ascontiguousarray(np.eye(5, 1, -1, dtype=np.float32)), 1)
    assert subspace_distance(a, b, 0.0).geodesic == pytest.approx(np.pi / 2)
    point = Subspace(np.zeros(1, np.float32), np.ones((1, 1), np.float32), 1)
    assert subspace_distance(point, point, 0.0).geodesic == 0


def test_models_of_a_tracker_are_subspaces() -> None:
    tracker = Tracker("tiny", bag_interval=1)
    tracker.init(FRAMES[0], BOXES[0])
    for frame in FRAMES[1:10]:
        tracker.update(frame)
    first, *_, last = tracker.bag
    copied = Subspace(last.mean.copy(), last.basis.copy(), last.rank)
    assert subspace_distance(first, last, 0.5).distance == subspace_distance(first, copied, 0.5).distance > 0


GOOD = Subspace(np.zeros(4, np.float32), np.eye(4, 2, dtype=np.float32), 2)


@pytest.mark.parametrize(
    ("images", "options", "error", "message"),
    [
        (np.zeros((4, 5)), {"n": 0}, ValueError, "n must be 1 .. 8, not 0"),
        (np.zeros((4, 5)), {"n": 9}, ValueError, "n must be 1 .. 8, not 9"),
        (np.zeros((4, 5)), {"n": 1.5}, TypeError, "float"),
        (np.zeros((4, 5)), {"basis": "central"}, ValueError, "basis must be 'centred' or 'raw', not 'central'"),
        (np.zeros(5), {}, ValueError, r"images must be \(count, ...\) with 1 .. 16 images of at least one pixel, not \(5,\)"),
        (np.zeros((17, 5)), {}, ValueError, r"not \(17, 5\)"),
        (np.zeros((0, 5)), {}, ValueError, r"not \(0, 5\)"),
        (np.zeros((4, 0)), {}, ValueError, r"not \(4, 0\)"),
        (np.full((2, 3), np.nan), {}, ValueError, "images must be finite as float32"),
        (np.full((2, 3), 1e300), {}, ValueError, "images must be finite as float32"),
        (np.zeros((2, 3), complex), {}, ValueError, "images must hold real numbers, not complex128"),
        (np.array([["a", "b"]]), {}, ValueError, "images must hold real numbers"),
    ],
)
def test_a_fit_refuses(images: Any, options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        subspace_fit(images, **options)


@pytest.mark.parametrize(
    ("other", "alpha", "message"),
    [
        (GOOD, -1.0, "alpha must be 0 .. 1e\\+06, not -1"),
        (GOOD, np.nan, "alpha must be"),
        (GOOD, 2e6, "alpha must be"),
        (Subspace(GOOD.mean, GOOD.basis, 3), 1.0, "b: rank must be 0 .. 2, not 3"),
        (Subspace(GOOD.mean, GOOD.basis, -1), 1.0, "b: rank must be"),
        (Subspace(GOOD.mean[:3], GOOD.basis, 2), 1.0, r"b: mean must be \(D,\) and basis \(D, n\), not \(3,\) and \(4, 2\)"),
        (Subspace(GOOD.mean[:, np.newaxis], GOOD.basis, 2), 1.0, "b: mean must be"),
        (Subspace(GOOD.mean, GOOD.basis[:, :0], 0), 1.0, "b: basis must have 1 .. 8 columns, not 0"),
        (Subspace(GOOD.mean, np.zeros((4, 9), np.float32), 0), 1.0, "not 9"),
        (Subspace(GOOD.mean, GOOD.basis[:, :1], 1), 1.0, r"same D and n, not \(4, 2\) and \(4, 1\)"),
        (Subspace(GOOD.mean[:3], GOOD.basis[:3], 2), 1.0, r"same D and n, not \(4, 2\) and \(3, 2\)"),
        (Subspace(np.full(4, np.inf, np.float32), GOOD.basis, 2), 1.0, "b.mean must be finite"),
        (Subspace(GOOD.mean, np.full((4, 2), np.nan, np.float32), 2), 1.0, "b.basis must be finite"),
    ],
)
def test_a_distance_refuses(other: Subspace, alpha: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        subspace_distance(GOOD, other, alpha)
