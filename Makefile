# `make help` lists the targets
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
CORES ?= 2

.PHONY: env paper smoke test lint format benchmark requests peers diagrams lock clean

paper: env
	$(BIN)/snakemake --cores $(CORES)

smoke: env
	$(BIN)/snakemake --cores $(CORES) --configfile config/smoke.yaml -- all speed_against_error

test: env
	$(BIN)/python -m pytest

lint: env
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint

format: env
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/snakefmt Snakefile workflow

# PEERS: python of an environment made from benchmarks/peers.txt, to measure them too
benchmark: env
	$(BIN)/python -m benchmarks.speed $(PEERS)

# what a tolerance costs, against the best choice in hindsight
requests: env
	$(BIN)/python -m benchmarks.requests

# the peers' environment, which the work-precision diagrams then use
peers:
	$(PYTHON) -m venv .venv-peers
	.venv-peers/bin/python -m pip install --disable-pip-version-check --progress-bar off -r benchmarks/peers.txt

# measures anew, on an idle machine, and refreshes the copies in docs/
diagrams: env
	$(BIN)/snakemake --cores 1 --forcerun measure_pde measure_monte_carlo measure_crossing measure_gamma2 measure_pathwise measure_cost -- speed_against_error
	cp results/figures/speed_pde.png results/figures/speed_pde.pdf results/figures/speed_crossing.png results/figures/speed_crossing.pdf docs/

env: $(VENV)/installed

$(VENV)/installed: environment-lock.txt pyproject.toml
	$(PYTHON) -c "import sys; sys.exit(sys.version_info < (3, 11) and 'nonsmooth needs Python >= 3.11; set PYTHON=python3.11 or newer')"
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --disable-pip-version-check --progress-bar off --require-hashes -r environment-lock.txt
	$(BIN)/python -m pip install --disable-pip-version-check --no-deps --no-build-isolation --editable .
	touch $@

# needs uv; pins every dependency of pyproject.toml for all platforms and Python versions
lock:
	uv pip compile pyproject.toml --all-extras --universal --python-version 3.11 --generate-hashes --no-emit-index-url --output-file environment-lock.txt

clean:
	rm -rf results paper/paper.pdf .snakemake
	find src workflow tests -name __pycache__ -prune -exec rm -rf {} +
