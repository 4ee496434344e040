"""Interactive figures of strokes and results, for the report and the explorer; needs the extra "train"."""
