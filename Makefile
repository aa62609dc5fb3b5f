# SPDX-License-Identifier: GPL-3.0-or-later
# Each target sets up the virtual environment it needs (.venv-5.2, .venv-4.5) by itself.

SHELL := bash
.DEFAULT_GOAL := help

# `make test PYTEST_ARGS="-k furnace -x"` hands options to pytest, TESTS= chooses a folder or file.
TESTS ?= blender_tests
PYTEST_ARGS ?=
# `make test-mutants MUTANTS=tilt` tries those with that word in their name.
MUTANTS ?=
# `make bench BENCH_ARGS="--trial --output build/trial"`; `--help` lists them.
BENCH_ARGS ?=

any = python="$$(tools/environment.sh any)" && "$$python"
on_5.2 = python="$$(tools/environment.sh 5.2)" && "$$python"
on_4.5 = python="$$(tools/environment.sh 4.5)" && "$$python"
pytest = -m pytest -n auto --maxprocesses 4 --dist loadfile $(TESTS) $(PYTEST_ARGS)

# Two targets at once would both make the same virtual environment.
.NOTPARALLEL:

# The folders osl, addon and scenes would otherwise pass for targets that are up to date.
.PHONY: help demo demo-picture materials-picture analysis-demo test test-all test-5.2 test-4.5 test-nightly \
        test-mutants test-window window-pictures lint \
        format addon assets previews references figures tables scenes bench bench-check gains clean

help: ## List the targets
	@awk -F ':.*## ' '/^[a-z0-9.-]+:.*## / { printf "  make %-17s %s\n", $$1, $$2 }' Makefile

demo: ## Render the showcase scene with Single, Cycles Multiscatter and Microbounce; compare
	@$(any) -m scenes.demo

demo-picture: ## The same, and renew docs/comparison.jpg
	@$(any) -m scenes.demo --picture docs/comparison.jpg

materials-picture: ## Render the metal, glass and clay of the README (docs/materials.jpg; about three minutes)
	@$(any) -m scenes.materials_picture

analysis-demo: ## Render twenty materials all in Walk, all Fitted and as analysed; time and error
	@$(any) -m scenes.mixed_demo

test: ## Run the fast tier of the tests on one Blender version (under ten minutes on two cores)
	@$(any) $(pytest)

test-all: ## Run the fast tier on Blender 5.2 and on 4.5
	@$(on_5.2) $(pytest)
	@$(on_4.5) $(pytest)

test-5.2: ## Run the fast tier on Blender 5.2
	@$(on_5.2) $(pytest)

test-4.5: ## Run the fast tier on Blender 4.5
	@$(on_4.5) $(pytest)

# What takes times runs last, alone. Exit status 5 says that TESTS holds nothing of that kind.
test-nightly: ## Run every test on both Blender versions (about an hour on two idle cores)
	@status=0; for version in 5.2 4.5; do \
	  python="$$(tools/environment.sh $$version)" || exit 1; \
	  "$$python" $(pytest) --nightly -m "not timing" || status=1; \
	  "$$python" -m pytest $(TESTS) --nightly -m timing || [ $$? -eq 5 ] || status=1; \
	done; exit $$status

test-mutants: ## Break the code in one place at a time; the fast tier has to notice each
	@$(any) -m blender_tests.mutants $(MUTANTS)

test-window: ## Use the zip in the window of a real Blender: BLENDER=command, or blender on PATH
	@$(any) -m tools.window test

window-pictures: ## The same, and renew the pictures of the panels in docs/
	@$(any) -m tools.window pictures

lint: ## Check the code's form: ruff, and the rules for the OSL sources
	@$(any) -m ruff check . && "$$python" -m ruff format --check . && "$$python" tools/check_osl.py

format: ## Format the Python sources and fix what ruff can fix
	@$(any) -m ruff check --fix . ; "$$python" -m ruff format .

addon: ## Build the extension's zip into dist/ and validate it; needs Python 3.11 for the asset library
	@if python="$$(tools/environment.sh 4.5)"; then "$$python" -m tools.release.assets; \
	else echo "Going on without the asset library, which Blender 4.5 builds." >&2; fi
	@$(any) -m tools.release.extension

assets: ## Build the asset library of the presets into build/assets, with Blender 4.5 so that both open it
	@$(on_4.5) -m tools.release.assets

previews: ## Render the presets' pictures that are missing or old (addon/previews)
	@$(any) -m tools.previews

references: ## Render the oracle's reference pictures again (about 35 minutes)
	@$(any) -m osl.oracle.references

figures: ## Draw the supplement's figures again (docs/figures; about nine minutes on two cores)
	@$(any) -m tools.figures

bench: ## Measure what accuracy costs in time (docs/benchmarks; about 40 minutes on two idle cores)
	@$(any) -m tools.bench $(BENCH_ARGS)

bench-check: ## Fail if a quick benchmark's ratios of times grew (about two minutes)
	@$(any) -m tools.bench --check

gains: ## Measure what each change gained that made the shaders faster (docs/benchmarks/gains.md)
	@$(any) -m tools.bench.gains

tables: ## Fit the shaders' tables again (osl/tables; about nine minutes on two cores)
	@$(any) -m osl.tables

scenes: ## Build the .blend files in scenes/ again, with Blender 4.5 so that both versions open them
	@$(on_4.5) -m scenes.build_all

clean: ## Remove what was built; the virtual environments stay
	@rm -rf build dist .pytest_cache .ruff_cache .hypothesis
	@find . -name '.venv*' -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +
	@find osl -name '*.oso' -delete 2>/dev/null || true
