# Thin names for the usual commands; everything runs from the virtual environment in .venv.
PYTHON ?= .venv/bin/python

.PHONY: setup test check check-real bench

setup:
	python3 -m venv .venv
	.venv/bin/pip install -e '.[dev]'

test:
	$(PYTHON) -m pytest -n auto --maxprocesses 4 --dist loadfile

check:
	$(PYTHON) -m ruff check .
	$(PYTHON) -m ruff format --check .
	$(PYTHON) -m pyright --pythonpath $(PYTHON)
	$(dir $(PYTHON))lint-imports
	$(PYTHON) -m pytest -n auto --maxprocesses 4 --dist loadfile

# The release check: every test that needs the real heads, slow ones included; fails without them.
check-real:
	RISORIUS_REQUIRE_REAL=1 $(PYTHON) -m pytest -m real

bench:
	$(PYTHON) -m pytest benchmarks
