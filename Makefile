# `make help` lists the targets
PYTHON ?= python3
PIP := -m pip --disable-pip-version-check --quiet install --require-hashes
VENV := .venv
BIN := $(VENV)/bin
CORES ?= 2

.PHONY: help env paper smoke test test-all test-slurm lint format docs benchmark requests peers diagrams verify publish checkers crate lock clean
.DEFAULT_GOAL := help

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "make %-10s %s\n", $$1, $$2}' Makefile

paper: env ## environment, all computations, and paper/paper.pdf
	$(BIN)/python -m workflow.unlock
	$(BIN)/snakemake --cores $(CORES)

smoke: env ## every rule at reduced sizes, into results/smoke
	$(BIN)/python -m workflow.unlock
	$(BIN)/snakemake --cores $(CORES) --configfile config/smoke.yaml -- all speed_against_error

# two processes, in which the threads of dense linear algebra would be in each other's way
PYTEST := OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 --dist loadgroup
test: env ## the tests but the slowest, a reduced run of the whole workflow among them
	$(PYTEST) -m "not slow"

test-all: env ## all tests
	$(PYTEST)

test-slurm: .venv-slurm/installed ## the reduced run through Slurm gives the same bytes; starts a node if there is none
	.venv-slurm/bin/python -m tests.slurm.trial

.venv-slurm/installed: environment-lock.txt workflow/envs/slurm-lock.txt pyproject.toml
	$(call environment,.venv-slurm,-r environment-lock.txt -r workflow/envs/slurm-lock.txt)
	.venv-slurm/bin/python -m pip install --disable-pip-version-check --quiet --no-deps --no-build-isolation --editable .
	touch $@

lint: env ## style and structure of the sources
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint
	$(BIN)/lint-imports
	$(BIN)/mypy

format: env ## put the sources into the style that lint asks for
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/snakefmt Snakefile workflow

benchmark: env ## speed of the simulation; PEERS=python measures others beside it
	$(BIN)/python -m benchmarks.speed $(PEERS)

requests: env ## what a tolerance costs, against the best choice in hindsight
	$(BIN)/python -m benchmarks.requests

peers: ## the environment of the peers that the diagrams compare with
	$(PYTHON) -m venv .venv-peers
	.venv-peers/bin/python -m pip install --disable-pip-version-check --progress-bar off -r benchmarks/peers.txt

verify: env ## compare results/ with what was published, paper/published.json
	$(BIN)/python -m reproduction.published verify

publish: env ## make results/, of a full run, what verify compares with
	$(BIN)/python -m reproduction.published publish

# on an idle machine
diagrams: env ## measure speed against error anew, and refresh the copies in docs/
	$(BIN)/python -m workflow.unlock
	$(BIN)/snakemake --cores 1 --forcerun measure_pde measure_monte_carlo measure_crossing measure_rare measure_gamma2 measure_pathwise measure_cost -- speed_against_error
	cp results/figures/speed_pde.png results/figures/speed_pde.pdf results/figures/speed_crossing.png results/figures/speed_crossing.pdf results/figures/speed_rare.png docs/

# uv, itself checked and installed by pip, takes seconds; where it cannot run, pip takes a minute.
# Bytecode is made here, but for the packages' own tests: a hundred jobs import the same packages, and
# may not be allowed to keep it. A file that is not for this Python is no reason to stop.
define environment
$(PYTHON) -m venv $(1)
$(1)/bin/python $(PIP) -r workflow/envs/installer-lock.txt && $(1)/bin/uv pip install --quiet --python $(1)/bin/python --require-hashes $(2) || $(1)/bin/python $(PIP) $(2)
-$(1)/bin/python -m compileall -qq -j 0 -x '[/\\]tests?[/\\]' $(1)/lib
endef

env: $(VENV)/installed ## the environment alone, in .venv

$(VENV)/installed: environment-lock.txt pyproject.toml
	$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11) and 'nonsmooth needs Python >= 3.11; set PYTHON=python3.11 or newer')"
	$(call environment,$(VENV),-r environment-lock.txt)
	$(BIN)/python -m pip install --disable-pip-version-check --quiet --no-deps --no-build-isolation --editable .
	$(BIN)/python -m compileall -q src
	$(BIN)/python -m nonsmooth
	touch $@

# the manual has an environment of its own
docs: env .venv-docs/installed ## build the manual, docs/_build/html/index.html
	mkdir -p docs/generated
	$(BIN)/snakemake --rulegraph mermaid-js > docs/generated/rule_graph.txt
	.venv-docs/bin/python -m sphinx -W --keep-going -n -q -b html docs docs/_build/html

.venv-docs/installed: docs/environment-lock.txt pyproject.toml
	$(call environment,.venv-docs,-r docs/environment-lock.txt)
	.venv-docs/bin/python -m pip install --disable-pip-version-check --quiet --no-deps --no-build-isolation --editable .
	touch $@

checkers: .venv-checkers/installed ## the environment that checks CF conventions and provenance

.venv-checkers/installed: workflow/envs/checkers-lock.txt
	$(call environment,.venv-checkers,-r workflow/envs/checkers-lock.txt)
	touch $@

AGENT ?= $(shell git config user.name)
crate: checkers ## pack the finished run with its provenance into results/crate.zip
	.venv-checkers/bin/python workflow/crate.py --agent "$(AGENT)"
	.venv-checkers/bin/runcrate report results/crate.zip > results/crate.txt

# all dependencies, for all platforms and Python versions
lock: ## pin the environments anew; needs uv
	uv pip compile pyproject.toml --extra workflow --extra test --extra lint --extra build --universal --python-version 3.11 --generate-hashes --no-emit-index-url --output-file environment-lock.txt
	uv pip compile pyproject.toml --extra docs --extra build --constraint environment-lock.txt --universal --python-version 3.11 --generate-hashes --no-emit-index-url --output-file docs/environment-lock.txt
	uv pip compile --group pyproject.toml:checkers --universal --python-version 3.11 --generate-hashes --no-emit-index-url --output-file workflow/envs/checkers-lock.txt
	uv pip compile --group pyproject.toml:installer --universal --python-version 3.11 --generate-hashes --no-emit-index-url --output-file workflow/envs/installer-lock.txt
	uv pip compile --group pyproject.toml:slurm --constraint environment-lock.txt --universal --python-version 3.11 --generate-hashes --no-emit-index-url --output-file workflow/envs/slurm-lock.txt

clean: ## remove what was computed, built or drawn
	find results -mindepth 1 -maxdepth 1 ! -name README.md -exec rm -rf {} +
	rm -rf paper/paper.pdf .snakemake docs/_build docs/generated docs/gallery docs/api/functions docs/sg_execution_times.rst
	find src workflow tests -name __pycache__ -prune -exec rm -rf {} +
