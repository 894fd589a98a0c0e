"""The C interface as ctypes sees it: the structures, constants and prototypes of asttrack.h that the binding uses.

A test compiles the header and compares every size, offset and value written here with it. `ast_config` is missing on purpose: its
layout comes from the table of fields that the library itself carries (see `_library`).
"""

import ctypes
from ctypes import POINTER, c_char_p, c_float, c_int, c_int32, c_size_t, c_uint32, c_void_p
from typing import Final

MAX_FRAME: Final = 65535
MAX_HISTORY: Final = 15
MAX_BASIS: Final = 8

PRESETS: Final = {"paper": 0, "robust": 1, "tiny": 2, "compact": 3}
BASES: Final = {"centred": 0, "raw": 1}

FIELD_INT: Final = 0
FIELD_FLOAT: Final = 1
FIELD_ENUM: Final = 2
FIELD_SEED: Final = 3


class ConfigField(ctypes.Structure):
    """`ast_config_field`: one row of the library's table of configuration fields."""

    _fields_ = (
        ("name", c_char_p),
        ("choices", POINTER(c_char_p)),
        ("offset", c_uint32),
        ("kind", c_int32),
        ("minimum", c_float),
        ("maximum", c_float),
    )


class Frame(ctypes.Structure):
    """`ast_frame`: borrowed grey pixels. The pointer is kept as an address, which ctypes sets fastest."""

    _fields_ = (("pixels", c_void_p), ("width", c_int32), ("height", c_int32), ("stride", c_int32))


class Box(ctypes.Structure):
    """`ast_box`: top-left corner and size, pixels."""

    _fields_ = (("x", c_float), ("y", c_float), ("w", c_float), ("h", c_float))


class Result(ctypes.Structure):
    """`ast_result`: what a step found."""

    _fields_ = (
        ("box", Box),
        ("scale", c_float),
        ("score", c_float),
        ("distance", c_float),
        ("effective_particles", c_float),
        ("status", c_int32),
        ("best", c_int32),
        ("frame", c_uint32),
    )


class Particles(ctypes.Structure):
    """`ast_particles`: addresses of the particle cloud inside the tracker's block."""

    _fields_ = (
        ("x", c_void_p),
        ("y", c_void_p),
        ("scale", c_void_p),
        ("weight", c_void_p),
        ("count", c_int32),
        ("models", c_int32),
        ("scored", c_int32),
        ("distance", c_void_p),
        ("reference", Box),
    )


class Subspace(ctypes.Structure):
    """`ast_subspace`: addresses of a mean and of the columns of a basis."""

    _fields_ = (
        ("mean", c_void_p),
        ("basis", c_void_p),
        ("dim", c_int32),
        ("stride", c_int32),
        ("n", c_int32),
        ("rank", c_int32),
    )


class Distance(ctypes.Structure):
    """`ast_distance`: principal angles and what is made of them."""

    _fields_ = (
        ("angle", c_float * MAX_BASIS),
        ("geodesic", c_float),
        ("mahalanobis", c_float),
        ("distance", c_float),
    )


# Result type and argument types. A tracker and a configuration are passed as untyped addresses.
_CONFIG = c_void_p
_TRACKER = c_void_p
_GREY = (c_int, (c_void_p, c_int32, c_void_p, c_int32, c_int32, c_int32))
PROTOTYPES: Final = {
    "ast_strerror": (c_char_p, (c_int,)),
    "ast_version": (c_char_p, ()),
    "ast_backend": (c_char_p, ()),
    "ast_config_preset": (c_int, (_CONFIG, c_int)),
    "ast_config_check": (c_int, (_CONFIG, POINTER(c_char_p))),
    "ast_config_fields": (POINTER(ConfigField), (POINTER(c_int32),)),
    "ast_grey_from_rgb": _GREY,
    "ast_grey_from_bgr": _GREY,
    "ast_mem_size": (c_size_t, (_CONFIG,)),
    "ast_init": (c_int, (POINTER(_TRACKER), _CONFIG, c_void_p, c_size_t)),
    "ast_free": (None, (_TRACKER,)),
    "ast_start": (c_int, (_TRACKER, POINTER(Frame), POINTER(Box))),
    "ast_start_sequence": (c_int, (_TRACKER, POINTER(Frame), POINTER(Box), c_int32)),
    "ast_step": (c_int, (_TRACKER, POINTER(Frame), POINTER(Result))),
    "ast_get_particles": (c_int, (_TRACKER, POINTER(Particles))),
    "ast_bag_count": (c_int, (_TRACKER,)),
    "ast_get_model": (c_int, (_TRACKER, c_int32, POINTER(Subspace))),
    "ast_feature_length": (c_int32, (_CONFIG,)),
    "ast_history_count": (c_int, (_TRACKER,)),
    "ast_get_history": (c_int, (_TRACKER, c_int32, POINTER(c_void_p))),
    "ast_save_size": (c_size_t, (_CONFIG,)),
    "ast_save": (c_int, (_TRACKER, c_void_p, c_size_t)),
    "ast_restore": (c_int, (_TRACKER, c_char_p, c_size_t)),
    "ast_subspace_work_size": (c_size_t, (c_int32, c_int32)),
    "ast_subspace_fit": (
        c_int,
        (c_void_p, c_int32, c_int32, c_int32, c_int, c_int32, c_void_p, c_void_p, POINTER(Subspace), c_void_p, c_size_t),
    ),
    "ast_subspace_distance": (c_int, (POINTER(Subspace), POINTER(Subspace), c_float, POINTER(Distance), c_void_p, c_size_t)),
}
