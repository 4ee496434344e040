"""Sweeps: seeds × presets × problems, and searches for settings, as trials of Ray Tune on one machine or a cluster."""
