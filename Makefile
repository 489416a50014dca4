# Needs CPython 3.11 or newer and a Rust toolchain; everything else goes into .venv and the cargo target directory.
# Each step of the set-up leaves a stamp in .stamps/ and is redone only when what it reads has changed.

PYTHON ?= python3
RUN ?= runs/ski
TRAIN_ARGS ?=
PYTEST_ARGS ?=
FUZZ_SECONDS ?= 600

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
MAKEFLAGS += --no-builtin-rules
.DEFAULT_GOAL := help

VENV := $(CURDIR)/.venv
PY := $(VENV)/bin/python
UV := $(VENV)/bin/uv
UV_PIP = UV_COMPILE_BYTECODE=1 $(UV) pip

# Rust builds, tests and lints all see the interpreter of the virtual environment, or pyo3 would be built anew in turn.
export PYO3_PYTHON := $(PY)
export PATH := $(VENV)/bin:$(PATH)
unexport VIRTUAL_ENV PYTHONHOME PYTHONPATH CONDA_PREFIX

# Directories are listed beside the files, so that a deleted file counts as a change.
NATIVE_SOURCES := $(shell find core/src env/src) .cargo/config.toml Cargo.toml Cargo.lock core/Cargo.toml env/Cargo.toml pyproject.toml

# A stamp without what it stands for (the extension was deleted by hand, say) is no stamp.
ifeq ($(wildcard env/python/discjump/_native*.so),)
$(shell rm -f .stamps/env .stamps/env-fast)
endif

.PHONY: help
help: ## This list
	@grep -hE '^[a-z-]+:.*##' $(firstword $(MAKEFILE_LIST)) | sort \
	  | awk -F ':.*## ' '{ printf "  make %-17s %s\n", $$1, $$2 }'

# ---------------------------------------------------------------------------------------------- set-up

$(UV): | .stamps
	@$(PYTHON) -c 'import sys; ok = sys.version_info >= (3, 11) and sys.implementation.name == "cpython"; \
	  ok or sys.exit("discjump needs CPython 3.11 or newer, $(PYTHON) is %s %s: try make PYTHON=python3.12" \
	  % (sys.implementation.name, sys.version.split()[0]))'
	@command -v cargo > /dev/null || { echo "discjump needs a Rust toolchain, and there is no cargo on PATH" >&2; exit 1; }
	rm -rf $(VENV)
	$(PYTHON) -m venv $(VENV)
	$(PY) -m pip install --quiet --disable-pip-version-check "$$(grep '^uv==' requirements.lock)"

.stamps:
	@mkdir -p $@

# Syncing removes whatever the lock does not list, our own packages included: both are installed after it.
.stamps/sync: requirements.lock $(UV) | .stamps
	$(UV_PIP) sync --quiet --python $(PY) requirements.lock
	@touch $@

# An editable install: an edit of Python needs no rebuild, only Rust and metadata do.
.stamps/env: .stamps/sync $(NATIVE_SOURCES) | .stamps
	$(UV_PIP) install --quiet --python $(PY) --no-build-isolation --no-deps --editable .
	@rm -f .stamps/env-fast && touch $@

.stamps/training: .stamps/sync training/pyproject.toml Cargo.toml | .stamps
	$(UV_PIP) install --quiet --python $(PY) --no-build-isolation --no-deps --editable training
	@touch $@

.PHONY: setup tools dev lock
setup: .stamps/env .stamps/training ## Virtual environment, locked dependencies, release build of both packages

tools: .stamps/sync ## Virtual environment and locked dependencies only

# The extension with the profile `fast`: rebuilt in about a second, for the inner loop only.
.stamps/env-fast: .stamps/sync $(NATIVE_SOURCES) | .stamps
	$(UV_PIP) install --quiet --python $(PY) --no-build-isolation --no-deps \
	  --config-setting build-args="--profile fast" --editable .
	@rm -f .stamps/env && touch $@

dev: .stamps/env-fast .stamps/training ## Inner loop: the extension in the quick profile (bench nothing with it)

lock: $(UV) ## Resolve requirements.lock anew from both pyproject.toml
	$(UV) pip compile --quiet --upgrade --universal --python-version 3.11 --fork-strategy fewest \
	  --no-emit-index-url --no-annotate --no-header --no-emit-package discjump \
	  --extra dev --extra onnx --output-file requirements.lock pyproject.toml training/pyproject.toml

# ---------------------------------------------------------------------------------------------- the main job

.PHONY: train smoke
# Again after Ctrl-C it goes on; again after the end it only judges.
train: setup ## Set up, train a ski agent, judge it on terrain it never saw
	@if [ -e "$(RUN)/final.zip" ]; then \
	  echo "$(RUN) is trained already; another: make train RUN=runs/NAME TRAIN_ARGS='--seed 1'"; \
	elif compgen -G "$(RUN)/checkpoints/*.zip" > /dev/null; then \
	  $(VENV)/bin/discjump train ski --resume $(RUN); \
	else \
	  $(VENV)/bin/discjump train ski --out $(RUN) $(TRAIN_ARGS); \
	fi
	$(VENV)/bin/discjump evaluate $(RUN)

smoke: setup ## The main job in about 30 seconds, to see that it runs
	@run=$$(mktemp -d) && trap 'rm -rf "$$run"' EXIT && \
	  $(VENV)/bin/discjump train ski --smoke --evaluate --out "$$run/ski"

# ---------------------------------------------------------------------------------------------- tests

.PHONY: test test-rust test-python
test: test-rust test-python ## Set up, then every test: Rust, Python, doctests of both and of README

test-rust: .stamps/sync
	cargo test --quiet --workspace --locked

test-python: setup
	$(PY) -m pytest $(PYTEST_ARGS)

# ---------------------------------------------------------------------------------------------- lint

.PHONY: lint fmt fmt-rust clippy ruff mypy stubtest
lint: fmt-rust ruff clippy mypy stubtest ## Formatting, clippy, ruff, mypy, stubs against the binary

fmt: .stamps/sync ## Format Rust and Python in place
	cargo fmt --all
	$(PY) -m ruff format .
	$(PY) -m ruff check --fix .

fmt-rust:
	cargo fmt --all --check

clippy: .stamps/sync
	cargo clippy --quiet --workspace --all-targets --locked -- -D warnings

ruff: .stamps/sync
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .

mypy: setup
	$(PY) -m mypy

stubtest: setup
	$(PY) -m mypy.stubtest --mypy-config-file pyproject.toml discjump._native

# ---------------------------------------------------------------------------------------------- the rest

.PHONY: instructions instructions-anew features
instructions: setup ## Instructions of a tick and of a step, held to the committed counts
	$(PY) .ci/instructions.py

instructions-anew: setup ## The same, committed anew
	$(PY) .ci/instructions.py --write

features: setup ## That scenes pay nothing for what they leave out: against builds without it
	$(PY) .ci/features.py

.PHONY: verify verify-full
verify: setup ## That bits depend on seeds and actions alone, and are the golden ones: the quick form
	$(VENV)/bin/discjump verify --quick --against tests/golden/certificate.json

verify-full: setup ## The same with everything crossed
	nice -n 5 $(VENV)/bin/discjump verify --against tests/golden/certificate.json

# Wants `rustup target add` of both, and qemu's user mode (Debian: qemu-user-static). The linker comes with Rust.
.PHONY: other-targets
other-targets: ## The golden bits on aarch64 (emulated) and i686
	CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld \
	CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_RUNNER=qemu-aarch64-static \
	  nice -n 5 cargo test --locked -p discjump-core --test golden --profile fast --target aarch64-unknown-linux-musl
	CARGO_TARGET_I686_UNKNOWN_LINUX_MUSL_LINKER=rust-lld \
	  nice -n 5 cargo test --locked -p discjump-core --test golden --profile fast --target i686-unknown-linux-musl

.PHONY: stress stress-long fuzz
stress: setup ## Extremes in every tier, precision and surface: the full matrix, into core/docs/stress
	nice -n 5 $(VENV)/bin/discjump stress --out core/docs/stress

# Again after Ctrl-C it goes on where it was.
stress-long: setup ## Ten million ticks in every tier and a million episodes, into core/docs/stress
	nice -n 5 $(VENV)/bin/discjump stress --long --out core/docs/stress

# cargo-fuzz wants a flag of the nightly toolchain, which the stable one takes from this variable. What is new is
# kept in the corpus, which ordinary tests play.
fuzz: ## Coverage-guided search for FUZZ_SECONDS (wants `cargo install cargo-fuzz`)
	cd core && RUSTC_BOOTSTRAP=1 nice -n 5 cargo fuzz run ticks --sanitizer none -- \
	  -max_len=120 -timeout=20 -max_total_time=$(FUZZ_SECONDS)
	cd core && RUSTC_BOOTSTRAP=1 nice -n 5 cargo fuzz cmin ticks --sanitizer none

# Sanitizers and Miri want a nightly toolchain: rustup toolchain install nightly --component miri,rust-src
HOST = $(shell rustc -vV | sed -n 's/^host: //p')
.PHONY: sanitize miri
sanitize: ## Unsafe code under AddressSanitizer, the pool under ThreadSanitizer (wants nightly with rust-src)
	RUSTFLAGS=-Zsanitizer=address cargo +nightly test --quiet --locked --target $(HOST) --target-dir target/address \
	  -p discjump-core --lib --test lanes --test lanes_episodes --test snapshots --test stopped --test determinism \
	  --test worlds --test solids
	RUSTFLAGS=-Zsanitizer=thread cargo +nightly test --quiet --locked -Zbuild-std --target $(HOST) \
	  --target-dir target/thread -p discjump-core --test stopped --test determinism --test worlds

# Every operation of every lane against the scalar's takes hours there.
miri: ## Lanes of AVX2 in Miri (wants nightly with miri and rust-src)
	RUSTFLAGS=-Ctarget-feature=+avx2 MIRIFLAGS=-Zmiri-disable-isolation cargo +nightly miri test --quiet --locked \
	  --target-dir target/miri -p discjump-core --lib --no-default-features --features ski -- --skip every_operation

.PHONY: bench clean
bench: .stamps/sync ## Benches of the core, release profile
	cargo bench --locked -p discjump-core

clean: ## Remove the virtual environment, the stamps and every build product; runs/ stays
	rm -rf .venv .stamps .mypy_cache .pytest_cache .ruff_cache .hypothesis dist
	find env/python training tests -name __pycache__ -prune -exec rm -rf {} +
	rm -f env/python/discjump/_native*.so
	cargo clean --quiet
