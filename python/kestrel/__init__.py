# SPDX-License-Identifier: BSD-3-Clause
"""Eyes of a UAV for moving targets: finds landing pads and coloured objects in images, says where
they are in the world, how they move and where they will be.

Frames: the camera's is x right, y down, z forward; the body's is x forward, y left, z up (FLU); the
world is east, north, up (ENU). Metres, seconds and radians, but for names that say otherwise; times
are whole nanoseconds (`time_ns`). Pixels: integer coordinates are the pixels' centres. Images are
uint8 arrays, gray (rows, columns) or BGR (rows, columns, 3). What is wrong with an argument is told
by one line: TypeError for another kind of value, InputError for the rest.
"""

from . import _kestrel
from ._calls import with_clear_errors as _with_clear_errors
from ._kestrel import *  # noqa: F401,F403
from ._kestrel import __version__ as __version__
from .tables import ResultTable as ResultTable

# Users know the names by the package: in messages and in pickles, too.
for _name, _value in vars(_kestrel).items():
    if not _name.startswith("_"):
        _value.__module__ = "kestrel"
        globals()[_name] = _with_clear_errors(_value)
