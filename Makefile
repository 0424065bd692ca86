# make dress | make learn | make test | make lint | make types | make docs | make lock | make clean
SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help

PYTHON ?= python3.11
SEED ?= 0
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
PIP := $(BIN)/python -m pip --disable-pip-version-check

.PHONY: help setup dress learn test lint types docs lock clean

help:
	@echo "make dress   set up, then dress the person: gown on the rail to dressed (SEED=$(SEED))"
	@echo "make learn   also install what training and clusters need (torch for the CPU, Ray)"
	@echo "make test    set up, then run the tests with the coverage floor of pyproject.toml"
	@echo "make lint    ruff;   make types   pyright;   make docs   API pages, into build/api"
	@echo "make lock    renew requirements.lock;   make clean"

setup: $(READY)

# Everything comes from the lock file; the package itself is editable and brings nothing along.
$(READY): requirements.lock setup.cfg pyproject.toml
	@command -v $(PYTHON) >/dev/null || { echo "$(PYTHON) is not here, but Python 3.11 is asked for (PYTHON=/path/to/python3.11)" >&2; exit 2; }
	@test -x $(BIN)/python || { echo "creating $(VENV)"; $(PYTHON) -m venv $(VENV); }
	@echo "installing $$(grep -c '^[^#]' requirements.lock) locked packages: about 0.6 GB to download, 2 GB on disk"
	@$(PIP) install -r requirements.lock 2>&1 | tee $(VENV)/install.log \
	  | sed -nuE -e 's/^ *(Downloading|Using cached|Processing) ([^ ]*\/)?/  /p' -e 's/^(Installing).*/  installing/p' -e '/^ERROR/p'
	@$(PIP) install --quiet --no-deps --no-build-isolation --editable . >>$(VENV)/install.log 2>&1 \
	  || { tail -n 20 $(VENV)/install.log >&2; exit 2; }
	@touch $@

dress: $(READY)
	@$(BIN)/caretree run dressing --seed $(SEED)

# An index that does not answer is only a warning to pip: then PyPI's build of torch is taken.
learn: $(READY)
	@$(PIP) install --quiet --no-deps --extra-index-url https://download.pytorch.org/whl/cpu -r requirements-learn.lock

test: $(READY)
	@$(BIN)/python -m pytest --cov --cov-report=term:skip-covered

lint: $(READY)
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check --quiet

types: $(READY)
	@$(BIN)/pyright

docs: $(READY)
	@$(BIN)/python docs/build_api.py build/api

# Resolves setup.cfg afresh in a throw-away environment and writes down what came out.
lock:
	@rm -rf $(VENV)-lock && $(PYTHON) -m venv $(VENV)-lock
	@$(VENV)-lock/bin/python -m pip --disable-pip-version-check install --upgrade setuptools '.[dev]'
	@{ sed -n '/^#/p' requirements.lock; $(VENV)-lock/bin/python -m pip freeze --all --exclude pip --exclude caretree \
	  | grep -v '^#\|^-e\|@ file:'; } >requirements.lock.new
	@mv requirements.lock.new requirements.lock && rm -rf $(VENV)-lock

clean:
	rm -rf $(VENV) *.egg-info build .pytest_cache .ruff_cache .coverage
