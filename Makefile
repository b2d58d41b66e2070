# One command for each thing a person does. `make demo` and `make test` set up what they need on a bare machine.
PYTHON ?= python3.11
BIN := .venv/bin
SOURCES := vipo_site vipo_device registry editor simulation execution connectors firmware/robot_agent tests bench scripts manage.py
FRONTEND_SOURCES := $(shell find frontend/src frontend/public frontend/index.html frontend/vite.config.ts -type f 2>/dev/null)

.PHONY: demo test test-python check check-beside check-again check-static check-frontend check-units bench chaos mutation audit checks-page pictures constructs openapi format frontend setup setup-dev servers clean

demo: setup frontend
	@exec $(BIN)/python -m vipo_site.demo

setup: .venv/.runtime
setup-dev: .venv/.dev frontend/node_modules/.stamp

.venv/bin/pip:
	@command -v $(PYTHON) >/dev/null || { echo "VIPO needs Python 3.11 (PyBullet has no wheel for later ones). Install it, or name it: make PYTHON=/path/to/python3.11"; exit 1; }
	@echo "Making a Python environment in .venv"
	@$(PYTHON) -m venv .venv

.venv/.runtime: pyproject.toml constraints.txt | .venv/bin/pip
	@echo "Installing the Python packages (about a minute the first time)"
	@$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable .
	@touch $@

.venv/.dev: pyproject.toml constraints.txt | .venv/bin/pip
	@echo "Installing the Python packages for development and tests"
	@$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	@touch .venv/.runtime $@

frontend/node_modules/.stamp: frontend/package.json frontend/package-lock.json
	@command -v npm >/dev/null || { echo "VIPO's pages are built with Node 20 and npm. Install them and try again."; exit 1; }
	@echo "Installing the frontend's packages (about a minute the first time)"
	@cd frontend && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

frontend/dist/index.html: frontend/node_modules/.stamp $(FRONTEND_SOURCES)
	@echo "Building the frontend"
	@cd frontend && npx vite build --logLevel warn
	@touch $@

frontend: frontend/dist/index.html

servers:
	@sh scripts/install-test-servers.sh

format: setup-dev
	$(BIN)/ruff check --fix --quiet $(SOURCES) ; $(BIN)/ruff format --quiet $(SOURCES)
	cd frontend && npx oxfmt src

check: check-static
	@$(MAKE) --no-print-directory --jobs=2 --output-sync=target check-frontend check-units

check-static: setup-dev
	$(BIN)/ruff format --check --quiet $(SOURCES)
	$(BIN)/ruff check --quiet $(SOURCES)
	$(BIN)/mypy
	$(BIN)/lint-imports

check-frontend: setup-dev
	cd frontend && npm run --silent check && npm run --silent test

check-units: setup-dev
	$(BIN)/python -m pytest -q -p no:schemathesis --numprocesses=2 --dist=loadfile --no-loadscope-reorder tests/unit

# Fetching waits for the network and tests wait for each other's clocks, so things stand beside each other here: three
# processes of tests on two cores, and the static checks beside them. Tests start hundreds of Python processes, which
# read compiled modules also where the surroundings say that none are to be written.
test:
	@$(MAKE) --no-print-directory --jobs=3 setup-dev servers frontend
	@rm -f var/beside-failed
	@$(MAKE) --no-print-directory --jobs=2 test-python check-beside; ended=$$?; \
	if [ -e var/beside-failed ]; then $(MAKE) --no-print-directory check-again || ended=1; fi; exit $$ended

test-python:
	@rm -f .pytest_cache/v/cache/lastfailed
	PYTHONDONTWRITEBYTECODE= VIPO_STEADY=1 $(BIN)/python -m pytest --tb=native --durations=25 --numprocesses=3 --dist=loadfile --no-loadscope-reorder \
		|| { test $$? -eq 1 && PYTHONDONTWRITEBYTECODE= VIPO_STEADY=1 $(BIN)/python -m scripts.retry_failed; }

# What nobody waits for gives way to what browsers and servers do meanwhile.
check-beside:
	@nice -n 5 $(MAKE) --no-print-directory --output-sync=target check-frontend check-static \
		|| { mkdir -p var && touch var/beside-failed; }

# Pages' tests have clocks, too: what failed beside browsers and servers is tried once more, alone, and said last.
check-again:
	@echo "Checks failed beside the tests and are tried once more, alone. Please look into it: what failed stands above."
	@$(MAKE) --no-print-directory check-static check-frontend

constructs: setup-dev
	$(BIN)/python manage.py constructs
	@$(MAKE) --no-print-directory openapi

openapi: setup-dev
	$(BIN)/python manage.py openapi
	cd frontend && npm run --silent api

checks-page: setup-dev
	$(BIN)/python -m scripts.checks_page > docs/language/checks.md.new && mv docs/language/checks.md.new docs/language/checks.md

pictures: setup-dev servers frontend
	$(BIN)/python -m scripts.screenshots

bench: setup-dev
	$(BIN)/python -m bench

chaos: RUNS ?= 1000
chaos: SEEDS ?= 1 2 3
chaos: setup-dev servers
	$(BIN)/python -m scripts.chaos --runs $(RUNS) --seed $(SEEDS)

mutation: OF ?= language
mutation: MUTANTS ?= 150
mutation: SEED ?= 0
mutation: setup-dev var/mutation/bin/cosmic-ray
	$(BIN)/python scripts/mutation.py --of $(OF) --mutants $(MUTANTS) --seed $(SEED)

var/mutation/bin/cosmic-ray:
	@echo "Installing the mutation tester into an environment of its own"
	@$(PYTHON) -m venv var/mutation && var/mutation/bin/pip install --quiet --disable-pip-version-check cosmic-ray==8.7.0

audit: var/audit/bin/pip-audit
	@$(PYTHON) scripts/audit.py

var/audit/bin/pip-audit:
	@echo "Installing pip-audit into an environment of its own"
	@$(PYTHON) -m venv var/audit && var/audit/bin/pip install --quiet --disable-pip-version-check pip-audit==2.10.1

clean:
	rm -rf .venv frontend/node_modules frontend/dist var
