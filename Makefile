# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

PYTHON ?= python3
ENVIRONMENT := $(PYTHON) .ci/environment.py
VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' blender_manifest.toml)
ZIP := $(CURDIR)/build/framelet-$(VERSION).zip

# The Blender versions that are supported, and the one for everyday work.
BLENDERS := 4.2 4.5 5.2
BLENDER := 4.5

# Each pytest run is killed after this many seconds: a Blender that hangs must not hang us.
TIMEOUT ?= 1200
GUI_TIMEOUT ?= 3600
HUNT_TIMEOUT ?= 14400

# Changes of the code that are tried in each room.
MUTANTS ?= 40

# Tests run in this many processes at once: one more than there are cores, as tests wait for programs that they
# start. 0 is none but pytest itself. Never more than eight, as each holds a whole Blender in memory.
JOBS ?= $(shell $(PYTHON) -c "import os; print(1 + (os.cpu_count() or 1))")
PYTEST := -m pytest -n $(JOBS) --maxprocesses 8 --dist worksteal

# These read and write mesh files without Blender's help: where several Blenders are tested, one is enough.
WITHOUT_BPY := $(patsubst %,tests/blender/command_line/test_%.py,arguments frames region shared_meshes)

# Two targets must not make the same environment at once.
.NOTPARALLEL:
.DEFAULT_GOAL := help

.PHONY: help
help: ## Show this list
	@awk -F ':.*## ' '/^[a-z0-9.-]+:.*## / {printf "  %-20s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

.PHONY: demo
demo: ## Denoise a noisy mesh without a screen; pictures and numbers go to build/demo
	$(ENVIRONMENT) run bpy-$(BLENDER) --timeout $(TIMEOUT) -- docs/demo/run.py --output build/demo

.PHONY: test
test: test-core test-$(BLENDER) test-installed-$(BLENDER) ## Test on one Blender: core, operators, installed zip

.PHONY: test-all
test-all: lint-and-training test-core numbers $(BLENDERS:%=test-%) $(BLENDERS:%=test-installed-%) ## Lint, then test on every supported Blender
test-all: LEFT_OUT = $(if $(filter-out $(BLENDER),$*),$(WITHOUT_BPY:%=--ignore=%))

.PHONY: lint
lint: ## Check style and types
	$(ENVIRONMENT) run core --timeout $(TIMEOUT) -- -m ruff check
	$(ENVIRONMENT) run core --timeout $(TIMEOUT) -- -m ruff format --check
	mkdir -p build/typing && ln -sfn ../.. build/typing/framelet
	$(ENVIRONMENT) run core --timeout $(TIMEOUT) -- -m mypy

.PHONY: format
format: ## Format the code and fix what ruff can fix
	$(ENVIRONMENT) run core -- -m ruff check --fix
	$(ENVIRONMENT) run core -- -m ruff format

.PHONY: test-core
test-core: ## Test core/, files and the release rules on plain Python and NumPy
	$(ENVIRONMENT) run core --timeout $(TIMEOUT) -- $(PYTEST) tests/core tests/hunt tests/golden tests/files tests/batch tests/release tests/benchmarks

.PHONY: golden
golden: ## Make the table of golden checksums again, after a change that is meant
	$(ENVIRONMENT) run core --timeout $(TIMEOUT) -- tests/golden/results.py

.PHONY: numbers
numbers: ## Compare the results of NumPy 1.26 and 2
	$(ENVIRONMENT) run numpy-1.26 --timeout $(TIMEOUT) -- tests/golden/results.py --bits build/golden/numpy-1.csv
	$(ENVIRONMENT) run core --timeout $(TIMEOUT) -- tests/golden/results.py --bits build/golden/numpy-2.csv \
	  --same-as build/golden/numpy-1.csv

.PHONY: hunt
hunt: hunt-meshes fuzz kills hunt-blender coverage mutants ## Look for what breaks it, at length and by new examples; for a night

.PHONY: hunt-meshes
hunt-meshes: ## Denoise 2,000 meshes that nobody would think of, by each property
	FRAMELET_HUNT=2000 $(ENVIRONMENT) run core --timeout $(HUNT_TIMEOUT) -- $(PYTEST) -o faulthandler_timeout=0 \
	  tests/hunt

.PHONY: coverage
coverage: ## Measure which branches of core/ and operators/ the tests take
	rm -rf build/coverage && mkdir -p build/coverage
	COVERAGE_FILE="$(CURDIR)/build/coverage/core" $(ENVIRONMENT) run hunt --timeout $(HUNT_TIMEOUT) -- \
	  $(PYTEST) --cov --cov-report= tests/core tests/hunt tests/golden
	COVERAGE_FILE="$(CURDIR)/build/coverage/files" $(ENVIRONMENT) run hunt --timeout $(HUNT_TIMEOUT) -- \
	  $(PYTEST) --cov --cov-report= tests/files tests/batch
	COVERAGE_FILE="$(CURDIR)/build/coverage/blender" $(ENVIRONMENT) run hunt-bpy --timeout $(HUNT_TIMEOUT) -- \
	  $(PYTEST) --cov --cov-report= tests/blender
	$(ENVIRONMENT) run hunt -- -m coverage combine --keep --data-file build/coverage/all build/coverage/files \
	  build/coverage/blender
	$(ENVIRONMENT) run hunt -- -m coverage report --data-file build/coverage/core --include 'core/*' --fail-under 95
	$(ENVIRONMENT) run hunt -- -m coverage report --data-file build/coverage/all --include 'operators/*' --fail-under 90
	$(ENVIRONMENT) run hunt -- -m coverage json -q --data-file build/coverage/core --include 'core/*' \
	  -o build/coverage/core.json
	$(ENVIRONMENT) run hunt -- -m coverage json -q --data-file build/coverage/all --include 'operators/*' \
	  -o build/coverage/operators.json
	$(PYTHON) .ci/branches.py build/coverage/core.json --fail-under 95
	$(PYTHON) .ci/branches.py build/coverage/operators.json --fail-under 90

.PHONY: mutants
mutants: ## Change single operators and numbers, and see whether a test tells
	$(ENVIRONMENT) run core --timeout $(HUNT_TIMEOUT) -- tests/hunt/mutants.py --count $(MUTANTS)

.PHONY: fuzz
fuzz: ## Read 5,000 damaged files, and as many manifests, reports and command lines
	FRAMELET_FUZZ=5000 $(ENVIRONMENT) run core --timeout $(HUNT_TIMEOUT) -- $(PYTEST) -o faulthandler_timeout=0 \
	  tests/files/test_fuzz.py tests/files/test_fuzz_words.py

.PHONY: hunt-blender
hunt-blender: ## Live 300 random lives in Blender, alter 1,000 stored bands, enable it 1,000 times, denoise 200 times
	FRAMELET_LIFE=300 FRAMELET_CYCLES=1000 FRAMELET_RUNS=200 FRAMELET_FUZZ=1000 $(ENVIRONMENT) run bpy-$(BLENDER) --timeout $(HUNT_TIMEOUT) -- \
	  $(PYTEST) -o faulthandler_timeout=0 tests/blender/test_life.py tests/blender/test_fuzz_bands.py \
	  tests/blender/test_registration.py tests/blender/test_long_life.py

.PHONY: kills
kills: ## Kill batches at 100 random moments
	FRAMELET_KILLS=100 $(ENVIRONMENT) run core --timeout $(HUNT_TIMEOUT) -- $(PYTEST) tests/batch/test_kills.py

.PHONY: test-training
test-training: ## Train for a minute, and test the training
	$(ENVIRONMENT) run training --timeout $(TIMEOUT) -- -m pytest tests/training

# Both at once, as each keeps one core busy. Their environments are made before that, one after the other.
.PHONY: lint-and-training
lint-and-training:
	@$(ENVIRONMENT) path core && $(ENVIRONMENT) path training
	@$(MAKE) --no-print-directory lint & lint=$$!; \
	  $(MAKE) --no-print-directory test-training; training=$$?; \
	  wait $$lint && exit $$training

.PHONY: train
train: ## Make meshes, train for hours and write the arrays of the net; goes on where it was cut off
	$(ENVIRONMENT) run training -- -m training --write $(if $(START),--start $(START))

# test-4.2, test-4.5, test-5.2
.PHONY: $(BLENDERS:%=test-%)
test-4.2: ## Test the operators on Blender 4.2
test-4.5: ## Test the operators on Blender 4.5
test-5.2: ## Test the operators on Blender 5.2
$(BLENDERS:%=test-%): test-%:
	$(ENVIRONMENT) run bpy-$* --timeout $(TIMEOUT) -- $(PYTEST) tests/blender $(LEFT_OUT)

.PHONY: $(BLENDERS:%=test-installed-%)
test-installed-4.2: ## Install the zip on Blender 4.2 and test it
test-installed-4.5: ## Install the zip on Blender 4.5 and test it
test-installed-5.2: ## Install the zip on Blender 5.2 and test it
$(BLENDERS:%=test-installed-%): test-installed-%: extension
	FRAMELET_ZIP="$(ZIP)" $(ENVIRONMENT) run bpy-$* --timeout $(TIMEOUT) -- -m pytest tests/installed

.PHONY: gui
gui: extension ## Use a real Blender window with mouse and keys, on a virtual screen (made if missing: Linux, root)
	$(PYTHON) .ci/gui.py
	FRAMELET_ZIP="$(ZIP)" $(ENVIRONMENT) run core --timeout $(GUI_TIMEOUT) -- -m pytest tests/gui

.PHONY: screenshots
screenshots: extension ## Take the screenshots of the documents in a real Blender window
	$(PYTHON) .ci/gui.py
	FRAMELET_ZIP="$(ZIP)" $(ENVIRONMENT) run core -- docs/demo/screenshots.py

.PHONY: pictures
pictures: ## Render the pictures of the documents again, half an hour
	for script in parameters presets frames_and_bands; do \
	  $(ENVIRONMENT) run bpy-5.2 -- docs/demo/$$script.py || exit 1; done

.PHONY: translations
translations: ## List texts that a translation misses, and entries that belong to no text
	$(ENVIRONMENT) run bpy-$(BLENDER) --timeout $(TIMEOUT) -- tests/list_translations.py

.PHONY: quality
quality: ## Denoise noisy models by AUTO, compare with published filters, and write the tables into docs
	$(ENVIRONMENT) run benchmarks -- tests/benchmarks/quality/run.py --rerun AUTO --update

.PHONY: benchmark-speed
benchmark-speed: ## Measure seconds and memory up to 4 million vertices, beside other programs
	$(ENVIRONMENT) run speed -- tests/benchmarks/speed/run.py

.PHONY: extension
extension: ## Validate the extension and build its zip into build/
	$(ENVIRONMENT) run bpy-$(BLENDER) --timeout $(TIMEOUT) -- .ci/extension.py

.PHONY: clean
clean: ## Remove all that was made, environments included
	rm -rf build dist .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
