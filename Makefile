# Blum: the commands of everyday work. `make` lists them.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help setup build python test check demo simulate format lint tidy bench docs coverage asan tsan fuzz configurations install viewer findings clean

PREFIX ?= /usr/local
JOBS ?= $(shell nproc)
DEMO_DIR ?= out/demo
configure_options := $(if $(CI),-DBLUM_WERROR=ON)

help: ## List the commands
	@echo "Blum: exact distance fields and Voronoi diagrams of 3D shapes"
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## */\1\t/' | while IFS=$$'\t' read -r name text; do \
	  printf '  make %-15s %s\n' "$$name" "$$text"; done

setup: ## Install what the build needs (apt, as root or through sudo)
	@tools/setup.sh

build: setup ## Build the library and the tool: build/release/bin/blum
	@tools/build.sh release $(configure_options) -DBLUM_TESTS=OFF
	@echo "make build: the tool is build/release/bin/blum"

test: ## Install what the tests need, build, and run every test
	@tools/test.sh

demo: setup ## Build the tool and run the main job on a generated shape: a field, pictures, a medial axis and a page in out/demo
	@tools/demo.sh --time $(JOBS)
	@tools/build.sh release $(configure_options) -DBLUM_TESTS=OFF -- blum
	@tools/demo.sh build/release/bin/blum $(DEMO_DIR)

simulate: ## Run a simulation, check it for missed collisions, and make a page of it in out/simulations: make simulate S=cloth (or bodies, breaking, large) FRAMES=60
	@tools/setup.sh --tests
	@tools/build.sh release $(configure_options) -DBLUM_TESTS=ON -- blum simulations
	@tools/simulate.sh '$(or $(S),cloth)' out/simulations $(if $(FRAMES),--frames '$(FRAMES)')

python: ## Build the Python package alone: build/release/python, for PYTHONPATH, with the Python of build/venv
	@tools/setup.sh --python
	@tools/build.sh release $(configure_options) -DBLUM_TESTS=OFF -DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$(CURDIR)/build/venv/bin/python" -- blum_python
	@echo "make python: PYTHONPATH=$(CURDIR)/build/release/python build/venv/bin/python"

format: ## Format the sources (clang-format 19)
	@tools/setup.sh --lint
	@tools/format.sh

lint: ## Check format, clang-tidy of what changed, shell scripts, layer rules, words, links, Python and the viewer
	@tools/setup.sh --lint --viewer
	@tools/lint.sh

tidy: ## Check everything with clang-tidy, and record the commit that passed (tools/tidy-base)
	@tools/setup.sh --lint
	@tools/build.sh release -DBLUM_TESTS=ON -DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$(CURDIR)/build/venv/bin/python" -- blum_header_check
	@tools/tidy.py --all

check: ## Build and run the tests whose names match: make check T=geometry, T=test_field.WindingSign, T=pytest.test_cli, T=viewer
	@tools/check.sh '$(T)'

bench: ## Build and run the benchmarks, with their peers
	@tools/bench.sh

viewer: ## Build and test the page of blum view, apps/viewer/dist/viewer.html (Node, Chromium)
	@tools/setup.sh --viewer
	@tools/viewer.sh install
	@tools/viewer.sh build
	@tools/lint.sh viewer
	@tools/viewer.sh all

docs: ## Build the API pages and check the documents' links: build/docs/html/index.html
	@tools/setup.sh --docs
	@tools/docs.sh

coverage: ## Print the share of lines that tests run, by layer: make coverage, or L="core complex" for only these
	@tools/coverage.sh $(L)

asan: ## Run the tests under AddressSanitizer and UndefinedBehaviorSanitizer
	@tools/sanitize.sh asan

tsan: ## Run the tests that use threads under ThreadSanitizer
	@tools/sanitize.sh tsan

fuzz: ## Run every fuzz target for a short while (FUZZ_SECONDS=15 each)
	@tools/fuzz.sh

configurations: ## Build configurations with parts switched off, and test the code without SIMD and threads
	@tools/check_configurations.sh

findings: ## Run the scripts of findings/ on other packages, with pinned versions from PyPI (a few minutes; not part of CI)
	@failed=0; for finding in findings/*.sh; do echo "== $$finding"; "$$finding" || failed=1; done; exit $$failed

install: build ## Install the library and the tool under PREFIX (/usr/local)
	cmake --install build/release --prefix $(PREFIX)

clean: ## Remove all build results
	rm -rf build out
