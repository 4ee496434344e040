"""Judging policies and strokes: against optimum and CFD, under noise, in other models, and what an answer costs."""
