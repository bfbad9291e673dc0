# Two commands carry the house: `make demo` shows it at work, `make test` proves it.
PYTHON ?= python3
BIN := .venv/bin

# Solvers, finite elements and what is derived of them, a few of each: as long as half a minute on two cores.
KERNEL_TESTS := tests/contact tests/separation tests/loaded/test_balance.py tests/edges/test_free.py \
	tests/loaded/test_load_sharing.py tests/loaded/test_cut_contacts.py tests/compliance/test_dissection.py \
	tests/compliance/test_influence.py tests/compliance/test_finite_elements.py tests/results/test_dynamics.py \
	tests/results/test_figure_slopes.py tests/results/test_mesh_cycle.py tests/flanks/test_tensor_spline.py \
	tests/unloaded/test_path.py --ignore=tests/contact/test_rounded_edge.py

.PHONY: demo quick test tests test-all test-kernel validate pages docs reference-fem lint lint-together clean

# Modules are compiled when they are first imported: all of them at once take pip as long as the rest of its work.
.venv/installed: pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --editable '.[dev]'
	touch $@

demo: .venv/installed
	$(BIN)/loaded-tca demo

# The tests that a change most likely breaks; BASE=REV counts from another revision than HEAD.
BASE ?= HEAD
quick: .venv/installed
	$(BIN)/python -m tests.quick --base $(BASE) -n auto --dist worksteal

lint: .venv/installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python -m tests.annotations
	$(BIN)/lint-imports

# The lint command runs beside the tests, since mypy takes half a minute where it has no cache; its lines come together.
test: .venv/installed
	@$(MAKE) --no-print-directory --jobs 2 lint-together tests

lint-together:
	@lines=$$($(MAKE) --no-print-directory lint 2>&1); code=$$?; printf '\n%s\n' "$$lines"; exit $$code

tests: .venv/installed
	$(BIN)/python -m pytest -n auto --dist worksteal

# Every night, and before a release: the dear tests, too, and hypothesis looks for counterexamples forty times as long.
test-all: .venv/installed
	HYPOTHESIS_PROFILE=nightly $(BIN)/python -m pytest -n auto --dist worksteal -m ""

# With a kernel of OpenBLAS that this machine does not take by itself: rounding differs.
test-kernel: .venv/installed
	OPENBLAS_CORETYPE=$$($(BIN)/python tests/machines.py --other-kernel) \
		$(BIN)/python -m pytest -n auto --dist worksteal $(KERNEL_TESTS)

validate: .venv/installed
	$(BIN)/python -m validation

# Every page with numbers or pictures of its own, made anew: hours on one core; NAMES=... takes those with a word in the name.
pages: .venv/installed
	$(BIN)/python -m validation.pages $(NAMES)

# Runs every example for the gallery the first time; later only those that have changed.
docs: .venv/installed
	OMP_NUM_THREADS=1 $(BIN)/python -m sphinx -W --keep-going -b html docs docs/_build/html

# Takes hours on one core; what is in reference-fem-runs/ already is not run again.
reference-fem: .venv/installed
	@command -v ccx > /dev/null || { echo "needs CalculiX (program ccx; Debian: apt install calculix-ccx)"; exit 1; }
	$(BIN)/python -m validation.calculix --work reference-fem-runs

clean:
	rm -rf docs/_build docs/gallery docs/reference/api docs/reference/generated
	rm -rf .machines .venv loaded-tca-demo .pytest_cache .mypy_cache .ruff_cache .hypothesis
