# Each target sets up what it needs in .venv; `make train` and `make test` work alone on a fresh clone.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: help train test test-fast lint format bench validate clean

help:  ## Show the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev]'
	@touch $@

train: $(STAMP)  ## Train one policy for all eight insects and print the comparison (about two minutes)
	$(BIN)/python train.py $(ARGS)

test: lint  ## Lint, type-check and run every test, the slow learning tests too
	$(BIN)/python -m pytest $(ARGS)

test-fast: $(STAMP)  ## The tests without those that train a policy
	$(BIN)/python -m pytest -m "not slow" $(ARGS)

lint: $(STAMP)  ## ruff (lint and format) and mypy
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(STAMP)  ## Let ruff mend what it can
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(STAMP)  ## Wingbeats a second of the oracle, the fast path and the vector environment
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1 $(BIN)/python -m benchmarks.speed

validate: $(STAMP)  ## Tables 2 and 3 of the paper beside ours
	$(BIN)/python -m flapenv.validation

clean:  ## Remove the virtual environment and caches, not the runs
	rm -rf $(VENV) .mypy_cache .pytest_cache .ruff_cache .hypothesis
