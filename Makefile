# make dress | make learn | make ros | make test | make lint | make types | make docs | make lock | make clean
SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help

PYTHON ?= python3.11
SEED ?= 0
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
PIP := $(BIN)/python -m pip --disable-pip-version-check
# What caretree needs of ROS 1, as Debian 12 carries it; the definitions are read by genpy.
ROS := python3-rosmaster python3-rospy python3-actionlib python3-actionlib-msgs python3-genpy python3-geometry-msgs \
  python3-nav-msgs python3-rosgraph-msgs python3-sensor-msgs python3-std-msgs python3-trajectory-msgs

.PHONY: help setup dress learn ros test lint types docs lock clean

help:
	@echo "make dress   set up, then dress the person: gown on the rail to dressed (SEED=$(SEED))"
	@echo "make learn   also install what training and clusters need (torch for the CPU, Ray)"
	@echo "make ros     also install what a robot behind a ROS 1 master needs: Debian's rospy and its master (sudo)"
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

ros: $(READY)
	@command -v apt-get >/dev/null || { echo "there is no apt-get: ROS 1 comes from Debian 12" >&2; exit 2; }
	@echo "installing from Debian, about 40 packages and a minute: $(ROS)"
	@sudo=$$([ "$$(id -u)" = 0 ] || echo sudo); $$sudo apt-get install --quiet --yes --no-install-recommends $(ROS) >$(VENV)/ros.log 2>&1 \
	  || { $$sudo apt-get update --quiet >>$(VENV)/ros.log 2>&1 && $$sudo apt-get install --quiet --yes --no-install-recommends $(ROS) >>$(VENV)/ros.log 2>&1; } \
	  || { tail -n 5 $(VENV)/ros.log >&2; echo "ROS 1 could not be installed: $(VENV)/ros.log" >&2; exit 2; }
	@$(BIN)/python -c "from caretree.sim.ros1.messages import message; message('control_msgs/GripperCommand')" \
	  && echo "ROS 1 is here: caretree robot doctor"

test: $(READY)
	@$(BIN)/python -m pytest --numprocesses auto --maxprocesses 4 --dist loadfile --no-loadscope-reorder --cov --cov-report=term:skip-covered

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
