# Two commands matter: `make lab` opens the course, `make test` runs everything. `make help` lists the rest.
# They need only Python 3.11 or newer with its venv module.
VENV := .venv
BIN  := $(VENV)/bin
NB   ?= 07

# Exits with an error unless Python is new enough.
NEW_ENOUGH := import sys; sys.exit(sys.version_info < (3, 11))

# The first interpreter that runs and is new enough; choose another with `make lab PYTHON=/path/to/python`.
PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11 python3.14; do \
	$$p -c '$(NEW_ENOUGH)' >/dev/null 2>&1 && { echo $$p; break; }; done)

# Python keeps what it compiled of the packages: the tests start hundreds of processes, and each would compile them again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help lab demo doctor test imported tracker unit quick notebooks pages browser fuzz lint results bench pretrained student clean
.DEFAULT_GOAL := help

help: ## this list
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /\1|/' | awk -F'|' '{printf "  make %-11s %s\n", $$1, $$2}'

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "No Python 3.11 or newer found. Install one, or say where it is: make lab PYTHON=..."; exit 1; }
	@command -v "$(firstword $(PYTHON))" >/dev/null || { echo "There is no Python at $(PYTHON). Leave PYTHON out, or name another."; exit 1; }
	@$(PYTHON) -c '$(NEW_ENOUGH)' || { echo "$(PYTHON) is too old: Python 3.11 or newer is needed."; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
		echo "$(PYTHON) cannot make virtual environments. On Debian or Ubuntu: apt-get install python3-venv"; exit 1; }

# Installs the course with the extras in $(1) and pip's options in $(2), or says in plain words why it cannot. The full output of pip is in $(VENV)/pip.log.
NO_NETWORK := NewConnectionError|ConnectTimeoutError|NameResolutionError|Failed to establish|Network is unreachable|from versions: none
# The pip that comes with an older Python takes twice as long to find the versions. So a newer one comes first, where it can be had.
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt
define install
@$(BIN)/python -c '$(NEW_ENOUGH)' || { echo "$(VENV) was made with a Python older than 3.11."; \
	echo "Remove it (rm -rf $(VENV)) and run the same command again."; exit 1; }
@echo "installing into $(VENV); this happens once and takes a minute or more"
@{ $(PIP) --retries 0 --upgrade pip; $(PIP) $(2) -e '.$(1)'; } >$(VENV)/pip.log 2>&1 || { \
	if grep -qE '$(NO_NETWORK)' $(VENV)/pip.log; then \
		echo "No network: pip could not reach the package index, which it needs for the first installation."; \
		echo "Connect to the network and run the same command again. The output of pip is in $(VENV)/pip.log"; \
	else cat $(VENV)/pip.log; echo "pip could not install the course; its output is above."; fi; exit 1; }
endef

# Each installation leaves a stamp file. So a second `make lab` starts at once, and a changed requirement installs again.
$(VENV)/.lab: pyproject.toml constraints.txt setup.py | $(BIN)/python
	$(call install,)
	@touch $@

# Python compiles what the tests import when it is first imported, which is the smaller part of all that is installed.
$(VENV)/.test: pyproject.toml constraints.txt setup.py | $(BIN)/python
	$(call install,[test],--no-compile)
	@touch $@ $(VENV)/.lab

$(VENV)/.bench: pyproject.toml constraints.txt setup.py | $(BIN)/python
	$(call install,[bench])
	$(PIP) --no-deps $(BARE_PEERS)
	@touch $@

# The benchmarks use one module of each of these two peers. Their requirements would bring a torchvision that does not fit a CPU torch.
BARE_PEERS := smalldiffusion denoising-diffusion-pytorch

lab: $(VENV)/.lab ## set up .venv and open JupyterLab in your own copy of the notebooks (FRESH=03: a fresh copy of one)
	@$(BIN)/python -m motiondiff_edu lab $(foreach number,$(FRESH),--fresh $(number)) $(OPTIONS)

demo: $(VENV)/.lab ## open one notebook ready to show: make demo NB=07
	@$(BIN)/python -m motiondiff_edu demo $(NB) $(OPTIONS)

doctor: $(VENV)/.lab ## one page: what works here, and what to do about the rest
	@$(BIN)/python -m motiondiff_edu doctor

# Linters use one core each, and so does what the workers find ready; side by side they leave none idle.
test: $(VENV)/.test ## set up .venv and run everything: lint, unit tests, notebooks, browser
	@$(MAKE) --no-print-directory -j3 imported tracker lint
	@$(MAKE) --no-print-directory unit
	@$(MAKE) --no-print-directory notebooks
	@$(MAKE) --no-print-directory browser

# What each worker would otherwise do for itself when it starts: Python's bytecode of all that the tests import,
imported: $(VENV)/.test
	@$(BIN)/python -m pytest -q -p no:nbmake --collect-only -m "not browser" >/dev/null || true # what is wrong with a test, its run says

# and librosa's functions, compiled (conftest.py gives each worker a copy).
tracker: $(VENV)/.test
	@test -d build/numba/first || { rm -rf build/numba/begun && mkdir -p build/numba/begun && \
		NUMBA_CACHE_DIR=build/numba/begun $(BIN)/python -m motiondiff_edu.conditions.compiled && mv build/numba/begun build/numba/first; }

# A worker that dies ends the run as a failure. By default pytest-xdist starts another one, and may then wait for ever.
# The plugin that runs notebooks takes longer to import than all of pytest.
WORKERS := -n auto --max-worker-restart=0 -p no:nbmake

unit: $(VENV)/.test ## only the unit tests
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -q $(WORKERS) --dist loadfile --durations=40 -m "not browser"

# The notebooks run in parallel with one thread each. With torch's own threads, two in parallel take four times as long as in turn.
# The student edition is the same but for the exercises, which the unit tests run (docs/CONTRIBUTING.md), so it is not run again here.
# The two longest come first, then the last: the short ones among the first then fill what is left of the time.
# A kernel that starts, or sends its figures, leaves its core idle: so there is one notebook more than there are cores.
# Copies are run, whose outputs are kept for the pages; for them, figures with sliders are drawn in several states.
NOTEBOOKS ?= notebooks
EXECUTED := build/executed
notebooks: $(VENV)/.test ## only the notebooks (NOTEBOOKS=notebooks/student: the student edition)
	rm -rf $(EXECUTED) && mkdir -p $(EXECUTED) && cp $(if $(filter %.ipynb,$(NOTEBOOKS)),$(NOTEBOOKS),$(NOTEBOOKS)/[0-9]*.ipynb) $(EXECUTED)
	MOTIONDIFF_PAGES=$(PAGES) OMP_NUM_THREADS=1 $(BIN)/python -m pytest -q -n $$(( $$(getconf _NPROCESSORS_ONLN) + 1 )) --max-worker-restart=0 --nbmake --nbmake-timeout=600 --overwrite \
		--durations=0 $$(ls $(EXECUTED)/0[57]_*.ipynb 2>/dev/null; ls -r $(EXECUTED)/*.ipynb | grep -v '/0[57]_')
	$(BIN)/python tools/backed_numbers.py $(EXECUTED)

pages: PAGES := 1
pages: notebooks ## run the notebooks and write them as web pages that need no network: build/pages/index.html
	$(BIN)/python -m tools.pages $(EXECUTED) build/pages

# Only files that say "browser" are collected (tests/conftest.py sees to it that all of its tests are in such files).
browser: $(VENV)/.test ## only the tests that need Chromium
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -q $(WORKERS) --dist loadfile -m browser $$(grep -rlw --include='test_*.py' browser tests)

fuzz: $(VENV)/.test ## 2,000 damaged files and odd inputs for each reader (EXAMPLES=N: another number)
	MOTIONDIFF_FUZZ=$(or $(EXAMPLES),2000) OMP_NUM_THREADS=1 $(BIN)/python -m pytest -q $(WORKERS) tests/fuzz

# The tests of tests/quick.txt: the two papers' ideas, the space around them, and the layers.
quick: $(VENV)/.test ## the tests of the heart of the library, in a minute and a half
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -q $(WORKERS) --dist loadfile @tests/quick.txt

lint: $(VENV)/.test ## ruff, types, the form of the notebooks, the student edition
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check --quiet motiondiff_edu data_synth tools benchmarks tests
	$(BIN)/python -m mypy
	$(BIN)/python tools/check_notebooks.py
	$(BIN)/python tools/build_student.py --check

student: $(VENV)/.test ## rebuild notebooks/student from notebooks (FORCE=1: also files that were changed by hand)
	@$(BIN)/python tools/build_student.py $(if $(FORCE),--force)

results: $(VENV)/.lab ## recompute docs/results and docs/RESULTS.md; with FULL=1 also train the compared networks (hours)
	$(BIN)/python -m tools.results $(if $(FULL),--full)

bench: $(VENV)/.bench ## measure against the public peers into benchmarks/results
	$(BIN)/python -m benchmarks

pretrained: $(VENV)/.lab ## train all shipped weights again (hours)
	$(BIN)/python -m motiondiff_edu.recipes --out motiondiff_edu/pretrained

clean: ## remove .venv and build files; keep trainings in progress (build/runs) and rollouts (build/results)
	rm -rf $(VENV) build/bdist* build/numba build/lib build/quick build/executed build/pages dist *.egg-info .pytest_cache .ruff_cache .mypy_cache
