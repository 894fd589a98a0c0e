"""The tracker."""

import ctypes
import threading
from collections.abc import Callable, Iterable, Sequence
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asttrack import _abi, config
from asttrack._library import LIBRARY
from asttrack.config import ConfigValue
from asttrack.errors import AstError
from asttrack.frames import ColourOrder, Frame, FrameReader
from asttrack.geometry import Subspace
from asttrack.result import Box, Result, Status
from asttrack.views import Memory, Particles

_STATUS = tuple(Status)


class Tracker:
    """Follows one object from a box in the first frame.

    Everything a tracker needs is allocated here, in one numpy array that Python owns (`memory_size` bytes, whatever the frames'
    size); the library then allocates nothing more. Python owns it so that the arrays of `particles`, `bag` and `history` can keep
    it alive.

    Frames are numpy uint8 arrays: grey (height, width) or (height, width, 1), or colour (height, width, 3); sides of 1 .. 65535
    pixels, and the size may change from frame to frame. Contiguous grey rows are read where they lie. A frame is borrowed during
    the call only. Where a method takes a frame, it raises TypeError for what is not a numpy array of uint8 and ValueError for a
    shape that is not a picture's.

    A call that fails leaves the tracker as it was; only `particles.distance` is gone after a failed `update`.

    Threads: different trackers run at the same time in different threads (the GIL is released while the library works). Calls on
    one tracker wait for each other; their order decides the result, so give each tracker to one thread.

    Pickling, `copy.copy` and `copy.deepcopy` take the configuration and the state along; the copy continues bit for bit.

    Args:
        preset: "robust" (the default), "paper" (the publication), "compact" (half a megabyte) or "tiny" (64 KiB).
        colour: order of the channels of colour frames: "bgr", as OpenCV reads them, or "rgb".
        **changes: configuration fields to change, by name: `particles=300, alpha=0.5, basis="raw"`. `config_fields()` lists them
            with their kinds and ranges; asttrack.h says what they mean.

    Raises:
        ValueError: no such preset or colour order.
        TypeError: no such field, or a value of the wrong type.
        AstError: an illegal value; `field` names it.
    """

    def __init__(self, preset: str = "robust", *, colour: ColourOrder = "bgr", **changes: ConfigValue) -> None:
        self._build(config.make(preset, changes), colour)

    def _build(self, settings: ctypes.Structure, colour: ColourOrder) -> None:
        self._reader = FrameReader(colour)
        self._settings = settings
        self._lock = threading.Lock()
        size = LIBRARY.calls.ast_mem_size(ctypes.byref(settings))
        memory = Memory(size)
        self._handle = ctypes.c_void_p()
        LIBRARY.check(LIBRARY.calls.ast_init(ctypes.byref(self._handle), ctypes.byref(settings), memory.address, size))
        self._memory: Memory | None = memory
        # What an update passes and receives, made once.
        self._frame = _abi.Frame()
        self._result = _abi.Result()
        self._step = LIBRARY.calls.ast_step
        self._step_arguments = (self._handle, ctypes.byref(self._frame), ctypes.byref(self._result))

    # ---- Tracking ----

    def init(self, frame: Frame, box: Iterable[float]) -> None:
        """Starts, or re-targets, on the object inside `box`. All earlier state is forgotten.

        Args:
            frame: the picture.
            box: (x, y, w, h) in pixels, top-left corner 0-based; sides of at least one pixel, not wholly outside the frame.

        Raises:
            AstError: `ErrorCode.BOX`.
        """
        start = _box(box)
        with self._lock:
            self._require_open()
            self._reader.point(frame, self._frame)
            LIBRARY.check(LIBRARY.calls.ast_start(self._handle, ctypes.byref(self._frame), ctypes.byref(start)))

    def init_sequence(self, frames: Sequence[Frame], boxes: Sequence[Iterable[float]]) -> None:
        """Starts from several frames with the object's box in each, oldest first: the paper's initialisation.

        The last `history` of them fill the image set; scales are relative to the first box.

        Args:
            frames: pictures, at least one.
            boxes: as many boxes, as for `init`.

        Raises:
            ValueError: no frames, or another number of boxes.
            AstError: `ErrorCode.BOX`.
        """
        if len(frames) != len(boxes) or len(frames) == 0:
            raise ValueError(f"as many boxes as frames are needed, at least one, not {len(frames)} frames and {len(boxes)} boxes")
        pictures = (_abi.Frame * len(frames))()
        starts = (_abi.Box * len(boxes))(*map(_box, boxes))
        readers = [FrameReader(self.colour) for _ in frames]
        for reader, frame, picture in zip(readers, frames, pictures, strict=True):
            reader.point(frame, picture)
        with self._lock:
            self._require_open()
            LIBRARY.check(LIBRARY.calls.ast_start_sequence(self._handle, pictures, starts, len(frames)))

    def update(self, frame: Frame) -> Result:
        """Tracks the object in the next frame.

        Raises:
            AstError: `ErrorCode.NOT_STARTED` before `init`.
        """
        with self._lock:
            self._require_open()
            self._reader.point(frame, self._frame)
            code = self._step(*self._step_arguments)
            if code != 0:
                raise AstError(code, LIBRARY.text(code))
            found = self._result
            box = found.box
            return Result(
                Box(box.x, box.y, box.w, box.h),
                found.scale,
                found.score,
                _STATUS[found.status],
                found.distance,
                found.effective_particles,
                found.best,
                found.frame,
            )

    def update_cv(self, frame: Frame) -> tuple[bool, tuple[int, int, int, int]]:
        """`update` with the face of OpenCV's `cv2.Tracker*.update`; `init` has it already.

        Returns:
            (ok, (x, y, w, h)): ok is False while the object is lost. As from OpenCV's own trackers, the box is in whole pixels.
        """
        result = self.update(frame)
        x, y, w, h = result.box
        return result.status is not Status.LOST, (round(x), round(y), round(w), round(h))

    # ---- Looking inside ----

    @property
    def config(self) -> dict[str, int | float | str]:
        """The configuration by field name, enums by the names of their choices: `Tracker(**t.config)` is configured like t."""
        return config.values(self._settings)

    @property
    def colour(self) -> ColourOrder:
        """Order of the channels of colour frames."""
        return self._reader.colour

    @property
    def memory_size(self) -> int:
        """Bytes of the block that the tracker lives in; a function of the configuration alone."""
        return int(LIBRARY.calls.ast_mem_size(ctypes.byref(self._settings)))

    @property
    def particles(self) -> Particles:
        """The particle cloud, as read-only views of the tracker's memory.

        Views are good until the next `init`, `update`, `restore` or `close`, which change their values or their meaning without
        notice; copy what must last. The memory itself lives as long as any view of it.

        Raises:
            AstError: `ErrorCode.NOT_STARTED` before `init`.
        """
        with self._lock:
            memory = self._require_open()
            cloud = _abi.Particles()
            LIBRARY.check(LIBRARY.calls.ast_get_particles(self._handle, ctypes.byref(cloud)))
            return memory.particles(cloud)

    @property
    def bag(self) -> list[Subspace]:
        """The models of the bag (paper section 2.3), oldest first, 0 .. bag_size of them. Views, good as long as `particles`.

        Raises:
            AstError: `ErrorCode.NOT_STARTED` before `init`.
        """
        with self._lock:
            memory = self._require_open()
            models = []
            for index in range(self._count(LIBRARY.calls.ast_bag_count)):
                model = _abi.Subspace()
                LIBRARY.check(LIBRARY.calls.ast_get_model(self._handle, index, ctypes.byref(model)))
                models.append(memory.subspace(model))
            return models

    @property
    def history(self) -> list[NDArray[np.float32]]:
        """The feature vectors of the last tracked boxes (paper section 2.2), oldest first, each (D,) with D = `feature_length`.

        Views, good as long as `particles`; `numpy.stack` makes one array of them, and `patch` pictures of the grey pixels in them.

        Raises:
            AstError: `ErrorCode.NOT_STARTED` before `init`.
        """
        with self._lock:
            memory = self._require_open()
            shape = (self.feature_length,)
            vectors = []
            for index in range(self._count(LIBRARY.calls.ast_history_count)):
                address = ctypes.c_void_p()
                LIBRARY.check(LIBRARY.calls.ast_get_history(self._handle, index, ctypes.byref(address)))
                vectors.append(memory.floats(address.value or 0, shape))
            return vectors

    @property
    def feature_length(self) -> int:
        """D, the floats in a feature vector: the grey patch, then oriented gradients, as far as their weights are not 0."""
        return int(LIBRARY.calls.ast_feature_length(ctypes.byref(self._settings)))

    def patch(self, vector: NDArray[np.float32]) -> NDArray[np.float32]:
        """The grey patch inside a feature vector: of `history`, a model's `mean`, or a column of its `basis`.

        Returns:
            A (patch_height, patch_width) view of the vector's head: pixels normalised as configured, times `patch_weight`.

        Raises:
            ValueError: the vector is not (D,), or `patch_weight` is 0 and there is no patch in it.
        """
        if vector.shape != (self.feature_length,):
            raise ValueError(f"a feature vector of this tracker is ({self.feature_length},), not {vector.shape}")
        if not self._settings.patch_weight > 0:
            raise ValueError("the feature vectors of this tracker have no grey patch: patch_weight is 0")
        shape = (self._settings.patch_height, self._settings.patch_width)
        return vector[: shape[0] * shape[1]].reshape(shape)

    # ---- State ----

    def save(self) -> bytes:
        """The whole state: versioned, checksummed, the same bytes on every machine.

        Raises:
            AstError: `ErrorCode.NOT_STARTED` before `init`.
        """
        with self._lock:
            self._require_open()
            buffer = ctypes.create_string_buffer(LIBRARY.calls.ast_save_size(ctypes.byref(self._settings)))
            LIBRARY.check(LIBRARY.calls.ast_save(self._handle, buffer, len(buffer)))
            return buffer.raw

    def restore(self, state: bytes | bytearray | memoryview) -> None:
        """Goes back to a state that `save` gave.

        It may be another tracker's of the same configuration, but for `scoring` and `threads`.

        Raises:
            TypeError: not bytes.
            AstError: `ErrorCode.CORRUPT` for truncated or altered bytes, `ErrorCode.MISMATCH` for another configuration.
        """
        if not isinstance(state, bytes | bytearray | memoryview):
            raise TypeError(f"a saved state is bytes, not {type(state).__name__}")
        saved = bytes(state)
        with self._lock:
            self._require_open()
            LIBRARY.check(LIBRARY.calls.ast_restore(self._handle, saved, len(saved)))

    def __reduce__(self) -> tuple[Any, ...]:
        with self._lock:
            self._require_open()
            started = LIBRARY.calls.ast_history_count(self._handle) > 0
        return _revive, (type(self), config.exact_values(self._settings), self.colour, self.save() if started else None)

    # ---- Life ----

    def close(self) -> None:
        """Ends the tracker and lets go of its memory. Later calls raise ValueError; closing again does nothing."""
        with self._lock:
            LIBRARY.calls.ast_free(self._handle)
            self._handle.value = None
            self._memory = None

    @property
    def closed(self) -> bool:
        """Whether `close` was called."""
        return self._memory is None

    def __enter__(self) -> "Tracker":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        settings = self.config
        size = f"{settings['patch_width']} x {settings['patch_height']}"
        closed = ", closed" if self.closed else ""
        return f"<asttrack.Tracker: {settings['particles']} particles, patches of {size}, bag of {settings['bag_size']}{closed}>"

    def _require_open(self) -> Memory:
        memory = self._memory
        if memory is None:
            raise ValueError("this tracker is closed")
        return memory

    def _count(self, function: Callable[[ctypes.c_void_p], int]) -> int:
        """What one of the library's counting functions says."""
        count = function(self._handle)
        LIBRARY.check(count)
        return count


def _box(box: Iterable[float]) -> _abi.Box:
    refusal = f"a box must be four numbers (x, y, w, h), not {box!r}"
    if isinstance(box, (str, bytes)):  # their parts may be digits
        raise TypeError(refusal)
    try:
        x, y, w, h = map(float, box)
    except (TypeError, ValueError, OverflowError) as error:
        kind = TypeError if isinstance(error, TypeError) else ValueError
        raise kind(refusal) from None
    return _abi.Box(x, y, w, h)


def _revive(kind: type[Tracker], settings: dict[str, int | float], colour: ColourOrder, state: bytes | None) -> Tracker:
    """A tracker as it was when it was pickled."""
    tracker = kind.__new__(kind)
    tracker._build(config.make("robust", settings), colour)
    if state is not None:
        tracker.restore(state)
    return tracker
