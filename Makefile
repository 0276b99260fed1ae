# SPDX-License-Identifier: BSD-3-Clause
# `make demo` and `make test` start from nothing (Debian 12 or 13): they install, build and run.
SHELL := bash
BIN := build/release
DATA ?=
CAMERA ?=
SCENARIOS ?=
PREFIX ?= /usr/local
DIST ?= bookworm
ARCH ?= $(shell dpkg --print-architecture)
KEY ?=
FUZZ_SECONDS ?= 60
ROOMS ?=
FIGURES ?=
empty :=
space := $(empty) $(empty)
DDS_ROOMS := dds ros team cli
export CMAKE_CXX_COMPILER_LAUNCHER ?= ccache
export CCACHE_BASEDIR ?= $(CURDIR)
export CCACHE_SLOPPINESS ?= locale

.PHONY: demo console test dds python test-python python-module wheel interop browser bench accuracy figures check-figures options format check asan sanitized tsan fuzz install command tests build configure configure-tests \
  package repository package-test

demo: command  ## a simulated landing, or with DATA=<folder> [CAMERA=<file>] your own images
	scripts/demo $(BIN) "$(DATA)" "$(CAMERA)"

console: command  ## the web page over a simulated flight
	$(BIN)/src/kestrel/app/cli/kestrel console --demo

test: tests
	scripts/run-tests release

dds:  ## ROS 2 and the team's map over DDS, and their tests
	scripts/install-deps --test --dds
	cmake --preset release
	cmake --build --preset release --target kestrel $(DDS_ROOMS:%=kestrel_%_test)
	scripts/run-tests release -R '^(dds|ros|team|hosts)/|DdsCommand|TeamCommand' --no-tests=error

python: python-module  ## `import kestrel`, and what `kestrel study` needs
	@echo 'Try it: PYTHONPATH=$(BIN)/python /usr/bin/python3 -c "import kestrel; print(kestrel.simulate(\"calm\"))"'

test-python: python-module  ## the tests of `import kestrel` and of studies
	scripts/install-deps --test
	scripts/run-tests release -R ^python/ --no-tests=error

python-module:
	scripts/install-deps --python
	cmake --preset release -DKESTREL_BUILD_PYTHON=ON
	cmake --build --preset release --target kestrel _kestrel

wheel:  ## a wheel of `import kestrel` with the libraries that it needs, to out/wheel
	scripts/install-deps --python
	scripts/wheel out/wheel

interop:  ## MAVLink, MCAP, live flights, bags and ROS 2 against implementations of others, of npm and Debian
	scripts/install-deps --test --interop
	cmake --preset release
	cmake --build --preset release --target interop
	ctest --preset release -R ^interop/ --no-tests=error

browser:  ## the console's page: its unit tests, proof that web/page is made of it, and used in Chromium as a person would; pictures to out/browser
	scripts/install-deps --browser
	cmake --preset release
	cmake --build --preset release --target kestrel
	cd web && npm test && npm run check-page && npm run try -- ../$(BIN)/src/kestrel/app/cli/kestrel ../out/browser

bench: build  ## speed
	@for program in $(BIN)/bench/*_benchmark $(BIN)/bench/landing_speed; do echo "== $$program"; $$program || exit; done

accuracy: build  ## errors against truth; simulated flights (landings: SCENARIOS) to docs/accuracy.md, docs/hunt_accuracy.md
	scripts/accuracy $(BIN) $(SCENARIOS)
	scripts/hunt_accuracy $(BIN)
	@for program in $(BIN)/bench/*accuracy; do echo "== $$program"; $$program || exit; done

figures: build  ## docs/figures.md measured again, all of it or by the programs FIGURES; and README's table from it
	scripts/figures $(FIGURES)

check-figures: build  ## README's table, and what is quick to measure of docs/figures.md
	scripts/figures --check

options: command  ## docs/options.md as the command prints it
	{ sed '/^```yaml$$/q' docs/options.md && $(BIN)/src/kestrel/app/cli/kestrel config && echo '```'; } >$(BIN)/options.md
	mv $(BIN)/options.md docs/options.md

format:
	scripts/check-format --fix

check:  ## format, layers, and every source but the tests compiled by itself and by clang-tidy, of all ROOMS or of some
	scripts/install-deps --check
	scripts/check-format
	scripts/check-layers
	scripts/check-syntax $(ROOMS)
	scripts/check-tidy $(ROOMS)

asan:  ## the unit tests, of all ROOMS or of some, with the address and undefined-behaviour sanitizers
	scripts/install-deps --check
	cmake --preset asan
	cmake --build --preset asan $(if $(ROOMS),--target $(ROOMS:%=kestrel_%_test))
	ctest --preset asan -j $$(nproc) $(if $(ROOMS),-R '^($(subst $(space),|,$(strip $(ROOMS))))/')

sanitized:  ## builds what `make asan` of ROOMS and `make fuzz` run
	scripts/install-deps --check
	cmake --preset asan
	cmake --build --preset asan --target $(ROOMS:%=kestrel_%_test) fuzzers

tsan:  ## the unit tests of all ROOMS or of some, `sessions` of whole sessions, with the thread sanitizer
	scripts/install-deps --check
	cmake --preset tsan
	cmake --build --preset tsan --target $(if $(ROOMS),$(ROOMS:%=kestrel_%_test),tests)
	ctest --preset tsan $(if $(ROOMS),-R '^($(subst $(space),|,$(strip $(ROOMS))))/' --no-tests=error)

fuzz:  ## every fuzz target for FUZZ_SECONDS
	scripts/install-deps --check
	cmake --preset asan
	cmake --build --preset asan --target fuzzers
	scripts/fuzz build/asan/fuzz $(FUZZ_SECONDS)

install: configure
	cmake --build --preset release --target installed
	cmake --install $(BIN) --prefix $(PREFIX)

command: configure  ## the command alone
	cmake --build --preset release --target kestrel

tests: configure-tests
	cmake --build --preset release --target tests

build: configure-tests  ## everything: command, tests, benchmarks, tools
	cmake --build --preset release

configure:
	scripts/install-deps
	cmake --preset release

configure-tests:
	scripts/install-deps --test
	cmake --preset release

package:  ## packages for DIST (bookworm, trixie) and ARCH (amd64, arm64), in out/packages/DIST
	scripts/install-deps --package
	packaging/build $(DIST) $(ARCH)

repository:  ## a signed repository for apt of all packages, in out/repository; KEY=<key of gpg>
	packaging/repository $(KEY)

package-test: repository  ## packages of DIST and ARCH installed, used, upgraded and removed on a fresh machine
	scripts/install-deps --package $(if $(filter $(ARCH),$(shell dpkg --print-architecture)),,--emulator)
	packaging/test $(DIST) $(ARCH)
