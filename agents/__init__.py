"""Learners for flapenv and what they are compared with; needs the extra "train"."""
