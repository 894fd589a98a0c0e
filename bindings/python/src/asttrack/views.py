"""Read-only numpy views of a tracker's memory: its particles, the bag of models, the tracked patches."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asttrack import _abi
from asttrack.geometry import Subspace

_FLOAT = np.dtype(np.float32)


@dataclass(frozen=True, eq=False)
class Particles:
    """The particle cloud (paper section 2.1). Arrays are float32 and read-only.

    Attributes:
        x: (N,) centres of the particles' boxes, pixels.
        y: (N,) the same, downwards.
        scale: (N,) relative to the first box.
        weight: (N,) they sum to 1.
        distance: (scored, models) the last update's distances to each model of the bag (paper eq. 2), of the first particles: as
            many as the shortlist, the others weigh nothing; N without one and before the bag has a model. None before the first
            update and after a failed one.
        centre: x and y of the last estimate's centre, pixels.
        size: width and height of the object at scale 1, pixels.
    """

    x: NDArray[np.float32]
    y: NDArray[np.float32]
    scale: NDArray[np.float32]
    weight: NDArray[np.float32]
    distance: NDArray[np.float32] | None
    centre: tuple[float, float]
    size: tuple[float, float]


class Memory:
    """The block that a tracker lives in, and read-only arrays over parts of it. Each keeps the block alive."""

    def __init__(self, size: int) -> None:
        block = np.empty(size, np.uint8)
        self.size = size
        self.address = int(block.ctypes.data)
        # The library writes through the address; numpy is not to, nor is a view to be made writable again.
        block.flags.writeable = False
        self._block = block

    def floats(self, address: int, shape: Sequence[int], strides: Sequence[int] | None = None) -> NDArray[np.float32]:
        """An array over the floats at `address`; numpy checks that they lie inside the block."""
        return np.ndarray(shape, _FLOAT, self._block, address - self.address, strides)

    def particles(self, cloud: _abi.Particles) -> Particles:
        """The arrays that `ast_get_particles` points to."""
        count = (cloud.count,)
        return Particles(
            self.floats(cloud.x, count),
            self.floats(cloud.y, count),
            self.floats(cloud.scale, count),
            self.floats(cloud.weight, count),
            self.floats(cloud.distance, (cloud.scored, cloud.models)) if cloud.distance else None,
            (cloud.reference.x, cloud.reference.y),
            (cloud.reference.w, cloud.reference.h),
        )

    def subspace(self, model: _abi.Subspace) -> Subspace:
        """The arrays that `ast_get_model` points to."""
        columns = (_FLOAT.itemsize, model.stride * _FLOAT.itemsize)
        return Subspace(self.floats(model.mean, (model.dim,)), self.floats(model.basis, (model.dim, model.n), columns), model.rank)
