# `make help` lists what there is. Choose an interpreter with PYTHON=python3.12.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check
PROJECT := pyproject.toml game/__init__.py

.DEFAULT_GOAL := help
.PHONY: help play test slow lab notebooks reproduce coaches reference bench lint types contract pins schema

help:  ## list these targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-10s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

play: $(VENV)/play.stamp  ## set the game up (first time) and open it
	@$(BIN)/ana

test: $(VENV)/all.stamp  ## set everything up (first time) and run the tests
	@PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest --numprocesses auto --dist worksteal

slow: $(VENV)/all.stamp  ## run the exhaustive tests
	@$(BIN)/python -m pytest -m slow

lab: $(VENV)/all.stamp  ## open the notebooks on the shipped simulated study
	@$(if $(ANA_SOURCE),ANA_SOURCE=$(abspath $(ANA_SOURCE)) )$(BIN)/jupyter-lab --notebook-dir notebooks

notebooks: $(VENV)/all.stamp  ## run the notebooks and store them with what they show
	@$(BIN)/python -m analysis.execute

reproduce: $(VENV)/all.stamp  ## simulate a study, and make every number, figure and page from it
	@$(BIN)/python -m analysis.reproduce out

COMPARED := static:1,static:2,static:3,ana,ana:calibrated,ana:belief,knowledge,knowledge+quiz,truth
SWITCH := knowledge:switch_gain_ms
SWITCHING := static:1,static:2,static:3,ana,$(SWITCH)=0,$(SWITCH)=500,knowledge,$(SWITCH)=2000,$(SWITCH)=4000,$(SWITCH)=8000,$(SWITCH)=16000

coaches: $(VENV)/all.stamp  ## compare the coaches on simulated people (twenty minutes on two cores)
	@mkdir -p out
	@$(BIN)/ana compare --coaches "$(COMPARED)" --people 100 --json out/coaches.json --figures out/coaches
	@$(BIN)/ana compare --coaches "$(SWITCHING)" --people 100 --worlds default --json out/switching.json

bench: $(VENV)/all.stamp  ## measure speed beside the floors, in one run
	@$(BIN)/python -m tests.bench

lint: $(VENV)/all.stamp  ## check style, format and spelling
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/codespell $$(git ls-files '*.md' '*.py' '*.toml' '*.R' Makefile .ci/run)

types: $(VENV)/all.stamp  ## check the types
	@$(BIN)/mypy

contract: $(VENV)/all.stamp  ## check which room may import which
	@$(BIN)/lint-imports

reference:  ## compute the reference numbers of the statistics again with R, and compare
	@command -v Rscript >/dev/null || { \
	  echo "make reference needs R and its packages, and there is no 'Rscript' here." >&2; \
	  echo "On Debian and Ubuntu: sudo apt install r-base-core r-cran-{afex,emmeans,car,lmertest,psych,bayesfactor,ordinal,pbkrtest,jsonlite}" >&2; exit 2; }
	@cd tests/reference && WRITE=$(WRITE) Rscript reference.R

schema: $(VENV)/all.stamp  ## write the schema of journals from the types
	@$(BIN)/python -m game.journal.schema

COMPILE := $(BIN)/uv pip compile pyproject.toml --universal --python-version 3.11 \
  --generate-hashes --no-header --no-annotate --no-emit-index-url --no-emit-find-links \
  --group build --quiet

pins: $(VENV)/all.stamp  ## resolve the dependencies anew and pin them
	$(COMPILE) --upgrade --extra dev --output-file requirements/all.txt
	$(COMPILE) --upgrade --constraint requirements/all.txt --output-file requirements/play.txt
	$(COMPILE) --upgrade --constraint requirements/all.txt --extra web --output-file requirements/web.txt

# --- set-up -------------------------------------------------------------------------------------

# $(call install,TIER,WORDS): install a tier's pins, then the project itself, saying every ten
# seconds that it goes on; bytecode is made here, so that the first game opens fast.
define install
	@echo "Setting up $(2) ..."
	@while sleep 10 3>&-; do echo "  ... still installing" >&3; done 3>&1 >/dev/null 2>&1 & \
	beat=$$!; trap 'kill $$beat 2>/dev/null' EXIT; trap 'exit 130' INT TERM; \
	$(PIP) install --require-hashes --requirement requirements/$(1).txt && \
	$(PIP) install --quiet --no-deps --no-build-isolation --editable . && \
	$(BIN)/python -m compileall -q game $(3)
endef

$(VENV)/play.stamp: requirements/play.txt $(PROJECT) | $(VENV)/pyvenv.cfg
	$(call install,play,the game)
	@touch $@

$(VENV)/all.stamp: requirements/all.txt requirements/play.txt $(PROJECT) | $(VENV)/pyvenv.cfg
	$(call install,all,the game and everything around it,analysis)
	@touch $(VENV)/play.stamp $@

$(VENV)/pyvenv.cfg:
	@command -v $(PYTHON) >/dev/null || { \
	  echo "ana needs Python 3.11 or newer, and there is no '$(PYTHON)' here." >&2; \
	  echo "Install one, or name it: make $(MAKECMDGOALS) PYTHON=/path/to/python3.12" >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "ana needs Python 3.11 or newer; '$(PYTHON)' is $$($(PYTHON) -V 2>&1)." >&2; \
	  echo "Name a newer one: make $(MAKECMDGOALS) PYTHON=python3.12" >&2; exit 2; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	  echo "'$(PYTHON)' cannot make a virtual environment: venv or ensurepip is missing." >&2; \
	  echo "On Debian and Ubuntu: sudo apt install python3-venv" >&2; exit 2; }
	@echo "Making a virtual environment in $(VENV) ..."
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); exit 1; }
