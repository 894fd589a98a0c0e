"""Affine subspaces on their own: fitting one to images, and the distance between two (paper sections 2.2 and 2.4)."""

import ctypes
import operator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asttrack import _abi
from asttrack._library import LIBRARY

_FLOAT_BYTES = 4
_MAX_IMAGES = _abi.MAX_HISTORY + 1
_MAX_ALPHA = 1e6


@dataclass(frozen=True, eq=False)
class Subspace:
    """An affine subspace { mean + basis y } (paper eq. 1).

    Attributes:
        mean: (D,) float32.
        basis: (D, n) float32, orthonormal columns; those from `rank` on are absent and zero.
        rank: columns that are present, 0 .. n.
    """

    mean: NDArray[np.float32]
    basis: NDArray[np.float32]
    rank: int


@dataclass(frozen=True, eq=False)
class Distance:
    """How far two affine subspaces are apart.

    Attributes:
        angles: (n,) float32, the principal angles (paper eq. 4), radians, ascending, 0 .. pi/2.
        geodesic: their 2-norm (eq. 3).
        mahalanobis: 2 d'd - |Ua'd|^2 - |Ub'd|^2 with d = mean_a - mean_b (from eq. 5).
        distance: geodesic + alpha mahalanobis (eq. 2).
    """

    angles: NDArray[np.float32]
    geodesic: float
    mahalanobis: float
    distance: float


def subspace_fit(images: ArrayLike, basis: Literal["centred", "raw"] = "centred", n: int = 3) -> Subspace:
    """Fits an affine subspace to a set of images (paper section 2.2).

    Args:
        images: (count, D) or (count, height, width), or a list of such images (as `Tracker.history`): 1 .. 16 of them, any real
            dtype, finite as float32.
        basis: "centred" spans the images minus their mean; "raw" spans the images themselves.
        n: basis vectors to keep, 1 .. 8. A direction whose singular value is at most 1e-5 of the images' Frobenius norm is absent.

    Returns:
        A subspace with arrays of its own.

    Raises:
        TypeError: n is not an int.
        ValueError: a shape, a value or an argument outside the above.
        AstError: the linear algebra failed.
    """
    if basis not in _abi.BASES:
        raise ValueError(f"basis must be 'centred' or 'raw', not {basis!r}")
    n = operator.index(n)
    if not 1 <= n <= _abi.MAX_BASIS:
        raise ValueError(f"n must be 1 .. {_abi.MAX_BASIS}, not {n}")
    stack = np.ascontiguousarray(_real(images, "images"))
    if stack.ndim < 2 or stack.size == 0 or stack.shape[0] > _MAX_IMAGES:
        raise ValueError(f"images must be (count, ...) with 1 .. {_MAX_IMAGES} images of at least one pixel, not {stack.shape}")
    count = stack.shape[0]
    dim = stack.size // count

    mean = np.empty(dim, np.float32)
    columns = np.empty((dim, n), np.float32, order="F")
    fitted = _abi.Subspace()
    work = np.empty(LIBRARY.calls.ast_subspace_work_size(dim, count), np.uint8)
    LIBRARY.check(
        LIBRARY.calls.ast_subspace_fit(
            stack.ctypes.data,
            dim,
            dim,
            count,
            _abi.BASES[basis],
            n,
            mean.ctypes.data,
            columns.ctypes.data,
            ctypes.byref(fitted),
            work.ctypes.data,
            work.size,
        )
    )
    return Subspace(mean, columns, fitted.rank)


def subspace_distance(a: Subspace, b: Subspace, alpha: float) -> Distance:
    """Distance of two affine subspaces of the same D and n (paper eq. 2 to 5).

    Where a and b have absent directions, the lesser number of them counts as angles of 0 and the rest of them as pi/2.

    Args:
        a: one subspace; arrays that are float32 with contiguous columns are not copied.
        b: the other.
        alpha: weight of the Mahalanobis term, 0 .. 1e6.

    Raises:
        ValueError: shapes that do not fit each other, values that are not finite, or alpha outside its range.
        AstError: the linear algebra failed.
    """
    alpha = float(alpha)
    if not 0 <= alpha <= _MAX_ALPHA:
        raise ValueError(f"alpha must be 0 .. {_MAX_ALPHA:g}, not {alpha}")
    first, *_first_arrays = _borrowed(a, "a")
    second, *_second_arrays = _borrowed(b, "b")
    if (first.dim, first.n) != (second.dim, second.n):
        raise ValueError(f"a and b must have the same D and n, not {(first.dim, first.n)} and {(second.dim, second.n)}")

    out = _abi.Distance()
    work = np.empty(LIBRARY.calls.ast_subspace_work_size(first.dim, first.n), np.uint8)
    LIBRARY.check(
        LIBRARY.calls.ast_subspace_distance(
            ctypes.byref(first), ctypes.byref(second), alpha, ctypes.byref(out), work.ctypes.data, work.size
        )
    )
    return Distance(np.array(out.angle[: first.n], np.float32), out.geodesic, out.mahalanobis, out.distance)


def _real(values: ArrayLike, name: str) -> NDArray[np.float32]:
    """float32 of real, finite values; `values` itself where it is that already."""
    array: NDArray[Any] = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise ValueError(f"{name} must hold real numbers, not {array.dtype}")
    with np.errstate(over="ignore"):
        floats = array.astype(np.float32, copy=False)
    if not np.isfinite(floats).all():
        raise ValueError(f"{name} must be finite as float32")
    return floats


def _borrowed(subspace: Subspace, name: str) -> tuple[_abi.Subspace, NDArray[np.float32], NDArray[np.float32]]:
    """The C view of a subspace, and the arrays that must outlive it."""
    mean = np.ascontiguousarray(_real(subspace.mean, f"{name}.mean"))
    basis = _real(subspace.basis, f"{name}.basis")
    if mean.ndim != 1 or mean.size == 0 or basis.ndim != 2 or basis.shape[0] != mean.size:
        raise ValueError(f"{name}: mean must be (D,) and basis (D, n), not {mean.shape} and {basis.shape}")
    dim, n = basis.shape
    if not 1 <= n <= _abi.MAX_BASIS:
        raise ValueError(f"{name}: basis must have 1 .. {_abi.MAX_BASIS} columns, not {n}")
    rank = operator.index(subspace.rank)
    if not 0 <= rank <= n:
        raise ValueError(f"{name}: rank must be 0 .. {n}, not {rank}")
    if basis.strides[0] != _FLOAT_BYTES or basis.strides[1] < dim * _FLOAT_BYTES or basis.strides[1] % _FLOAT_BYTES != 0:
        basis = np.asfortranarray(basis)
    # The stride of an axis of one element means nothing.
    stride = basis.strides[1] // _FLOAT_BYTES if n > 1 else dim
    return _abi.Subspace(mean.ctypes.data, basis.ctypes.data, dim, stride, n, rank), mean, basis
