# Each of the first two does all the set-up it needs, on a fresh machine with Python 3.10 to 3.14.
PYTHON ?= python3
VENV ?= .venv
RUN := $(VENV)/bin/python -m
# One more than there are processors, since some tests wait for what others' programs do.
WORKERS ?= $(shell expr 1 + $$(getconf _NPROCESSORS_ONLN))

.PHONY: demo test check docs clean

demo: $(VENV)/installed  ## make a robot project in demo/, run its tests, deploy it to a look-alike of a roboRIO
	test -d demo || $(RUN) pyfrc init demo
	$(RUN) pyfrc test --project demo --coverage
	$(RUN) tests.roborio -- $(VENV)/bin/pyfrc deploy --project demo --robot

test: $(VENV)/installed-dev  ## run this project's own tests; ARGS go to pytest
	$(RUN) pytest -n $(WORKERS) --dist worksteal $(ARGS)

check: $(VENV)/installed-dev  ## the style and the types
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(RUN) mypy

docs: $(VENV)/installed-dev  ## these pages, and the API reference from the docstrings, in build/docs
	$(RUN) sphinx -q -E -W --keep-going docs build/docs

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/installed: pyproject.toml | $(VENV)/bin/python
	$(RUN) pip install --quiet --editable .
	touch $@

$(VENV)/installed-dev: pyproject.toml | $(VENV)/bin/python
	$(RUN) pip install --quiet --editable ".[dev]"
	touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) demo build/docs
