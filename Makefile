# `make demo` and `make test` install everything that they need, on a fresh machine with Python 3.10 or newer.
PYTHON ?= python3
VENV ?= .venv
# Which of the extras in pyproject.toml has the tools for pyfrc's tests.
DEV ?= dev
RUN := $(VENV)/bin/python -m
# Two more than the number of processors, because many tests wait for other programs.
WORKERS ?= $(shell expr 2 + $$(getconf _NPROCESSORS_ONLN))

# Without compiled modules, each of many processes compiles the tests and pytest's plugins again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test test-2027 templates-2027 check check-platforms check-page docs clean

demo: $(VENV)/installed  ## create a robot project in demo/, run its tests, deploy it to a virtual robot, change it, roll back
	test -d demo || $(RUN) pyfrc init demo
	$(RUN) pyfrc test --project demo --coverage
	$(RUN) pyfrc virtual-robot --directory demo/.pyfrc/virtual-robot --fresh -- $(VENV)/bin/python tests/demo.py demo

test: $(VENV)/installed-dev  ## run pyfrc's own tests; ARGS are passed to pytest
	$(RUN) pytest -n $(WORKERS) --dist worksteal $(ARGS)

test-2027:  ## run the tests that season 2027 has, with its WPILib in .venv-2027; needs Python 3.11 or newer, and glibc 2.39 on Linux
	$(MAKE) test VENV=.venv-2027 DEV=dev-2027

templates-2027: $(VENV)/installed-dev  ## make templates/2027 from the templates of 2026 with pyfrc migrate; ARGS=--patches: see CONTRIBUTING.md
	$(VENV)/bin/python tests/make_2027.py $(ARGS)

check: $(VENV)/installed-dev  ## check style, types, and which room imports which
	$(RUN) ruff check .
	$(RUN) ruff check --quiet --preview --select PLW1514 .  # text files of unnamed encoding: on Windows, they are cp1252
	$(RUN) ruff format --check .
	$(RUN) mypy
	$(VENV)/bin/lint-imports --no-logo

check-platforms: $(VENV)/installed-dev  ## check the types as on Windows and on macOS: which names their Python lacks
	$(RUN) mypy --platform win32 --cache-dir .mypy_cache/win32
	$(RUN) mypy --platform darwin --cache-dir .mypy_cache/darwin

check-page: node_modules/.package-lock.json  ## check the types and the style of the page's scripts, and run their unit tests; needs npm
	npm run --silent check

# The tools that package-lock.json names, from the network when it has changed. The page itself needs none of them.
node_modules/.package-lock.json: package.json package-lock.json
	npm ci --silent --no-audit --no-fund
	touch $@

docs: $(VENV)/installed-dev  ## build the documentation with the API reference in build/docs
	$(RUN) sphinx -q -E -W --keep-going docs build/docs

# Remove an environment without pip, as Debian's Python creates it if python3-venv is missing.
$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10) and "pyfrc needs Python 3.10 or newer; if you have one: make PYTHON=python3.13")'
	$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); exit 1; }

$(VENV)/installed: pyproject.toml | $(VENV)/bin/python
	@echo "Installing pyfrc and WPILib in $(VENV), from the network: this may take a few minutes."
	$(RUN) pip install --quiet --editable .
	touch $@

$(VENV)/installed-dev: pyproject.toml | $(VENV)/bin/python
	@echo "Installing pyfrc, WPILib and the tools for pyfrc's tests in $(VENV), from the network: this may take a few minutes."
	$(RUN) pip install --quiet --editable ".[$(DEV)]"
	touch $@ $(VENV)/installed

clean:
	rm -rf $(VENV) demo build/docs
