# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# The whole project from one place. Each target sets up what is missing first: `make demo` what the program needs,
# `make test` what tests, benchmarks and the Python package need as well. Both build into one folder.
BUILD := build/release
OVIMAP := $(BUILD)/bin/ovimap
# As many compilers as there are processors, and memory for: one takes up to 1.8 GB.
JOBS ?= $(shell awk -v cores=$$(nproc) '/MemAvailable/ {jobs = int($$2 / 1800000)} END {print jobs < 1 ? 1 : jobs < cores ? jobs : cores}' /proc/meminfo)
SOURCE ?= demo/tiny/room

.PHONY: site reference bare-test arm64-test help setup setup-program build build-program build-all packages packages-test demo demo-lasting test test-setup asan tsan fuzz bench rivals benchmarks viewer-speed live-speed wheel clean

help:
	@echo "make demo    set up, build, show what ovimap does (ovimap demo); VIEW=1: then in a browser"
	@echo "make demo-lasting [SOURCE=..]  map half of it, kill that, resume, compare and merge with the other half, export"
	@echo "make test    set up and build the rest, run every test"
	@echo "make build   build the program and its web page: $(OVIMAP); make build-all: all there is"
	@echo "make bench   measure speed and memory on SOURCE (default: the demo room), beside their targets"
	@echo "make rivals  install Open3D and OpenCV (1.4 GB) into build/rivals, for make bench to compare with"
	@echo "make benchmarks KITCHEN=FOLDER [STUDIO=FOLDER] [ONLY='tiny rooms']   write docs/benchmarks.md, or these parts of it"
	@echo "make fuzz    feed the readers with odd bytes, FUZZ_SECONDS (60) each; installs clang"
	@echo "make live-speed SOURCE=RECORDING   what serving a map costs while it is made"
	@echo "make site    the documentation as pages, its links checked"
	@echo "make reference  the reference of the C++ library, in build/reference; needs doxygen"
	@echo "make wheel   build a Python wheel that carries its libraries, and try it in a clean environment"
	@echo "make packages  a wheel with the native program, and a Debian package, in build/packages/out"
	@echo "make packages-test  try them in bare Debian 12 and 13 (root, debootstrap)"
	@echo "make bare-test  build with every compiler of Debian 13 and run every test there (root, debootstrap)"
	@echo "make arm64-test  cross-build for 64-bit ARM, run what makes maps there, compare these (root, debootstrap)"
	@echo "make viewer-speed MAP=FILE   when the viewer shows its first picture, and how fast it answers"
	@echo "make asan    run the tests under AddressSanitizer and UBSan;  make tsan: ThreadSanitizer"

setup:
	@tools/setup.sh

setup-program:
	@tools/setup.sh --no-page

# What was once built in whole stays so: a configuration without tests would only be undone by the next `make test`.
PRESET = $(if $(wildcard $(BUILD)/tests/CTestTestfile.cmake),release,program)

build: setup
	@$(call build-preset,$(PRESET))

build-program: setup-program
	@$(call build-preset,$(PRESET))

build-all: test-setup
	@$(call build-preset,release)

define build-preset
cmake --preset $(1) > build-configure.log 2>&1 || { cat build-configure.log; exit 1; }; \
rm -f build-configure.log; \
cmake --build --preset $(1) -j $(JOBS)
endef

# The demo shows no page, unless VIEW=1: then it is built as well.
demo: $(if $(filter 1,$(VIEW)),build,build-program)
	@$(OVIMAP) demo $(if $(filter 1,$(VIEW)),--view)

demo-lasting: build
	@test -d "$(SOURCE)" || $(OVIMAP) synth demo/tiny --room tiny
	@tools/demo_lasting.sh $(OVIMAP) "$(SOURCE)" demo/lasting --masks none --encoder none

test: build-all
	@tools/run_tests.sh $(BUILD)

test-setup:
	@tools/setup.sh --tests

asan tsan: test-setup
	@cmake --preset $@ > /dev/null
	@cmake --build --preset $@ -j $(JOBS)
	@tools/run_tests.sh build/$@

FUZZ_SECONDS ?= 60
fuzz:
	@tools/setup.sh --fuzz
	@cmake --preset fuzz > /dev/null
	@cmake --build --preset fuzz -j $(JOBS)
	@tools/fuzz.sh build/fuzz $(FUZZ_SECONDS) $(JOBS)

bench: build-all
	@test -d "$(SOURCE)" || $(OVIMAP) synth demo/tiny --room tiny
	@python3 tools/speed.py $(OVIMAP) "$(SOURCE)"
	@$(BUILD)/bin/ovimap_micro_bench --benchmark_min_time=0.2

rivals:
	@tools/rivals.sh

benchmarks: build-all
	@python3 tools/benchmarks.py $(OVIMAP) $(if $(KITCHEN),--kitchen "$(KITCHEN)") $(if $(STUDIO),--studio "$(STUDIO)") $(if $(ONLY),--only $(ONLY))

wheel: test-setup
	@tools/wheel_test.sh $(if $(SOURCE),"$(SOURCE)")

packages: test-setup
	@tools/packages.sh

packages-test:
	@tools/packages_test.sh

bare-test:
	@tools/bare_test.sh

arm64-test: build test-setup
	@tools/arm64_test.sh $(OVIMAP)

viewer-speed: build test-setup
	@test -f "$(MAP)" || { echo "name a map: make viewer-speed MAP=room.ovimap"; exit 1; }
	@cd viewer && node e2e/speed.mjs "$(abspath $(OVIMAP))" "$(abspath $(MAP))"

live-speed: build test-setup
	@test -d "$(SOURCE)" || $(OVIMAP) synth demo/tiny --room tiny
	@cd viewer && node e2e/live-speed.mjs "$(abspath $(OVIMAP))" "$(abspath $(SOURCE))"

# The documentation as pages; the packages it is made with are not those of the build.
site: build/site-env/.complete
	@NO_MKDOCS_2_WARNING=1 build/site-env/bin/mkdocs build --strict -q && echo "open build/site/index.html"

reference:
	@command -v doxygen > /dev/null || { echo "doxygen is missing; run: apt-get install doxygen"; exit 1; }
	@rm -rf build/reference && mkdir -p build/reference && doxygen docs/Doxyfile && echo "open build/reference/index.html"

build/site-env/.complete: tools/requirements-site.txt
	@python3 -m venv build/site-env && build/site-env/bin/pip install -q --disable-pip-version-check -r $< && touch $@

clean:
	rm -rf build demo
