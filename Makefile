# Everything that a checkout needs, from a bare Debian machine with Python 3.11, git and make.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
READY  := $(VENV)/.ready
OUT    := out/paper

.DEFAULT_GOAL := help

.PHONY: help
help:  ## Show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## */  make \1\t/' | expand -t 18

.PHONY: paper
paper: $(READY)  ## Repeat the source paper's experiment and write its report
	@.ci/debian-packages --pango
	$(BIN)/posstats paper --out $(OUT)

.PHONY: test
test: $(READY) lint types  ## Run all checks and tests
	@.ci/debian-packages --pango
	@.ci/debian-packages --browser
	@OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/support/compile_kernels.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -q -n 2 --dist loadfile

.PHONY: lint
lint: $(READY)  ## Check style
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

.PHONY: types
types: $(READY)  ## Check types
	$(BIN)/mypy

.PHONY: benchmark
benchmark: $(READY)  ## Time the relative orientation beside PoseLib, and a whole analysis
	$(BIN)/python benchmarks/relative_orientation.py
	$(BIN)/python benchmarks/analysis.py

.PHONY: coverage
coverage: $(READY)  ## Simulate how often 95 % intervals hold the truth (many minutes)
	$(BIN)/python benchmarks/interval_coverage.py
	$(BIN)/python benchmarks/bundle_coverage.py
	$(BIN)/python benchmarks/acceptance_coverage.py

.PHONY: mutants
mutants: $(READY)  ## Put kept faults into copies of the source: the tests must find each (many minutes)
	@.ci/debian-packages --pango
	$(BIN)/python benchmarks/mutants.py

.PHONY: seeds
seeds: $(READY)  ## Repeat both papers' experiments with 100 seeds and store the findings (an hour)
	$(BIN)/python benchmarks/paper_seeds.py
	$(BIN)/python benchmarks/wucaps_seeds.py

.PHONY: docs
docs: $(READY)  ## Make the tables of keys in docs/ anew from the contract
	$(BIN)/python docs/keys.py

.PHONY: clean
clean:  ## Remove the environment and all output
	rm -rf $(VENV) out build dist *.egg-info

$(READY): pyproject.toml
	@.ci/debian-packages --venv $(PYTHON)
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@
