# `make run` compiles the robot, `make test` runs the tests, `make check` runs all that CI runs.

PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
MODEL ?= models/khepera.bg
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

# Hundreds of commands run in the tests, and each would compile the compiler anew.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help run demo robots test check lint types imports docs site wheel bench vscode edits update fuzz random real mutants faults kills judged account vendored clean

help: ## this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 14

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "Python 3.11 or newer is needed: apt install python3 python3-venv"; exit 1; }
	$(PYTHON) -m venv $(VENV)

# The locked versions of what the compiler needs, and the checkout itself.
$(VENV)/run.stamp: requirements.lock pyproject.toml | $(BIN)/python
	$(PIP) install -r requirements.lock
	$(PIP) install --no-deps --no-build-isolation --editable .
	@touch $@

# The tools of the developers on top.
$(VENV)/dev.stamp: requirements-dev.lock $(VENV)/run.stamp
	$(PIP) install -r requirements-dev.lock
	@touch $@

run: $(VENV)/run.stamp ## compile MODEL (the robot) and print its residuals, signatures and files
	@$(BIN)/bondgraph compile $(MODEL)

# The paper's experiments on a virtual robot. Pages open in a browser where there is a display.
EXPERIMENTS := normal actuator cable
demo: $(VENV)/run.stamp ## the paper's experiments: simulated, watched, written as pages in demo/
	@mkdir -p demo
	@$(BIN)/bondgraph report models/khepera_encoders.bg -o demo/khepera.html \
	$(EXPERIMENTS:%=--scenario models/scenarios/paper_%.toml)
	@$(BIN)/bondgraph report models/khepera_built.bg -o demo/khepera_as_built.html \
	--scenario models/scenarios/paper_cable_unloaded.toml 2> /dev/null
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] && command -v xdg-open > /dev/null; then \
	xdg-open demo/khepera.html; else echo "open demo/khepera.html in a browser"; fi

# Side by side, a file at a time: what the tests of a file share is made once. Their own `make` is
# none of this one's jobs.
test: $(VENV)/dev.stamp ## all tests
	env -u MAKEFLAGS -u MFLAGS $(BIN)/python -m pytest -n $(or $(JOBS),auto) --maxprocesses 8 --dist loadfile --no-loadscope-reorder --durations 60 --durations-min 5 $(TESTS)

check: lint types imports test site wheel ## all that CI runs

lint: $(VENV)/dev.stamp ## style of the Python code, format of the models
	$(BIN)/ruff check bondgraph tests docs/site
	$(BIN)/bondgraph format --check models/*.bg

types: $(VENV)/dev.stamp ## strict type check
	$(BIN)/mypy

imports: $(VENV)/dev.stamp ## the layers of the house
	$(BIN)/lint-imports

docs: $(VENV)/dev.stamp ## the examples and links of the documentation
	$(BIN)/python -m pytest tests/docs

site: $(VENV)/dev.stamp ## the site of the documentation in build/site/html; a warning is an error
	$(BIN)/python docs/site/build.py

wheel: $(VENV)/dev.stamp ## build the wheel, install it elsewhere, compile a model without the checkout
	PYTHON=$(BIN)/python .ci/wheel

# What the bench compares with, each apart from all else: it brings packages of its own. One needs
# a newer Python than this project; without it the bench says that it did not compare.
$(VENV)/bench.stamp: tests/bench/toolbox_requirements.txt tests/bench/newer_requirements.txt | $(BIN)/python
	$(BIN)/python -m venv $(VENV)/toolbox
	-$(VENV)/toolbox/bin/python -m pip --disable-pip-version-check --quiet install -r $<
	-for p in python3.14 python3.13; do $$p -c '' 2>/dev/null || continue; $$p -m venv $(VENV)/newer && \
	$(VENV)/newer/bin/python -m pip --disable-pip-version-check --quiet install \
	-r tests/bench/newer_requirements.txt; break; done
	@touch $@

# Other generators of C, some 600 MB; the short bench goes without.
$(VENV)/generators.stamp: tests/bench/generators_requirements.txt | $(BIN)/python
	$(BIN)/python -m venv $(VENV)/generators
	-$(VENV)/generators/bin/python -m pip --disable-pip-version-check --quiet install -r $<
	@touch $@

bench: $(VENV)/dev.stamp $(VENV)/bench.stamp $(if $(SHORT),,$(VENV)/generators.stamp) ## medians of the times that matter, with their ratios
	BONDGRAPH_BENCH_PYTHON=$(VENV)/toolbox/bin/python \
	BONDGRAPH_BENCH_PEERS=$(VENV)/toolbox:$(VENV)/newer:$(VENV)/generators \
	$(BIN)/python -m tests.bench $(if $(SHORT),--short)

vscode: ## the extension for VS Code, tested and packed in editors/vscode/dist; needs npm
	npm --prefix editors/vscode ci --ignore-scripts
	npm --prefix editors/vscode test
	npm --prefix editors/vscode run pack

edits: $(VENV)/dev.stamp ## 10 000 random edits through the language server, compared with check; half an hour
	$(BIN)/python -m tests.editor_edits $(if $(SEED),--seed $(SEED))

update: $(VENV)/dev.stamp ## write the expected dumps and generated/ anew
	@for model in models/*.bg; do $(BIN)/bondgraph compile $$model --costs > /dev/null || exit 1; done
	$(BIN)/python -m pytest --update $(shell grep -rl --include='test_*.py' 'update: bool' tests)

fuzz: $(VENV)/dev.stamp ## a million hostile models, and 800 000 scenarios, logs, journals, messages ..., by atheris; two hours or more, or MINUTES=... of each kind at a time
	$(BIN)/python -m tests.fuzz.guided --campaign --jobs 2 $(if $(MINUTES),--minutes $(MINUTES))

random: $(VENV)/dev.stamp ## 10 000 random bond graphs, others each time but for START=..., each verified or refused with a reason
	$(BIN)/python -m tests.random.run --count 10000 --jobs 2 $(if $(START),--start $(START))

real: $(VENV)/dev.stamp ## 2 000 random plants: every signature compared with real trajectories
	$(BIN)/python -m tests.real.run --count 2000 --jobs 2

robots: $(VENV)/dev.stamp ## a hundred healthy robots and many faulty ones through the monitor; hours
	$(BIN)/python -m tests.robots.run --jobs 2 $(if $(START),--start $(START))

mutants: $(VENV)/dev.stamp ## 300 mutants of the compiler (or COUNT=...) through the tests that reach them, or (OWN=1) those of the room; hours
	$(BIN)/python -m tests.mutants --count $(or $(COUNT),300) --jobs 2 $(if $(SEED),--seed $(SEED)) $(if $(OWN),--own) $(if $(ONLY),--only $(ONLY))

faults: $(VENV)/dev.stamp ## every writer, killed or failed at every operation on its files, then damage; half an hour
	$(BIN)/python -m tests.file_faults
	$(BIN)/python -m tests.file_faults --damage 10000

kills: $(VENV)/dev.stamp ## monitors of every source, each killed 200 times at random moments; a quarter of an hour
	$(BIN)/python -m tests.kills --times 200 $(if $(SEED),--seed $(SEED))

judged: $(VENV)/dev.stamp ## more random plants before the judge of tests/adversary; some minutes
	BONDGRAPH_MORE=1 $(BIN)/python -m pytest -n 2 tests/adversary -k test_a_random_graph

account: $(VENV)/dev.stamp ## an hour at 1 kHz with a disturbance every minute: the account adds up; some minutes
	$(BIN)/python -m tests.account $(if $(SEED),--seed $(SEED))

vendored: ## what the workbench and the live page use of npm, built anew: the same versions give the same bytes
	cd editors/workbench && npm ci && node build.mjs

clean: ## remove what this file made
	rm -rf $(VENV) build dist .hypothesis .mypy_cache .ruff_cache .pytest_cache .import_linter_cache
