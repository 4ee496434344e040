# Each target sets up what it needs in .venv; `make train` and `make test` work alone on a fresh clone.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
FLOOR := .venv-floor
ZOO := .venv-zoo
RLLIB := .venv-rllib
AUDIT := .venv-audit
# Tests run two at a time, the files of one after the other; those that hold times run alone.
TWO := OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 --dist loadfile
FUZZ_INPUTS ?= 1000000
ENV_ID ?= flapenv/Hover-v0
ZOO_ALGO ?= ppo
# pip builds the package in an environment of its own, where it hears of versions by this variable alone.
export PIP_CONSTRAINT := $(CURDIR)/.ci/requirements-build.txt

.PHONY: help train test test-fast test-floor test-browser lint format bench benchmark docs validate fuzz audit clients client-ppo client-zoo client-rllib clean

help:  ## Show the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev]'
	@touch $@

$(VENV)/.fuzz: $(STAMP)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[fuzz]'
	@touch $@

$(AUDIT)/.installed: .ci/requirements-audit.txt
	$(PYTHON) -m venv $(AUDIT)
	$(AUDIT)/bin/python -m pip install --quiet --requirement .ci/requirements-audit.txt
	@touch $@

$(FLOOR)/.installed: pyproject.toml constraints-floor.txt
	$(PYTHON) -m venv $(FLOOR)
	$(FLOOR)/bin/python -m pip install --quiet --constraint constraints-floor.txt --editable '.[report]' pytest hypothesis
	@touch $@

.venv-%/.installed: pyproject.toml clients/requirements-%.txt
	$(PYTHON) -m venv .venv-$*
	.venv-$*/bin/python -m pip install --quiet --requirement clients/requirements-$*.txt --editable .
	@touch $@

train: $(STAMP)  ## Train one policy for all eight insects and print the comparison (about two minutes)
	OMP_NUM_THREADS=1 $(BIN)/python train.py $(ARGS)

test: lint  ## Lint, type-check and run every test, the slow learning tests too
	$(TWO) -m "not browser" $(ARGS)

test-fast: $(STAMP)  ## The tests without those that train a policy
	$(TWO) -m "not slow and not browser" $(ARGS)

test-floor: $(FLOOR)/.installed  ## The environments' tests with the oldest Gymnasium, NumPy and SciPy allowed
	$(FLOOR)/bin/python -m pytest tests/envs $(ARGS)

test-browser: $(STAMP)  ## Report and explorer in Chromium, which is installed where it is missing (Debian, as root)
	@command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null \
		|| { apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -y -q chromium; } \
		|| { echo "make test-browser: no Chromium, and apt-get could not install it; mend: install the package chromium as root" >&2; exit 2; }
	$(BIN)/python -m pytest -m browser $(ARGS)

fuzz: $(VENV)/.fuzz  ## A coverage-guided fuzzer on everything that reads from outside; FUZZ_INPUTS in all (half an hour)
	$(BIN)/python -m tests.fuzzing --inputs $(FUZZ_INPUTS) $(ARGS)

audit: $(AUDIT)/.installed  ## Known holes of what is installed, from PyPI's advisories; needs the network
	$(AUDIT)/bin/pip-audit --requirement constraints.txt --no-deps --disable-pip --strict $(ARGS)

lint: $(STAMP)  ## ruff (lint and format) and mypy
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(STAMP)  ## Let ruff mend what it can
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(STAMP)  ## Wingbeats a second of the oracle, the fast path, the environments and of learning
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1 $(BIN)/python -m benchmarks.speed
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1 $(BIN)/python -m benchmarks.learning

benchmark: $(STAMP)  ## Every learner and every task, five seeds each, two at a time (an hour; goes on where it stopped)
	$(BIN)/python train.py benchmark $(ARGS)

docs: $(STAMP)  ## The documentation site, docs/_build/html/index.html; warnings are errors
	OMP_NUM_THREADS=1 $(BIN)/python -m sphinx --fail-on-warning --keep-going --nitpicky --quiet docs docs/_build/html
	@echo "open docs/_build/html/index.html"

validate: $(STAMP)  ## Tables 2 and 3 of the paper beside ours
	$(BIN)/python -m flapenv.validation

clients: client-ppo client-zoo client-rllib  ## Other projects' learners on ENV_ID=flapenv/Hover-v0, see docs/clients.md

client-ppo: $(STAMP)  ## One of them: the single-file PPO
	OMP_NUM_THREADS=1 $(BIN)/python clients/single_file_ppo.py --env-id flapenv:$(ENV_ID) $(ARGS)

client-zoo: $(ZOO)/.installed  ## One of them: rl-zoo3 with the recipes beside the presets
	OMP_NUM_THREADS=1 $(ZOO)/bin/python -m rl_zoo3.train --algo $(ZOO_ALGO) --env $(ENV_ID) --gym-packages flapenv \
		--conf-file agents/presets/$(ZOO_ALGO).yml --seed 0 --device cpu --log-folder runs/zoo --eval-freq 10000 --eval-episodes 16 $(ARGS)

client-rllib: $(RLLIB)/.installed  ## One of them: RLlib, one process for the native vector environment
	OMP_NUM_THREADS=1 $(RLLIB)/bin/python clients/rllib_ppo.py --env-id flapenv:$(ENV_ID) \
		--vectorize-mode vector_entry_point --env-runners 0 $(ARGS)

clean:  ## Remove the virtual environments, caches and the built site, not the runs
	rm -rf docs/_build $(VENV) $(FLOOR) $(AUDIT) $(ZOO) $(RLLIB) .mypy_cache .pytest_cache .ruff_cache .hypothesis
