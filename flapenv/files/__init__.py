"""Files of strokes and wings: JSON and CSV with versions and units, which cannot be misread.

Strokes come and go by `read_strokes` and `write_strokes`, one's own wing by `read_wing` and `write_wing`.
"""

from flapenv.files.schemas import stroke_schema, wing_schema
from flapenv.files.strokes import NamedStroke, read_strokes, strokes_to_text, write_strokes
from flapenv.files.wings import WingFile, read_wing, write_wing

__all__ = [
    "NamedStroke",
    "WingFile",
    "read_strokes",
    "read_wing",
    "stroke_schema",
    "strokes_to_text",
    "wing_schema",
    "write_strokes",
    "write_wing",
]
