# Two commands carry the house: `make demo` shows it at work, `make test` proves it.
PYTHON ?= python3
BIN := .venv/bin

.PHONY: demo test tests validate docs reference-fem lint lint-together clean

.venv/installed: pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@

demo: .venv/installed
	$(BIN)/loaded-tca demo

lint: .venv/installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# The lint command runs beside the tests, since mypy takes half a minute where it has no cache; its lines come together.
test: .venv/installed
	@$(MAKE) --no-print-directory --jobs 2 lint-together tests

lint-together:
	@lines=$$($(MAKE) --no-print-directory lint 2>&1); code=$$?; printf '\n%s\n' "$$lines"; exit $$code

tests: .venv/installed
	$(BIN)/python -m pytest -n auto --dist worksteal

validate: .venv/installed
	$(BIN)/python -m validation

# Runs every example for the gallery the first time; later only those that have changed.
docs: .venv/installed
	OMP_NUM_THREADS=1 $(BIN)/python -m sphinx -W --keep-going -b html docs docs/_build/html

# Takes hours on one core; what is in reference-fem-runs/ already is not run again.
reference-fem: .venv/installed
	@command -v ccx > /dev/null || { echo "needs CalculiX (program ccx; Debian: apt install calculix-ccx)"; exit 1; }
	$(BIN)/python -m validation.calculix --work reference-fem-runs

clean:
	rm -rf docs/_build docs/gallery docs/reference/api docs/reference/generated
	rm -rf .venv loaded-tca-demo .pytest_cache .mypy_cache .ruff_cache .hypothesis
