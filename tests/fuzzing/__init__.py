"""Fuzzing: everything that takes a file, a number or a word from outside, as functions of bytes.

A target turns bytes into a call of one reader (`targets.TARGETS` lists them); Hypothesis draws the bytes in the suite,
and `python -m tests.fuzzing` lets a coverage-guided fuzzer, atheris, choose them.
"""
