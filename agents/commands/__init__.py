"""The commands of `train.py`, each with its own --help; benchmark and compare lie with what they run."""
