"""Follow one object through a video from a single box: the Affine Subspace Tracker (AST) of Shirazi et al., 2013.

    import asttrack

    tracker = asttrack.Tracker()
    tracker.init(first_frame, (x, y, w, h))
    for frame in frames:
        result = tracker.update(frame)
        print(result.box, result.score, result.status.name)

Frames are numpy uint8 arrays, grey or BGR. Docstrings that say "paper" mean "Object Tracking via Non-Euclidean Geometry: A
Grassmann Approach" (Shirazi, Harandi, Lovell and Sanderson).
"""

from asttrack import _library
from asttrack.config import PRESETS, ConfigField, config_fields
from asttrack.errors import AstError, ErrorCode
from asttrack.geometry import Distance, Subspace, subspace_distance, subspace_fit
from asttrack.result import Box, Result, Status
from asttrack.tracker import Tracker
from asttrack.views import Particles

__version__ = _library.VERSION
library = _library.LIBRARY

__all__ = [
    "PRESETS",
    "AstError",
    "Box",
    "ConfigField",
    "Distance",
    "ErrorCode",
    "Particles",
    "Result",
    "Status",
    "Subspace",
    "Tracker",
    "__version__",
    "config_fields",
    "library",
    "subspace_distance",
    "subspace_fit",
]
