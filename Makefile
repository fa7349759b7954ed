# `make demo` and `make test` install everything that they need, on a fresh machine with Python 3.10 or newer.
# What each target does is in make.py, which also runs where there is no make.
PYTHON ?= python3
VENV ?= .venv
# Which dependency group of pyproject.toml has the tools for pyfrc's tests.
DEV ?= dev
RUN := @$(PYTHON) make.py --venv $(VENV) --group $(DEV)

.PHONY: demo test test-2027 test-like-windows test-like-macos templates-2027 next-preview mutants check check-platforms check-page docs dist install clean

demo:  ## create a robot project in demo/, run its tests, deploy it to a virtual robot, change it, roll back
	$(RUN) demo

test:  ## run pyfrc's own tests; ARGS are passed to pytest
	$(RUN) test $(ARGS)

test-2027:  ## run the tests that season 2027 has, with its WPILib in .venv-2027; needs Python 3.11 or newer, and glibc 2.39 on Linux
	$(MAKE) test VENV=.venv-2027 DEV=dev-2027

test-like-windows:  ## run the tests that are about what Windows lacks or does otherwise, on Linux, like Windows
	$(RUN) test-like-windows $(ARGS)

test-like-macos:  ## the same for macOS
	$(RUN) test-like-macos $(ARGS)

templates-2027:  ## make templates/2027 from the templates of 2026 with pyfrc migrate; ARGS=--patches: see CONTRIBUTING.md
	$(RUN) templates-2027 $(ARGS)

next-preview:  ## install the newest preview of 2027 in .venv-next, run season 2027's tests, and print which names have changed; ARGS=--help
	$(RUN) next-preview $(ARGS)

mutants:  ## change pyfrc in one place at a time, and see whether a test fails; ARGS=--help
	$(RUN) mutants $(ARGS)

check:  ## check style, types, and which room imports which
	$(RUN) check

check-platforms:  ## check the types as on Windows and on macOS
	$(RUN) check-platforms

docs:  ## build the documentation with the API reference in build/docs
	$(RUN) docs

dist:  ## build the wheel and the source distribution in build/dist, and check them; ARGS: the tag of a release
	$(RUN) dist $(ARGS)

install:  ## create the environment only
	$(RUN) install

check-page: node_modules/.package-lock.json  ## check the types and the style of the page's scripts, and run their unit tests; needs npm
	npm run --silent check

# The tools that package-lock.json names, from the network when it has changed. The page itself needs none of them.
node_modules/.package-lock.json: package.json package-lock.json
	npm ci --silent --no-audit --no-fund
	touch $@

clean:
	rm -rf $(VENV) demo build
