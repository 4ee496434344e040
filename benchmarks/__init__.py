"""Benchmarks: printed, never asserted, since machines are noisy."""
