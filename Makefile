# asttrack: build, check, install. `make help` lists the targets and the variables.

# ---- Variables: set them on the command line or in the environment ----

# where everything that is built goes
BUILDDIR ?= build
# C compiler
CC ?= cc
# optimisation and debugging flags; what the sources need is added to them
CFLAGS ?= -O3
# linear algebra: lapacke or builtin (default: lapacke where it links)
BACKEND ?= $(if $(filter yes,$(LAPACKE)),lapacke,builtin)
# yes or no: is OpenBLAS with LAPACKE there (default: tried)
LAPACKE ?= $(eval LAPACKE := $(call links,$(lapacke_trial),$(lapacke_libs)))$(LAPACKE)
# yes or no: is libjpeg there, for the command only (default: tried)
JPEG ?= $(eval JPEG := $(call links,$(jpeg_trial),-ljpeg))$(JPEG)
# yes or no: can the compiler aim at this very processor, for the peaks of `make bench` only (default: tried)
NATIVE ?= $(eval NATIVE := $(call links,int main(void) { return 0; }\n,-march=native -mno-avx512f))$(NATIVE)
# 1: a warning is an error
WERROR ?= 0
# 1: show every command
V ?= 0
# sanitizers for the build, as in -fsanitize=
SANITIZE ?=
# minutes that `make fuzz` takes for all harnesses together
MINUTES ?= 1
# directory of frames that `make demo` tracks (default: a rendered scene); how many frames `make soak` runs (default: 100000)
FRAMES ?=
# a checkout of Unity, the C test framework (default: fetched)
UNITY_DIR ?= .unity
# real sequences for `make accuracy` and `make accuracy-tables`
SEQUENCES ?= ../shared/sequences
# seeds of each tracker for `make accuracy-tables`
SEEDS ?= 5
# processes at a time for the same
JOBS ?= 2
# Python that makes the virtual environment of the Python tests
PYTHON ?= python3
# test programs that run, as in "test_state fuzz_api" (default: all)
TESTS ?=
# arguments of `make bench`, such as --quick (make bench BENCH_ARGS=--help lists them)
BENCH_ARGS ?=
# arguments of the Python part of `make performance`, such as --frames 200 (.venv/bin/python -m asttrack bench --help lists them)
PERFORMANCE_ARGS ?=
# most stack that a call into the library may take, bytes
STACK_CEILING ?= 8192
# where `make install` puts things
PREFIX ?= /usr/local
# the same for the libraries
LIBDIR ?= $(PREFIX)/lib
# prepended to every installed path, for packagers
DESTDIR ?=

NM ?= nm
OBJDUMP ?= objdump
SIZE ?= size
CLANG_FORMAT ?= clang-format
CLANG_TIDY ?= clang-tidy
CPPCHECK ?= cppcheck
INSTALL ?= install

MAKEFLAGS += --no-builtin-rules
.DELETE_ON_ERROR:
.SUFFIXES:
.DEFAULT_GOAL := all

# ---- What the machine has ----

# $(call links,program,libraries): yes when the program compiles and links
links = $(shell t=$$(mktemp) && printf '%b' '$(1)' | $(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) -x c - -o $$t $(2) >/dev/null 2>&1 \
	&& echo yes || echo no; rm -f $$t)
hash := \#
lapacke_trial = $(hash)include <cblas.h>\n$(hash)include <lapacke.h>\nint main(void) { float a = 1, w = 0; return \
	(int)cblas_snrm2(1, &a, 1) + (int)LAPACKE_ssyev_work(LAPACK_COL_MAJOR, 78, 85, 1, &a, 1, &w, &a, 1); }\n
lapacke_libs := -llapacke -lopenblas
jpeg_trial = $(hash)include <stdio.h>\n$(hash)include <jpeglib.h>\nint main(void) { struct jpeg_error_mgr e; return \
	jpeg_std_error(&e) == 0; }\n

ifeq ($(filter $(BACKEND),builtin lapacke),)
$(error BACKEND=$(BACKEND): say builtin or lapacke)
endif
ifeq ($(BACKEND) $(LAPACKE),lapacke no)
$(error BACKEND=lapacke needs cblas.h, lapacke.h and $(lapacke_libs): on Debian, apt-get install libopenblas-dev liblapacke-dev)
endif

# ---- Sources and flags ----

# The version is written in the public header only.
version_numbers := $(shell sed -n 's/^.define AST_VERSION_[A-Z]* \([0-9][0-9]*\)$$/\1/p' include/asttrack.h)
major := $(word 1,$(version_numbers))
version := $(subst $() $(),.,$(version_numbers))

backend_sources := $(wildcard src/linalg_builtin.c src/linalg_lapacke.c)
core_sources := $(filter-out $(backend_sources),$(wildcard src/*.c))
lib_sources := $(core_sources) src/linalg_$(BACKEND).c
# The other backend, linked into the test programs only, so that both can be compared in one process.
other_backends := $(filter-out src/linalg_$(BACKEND).c $(if $(filter no,$(LAPACKE)),src/linalg_lapacke.c),$(backend_sources))
command_sources := $(filter-out examples/minimal.c,$(wildcard examples/*.c))
test_sources := $(wildcard tests/test_*.c)
test_support_sources := $(filter-out $(test_sources),$(wildcard tests/*.c))
bench_sources := $(wildcard bench/*.c)
fuzz_sources := $(wildcard tests/fuzz/fuzz_*.c)
c_files := $(wildcard include/*.h src/*.[ch] examples/*.[ch] examples/*/*.[ch] tests/*.[ch] tests/cross/*.c bench/*.[ch] tests/fuzz/*.[ch] tests/fault/*.c tests/soak/*.c calibration/*.c)

warnings := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wvla $(if $(filter 1,$(WERROR)),-Werror)
sanitizers := $(if $(SANITIZE),-g -fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer)
# No contraction: a fused multiply-add would make two builds of one source differ in their last bits.
# No errno: square roots are then the processor's instruction, without a call. No traps: comparisons become vector instructions too.
common_flags = $(CFLAGS) -std=c99 -ffp-contract=off -fno-math-errno -fno-trapping-math $(warnings) $(sanitizers) -Iinclude -MMD -MP $(CPPFLAGS)
lib_flags = $(common_flags) -Wdouble-promotion -DAST_LINALG=ast_linalg_$(BACKEND)
command_flags = $(common_flags) -D_POSIX_C_SOURCE=200809L $(if $(filter yes,$(JPEG)),-DAST_WITH_JPEG)
test_flags = $(command_flags) -iquote src -iquote examples -iquote bench -isystem $(UNITY_DIR)/src -DUNITY_INCLUDE_DOUBLE= \
	-DUNITY_SUPPORT_64 -pthread \
	$(if $(filter yes,$(LAPACKE)),-DAST_TEST_LAPACKE) $(if $(filter yes,$(NATIVE)),-DAST_BENCH_NATIVE)
bench_flags = $(command_flags) -iquote src -iquote examples $(if $(filter yes,$(LAPACKE)),-DAST_BENCH_LAPACKE) \
	$(if $(filter yes,$(NATIVE)),-DAST_BENCH_NATIVE)

link = $(CC) $(CFLAGS) $(sanitizers) $(LDFLAGS)
lib_libs := $(if $(filter lapacke,$(BACKEND)),$(lapacke_libs)) -lm -pthread
jpeg_libs := $(if $(filter yes,$(JPEG)),-ljpeg)
test_libs := $(if $(filter yes,$(LAPACKE)),$(lapacke_libs)) $(jpeg_libs) -lm -pthread

static_objects := $(lib_sources:src/%.c=$(BUILDDIR)/obj/static/%.o)
shared_objects := $(lib_sources:src/%.c=$(BUILDDIR)/obj/shared/%.o)
other_objects := $(other_backends:src/%.c=$(BUILDDIR)/obj/static/%.o)
command_objects := $(command_sources:examples/%.c=$(BUILDDIR)/obj/examples/%.o)
test_support_objects := $(test_support_sources:tests/%.c=$(BUILDDIR)/obj/tests/%.o) $(BUILDDIR)/obj/unity.o
# The fuzzing harnesses over their corpus, without a fuzzer: tests like the others.
replay_programs := $(fuzz_sources:tests/fuzz/%.c=$(BUILDDIR)/tests/%)
test_programs := $(test_sources:tests/%.c=$(BUILDDIR)/tests/%) $(replay_programs)
chosen_programs := $(if $(TESTS),$(TESTS:%=$(BUILDDIR)/tests/%),$(test_programs))
bench_objects = $(bench_sources:bench/%.c=$(BUILDDIR)/obj/bench/%.o) \
	$(if $(filter yes,$(NATIVE)),$(BUILDDIR)/obj/bench/peak_patch_native.o $(BUILDDIR)/obj/bench/peak_patch_narrow.o)

static_lib := $(BUILDDIR)/libasttrack.a
shared_lib := $(BUILDDIR)/libasttrack.so.$(version)
# What a recipe says instead of its command, unless V=1.
quiet := $(if $(filter 1,$(V)),,@)
say = $(if $(quiet),@printf '  %-4s %s\n' $(1) $@)
# Calls this Makefile again with what is already known about the machine.
again = $(MAKE) --no-print-directory LAPACKE=$(LAPACKE) JPEG=$(JPEG) NATIVE=$(NATIVE)

# ---- Building ----

.PHONY: all lib lib-static lib-shared examples
all: lib examples ## the library, the command and the examples (default)
	@echo "built in $(BUILDDIR): asttrack $(version), backend $(BACKEND)$(if $(filter no,$(LAPACKE)), (no OpenBLAS with LAPACKE \
	found)), JPEG $(JPEG)"
lib: lib-static lib-shared ## libasttrack.a and libasttrack.so
lib-static: $(static_lib) ## libasttrack.a alone, for cross-compiling
lib-shared: $(shared_lib) ## libasttrack.so alone
examples: $(BUILDDIR)/asttrack $(BUILDDIR)/minimal ## the command `asttrack` and the program to copy, `minimal`

# Text files that change when, and only when, what they record changes: objects depend on the flags, links on what is linked.
$(BUILDDIR)/lib-flags: export recorded = $(CC) $(lib_flags)
$(BUILDDIR)/flags: export recorded = $(CC) $(test_flags)
$(BUILDDIR)/bench-flags: export recorded = $(CC) $(bench_flags) $(lib_flags)
$(BUILDDIR)/sources: export recorded = $(link) $(lib_sources) $(other_backends) $(command_sources) \
	$(test_support_sources) $(test_libs)
$(BUILDDIR)/lib-flags $(BUILDDIR)/flags $(BUILDDIR)/bench-flags $(BUILDDIR)/sources: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' "$$recorded" | cmp -s - $@ || printf '%s\n' "$$recorded" > $@
.PHONY: FORCE
FORCE:

$(BUILDDIR)/obj/static/%.o: src/%.c $(BUILDDIR)/lib-flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(lib_flags) -c -o $@ $<
$(BUILDDIR)/obj/shared/%.o: src/%.c $(BUILDDIR)/lib-flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(lib_flags) -fPIC -fvisibility=hidden -DAST_BUILD_SHARED -c -o $@ $<
$(BUILDDIR)/obj/examples/%.o: examples/%.c $(BUILDDIR)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(command_flags) -c -o $@ $<
$(BUILDDIR)/obj/tests/%.o: tests/%.c $(BUILDDIR)/flags | $(UNITY_DIR)/src/unity.c
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(test_flags) -c -o $@ $<
$(BUILDDIR)/obj/bench/%.o: bench/%.c $(BUILDDIR)/bench-flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(bench_flags) $(own_flags) -c -o $@ $<
$(BUILDDIR)/obj/bench/peak_patch_%.o: bench/peak_patch.c $(BUILDDIR)/bench-flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(bench_flags) $(own_flags) -DPEAK_NAME=peak_$* -c -o $@ $<
$(BUILDDIR)/obj/bench/machine.o: own_flags = -DBENCH_FLAGS='"$(strip $(filter-out -MMD -MP -Iinclude,$(lib_flags)))"'
$(BUILDDIR)/obj/bench/peak_patch.o: own_flags = -ffp-contract=fast
$(BUILDDIR)/obj/bench/peak_patch_native.o: own_flags = -ffp-contract=fast -march=native
$(BUILDDIR)/obj/bench/peak_patch_narrow.o: own_flags = -ffp-contract=fast -march=native -mno-avx512f
$(BUILDDIR)/obj/unity.o: $(UNITY_DIR)/src/unity.c $(BUILDDIR)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(CFLAGS) $(sanitizers) -DUNITY_INCLUDE_DOUBLE= -DUNITY_SUPPORT_64 -c -o $@ $<

$(static_lib): $(static_objects) $(BUILDDIR)/sources
	@rm -f $@
	$(call say,LIB)
	$(quiet)$(AR) rcs $@ $(static_objects)
# The link fails when a name leaves the library that is not ours.
$(shared_lib): $(shared_objects) $(BUILDDIR)/sources
	$(call say,LINK)
	$(quiet)$(link) -shared -Wl,-soname,libasttrack.so.$(major) -Wl,-z,defs -o $@ $(shared_objects) $(lib_libs)
	@strangers=$$($(NM) -D --defined-only $@ | awk '$$NF !~ /^ast_/ { print $$NF }'); \
	if [ -n "$$strangers" ]; then echo "$@ exports names that are not ast_*:" $$strangers >&2; exit 1; fi
	@ln -sf $(@F) $(BUILDDIR)/libasttrack.so.$(major) && ln -sf libasttrack.so.$(major) $(BUILDDIR)/libasttrack.so

$(BUILDDIR)/asttrack: $(command_objects) $(static_lib) $(BUILDDIR)/sources
	$(call say,LINK)
	$(quiet)$(link) -o $@ $(command_objects) $(static_lib) $(jpeg_libs) $(lib_libs)
$(BUILDDIR)/minimal: $(BUILDDIR)/obj/examples/minimal.o $(static_lib)
	$(call say,LINK)
	$(quiet)$(link) -o $@ $^ $(lib_libs)

# ---- The demonstration ----

demo_frames = $(or $(FRAMES),$(BUILDDIR)/demo/scene)
demo_sheet = $(BUILDDIR)/demo/sheet.$(if $(filter yes,$(JPEG)),jpg,ppm)
.PHONY: demo
demo: $(BUILDDIR)/asttrack ## render a scene (or take FRAMES=directory), track it, draw a picture of it
	@mkdir -p $(BUILDDIR)/demo
	$(if $(FRAMES),,$(BUILDDIR)/asttrack synth $(demo_frames))
	$(BUILDDIR)/asttrack track $(demo_frames) --csv $(BUILDDIR)/demo/track.csv --sheet $(demo_sheet)
	@echo "boxes:   $(BUILDDIR)/demo/track.csv"
	@echo "picture: $(demo_sheet)"

# ---- Speed ----

.PHONY: bench performance
bench_program := $(BUILDDIR)/asttrack-bench
# Which sources these are, where git knows.
commit = $(shell git describe --always --dirty --abbrev=12 --exclude '*' 2>/dev/null)
bench: $(bench_program) ## measure speed: ratios, growth, roofline, instructions; BENCH_ARGS=--quick for a rough run
	@$(bench_program) --out $(BUILDDIR)/bench.json $(if $(commit),--commit $(commit)) $(BENCH_ARGS)
# The scene of the bench on disk, so that Python's trackers see the same frames.
performance_scene := $(BUILDDIR)/performance/synth
performance_sequences = $(performance_scene) $(wildcard ../shared/sequences/girl)
performance: bench $(BUILDDIR)/asttrack .venv/installed ## measure speed beside OpenCV's trackers; replaces the tables of docs/performance.md
	@mkdir -p $(dir $(performance_scene))
	@$(BUILDDIR)/asttrack synth $(performance_scene)
	+@$(again) BUILDDIR=$(BUILDDIR)/builtin BACKEND=builtin lib-shared
	+@$(if $(filter yes,$(LAPACKE)),$(again) BUILDDIR=$(BUILDDIR)/lapacke BACKEND=lapacke lib-shared)
	.venv/bin/python -m asttrack bench --only-trackers --library $(BUILDDIR)/builtin/libasttrack.so \
	    $(if $(filter yes,$(LAPACKE)),--library $(BUILDDIR)/lapacke/libasttrack.so) $(performance_sequences:%=--sequence %) \
	    --core $(BUILDDIR)/bench.json --out $(BUILDDIR)/performance.json --markdown docs/performance.md $(PERFORMANCE_ARGS)
$(bench_program): $(bench_objects) $(other_objects) $(BUILDDIR)/libexamples.a $(static_lib) $(BUILDDIR)/sources
	$(call say,LINK)
	$(quiet)$(link) -o $@ $(bench_objects) $(other_objects) $(BUILDDIR)/libexamples.a $(static_lib) $(test_libs)

# ---- Tests ----

.PHONY: test test-c test-programs test-python lint-python unity sanitize asan ubsan tsan test-32
test_backends := builtin $(if $(filter yes,$(LAPACKE)),lapacke)
python_package := $(wildcard bindings/python/pyproject.toml)
test_runs := $(test_backends:%=test-run-%) $(if $(python_package),test-run-python)
test_summaries := $(BUILDDIR)/builtin/tests/summary $(BUILDDIR)/lapacke/tests/summary $(if $(python_package),$(BUILDDIR)/$(BACKEND)/python/summary)
test_failed := $(BUILDDIR)/tests/failed
comma := ,
lapacke_skipped := C tests with lapacke: 0 passed, 0 failed, 1 skipped (no libopenblas-dev and liblapacke-dev)

# One C run for each backend that the machine can build, each in a build directory of its own, and the Python tests with one of
# them; a failing run does not stop the others, which -j runs at the same time.
.PHONY: test-start test-ready $(test_runs) $(test_backends:%=test-build-%)
test: $(test_runs) ## all tests: C with each backend, then Python
	@scripts/total_tests.sh $(BUILDDIR)/test-summary $(test_summaries); [ ! -e $(test_failed) ]
test-start: unity
	@rm -f $(test_summaries) $(test_failed) && mkdir -p $(dir $(test_summaries) $(test_failed))
	@$(if $(filter no,$(LAPACKE)),echo "$(lapacke_skipped)" > $(BUILDDIR)/lapacke/tests/summary)
$(test_backends:%=test-build-%): test-build-%: test-start
	+@$(again) BUILDDIR=$(BUILDDIR)/$* BACKEND=$* test-ready || touch $(test_failed)
test-ready: $(chosen_programs) $(BUILDDIR)/asttrack lib-shared
$(test_backends:%=test-run-%): test-run-%: test-build-%
	+@$(again) BUILDDIR=$(BUILDDIR)/$* BACKEND=$* test-c || touch $(test_failed)
test-run-python: test-build-$(BACKEND)
	+@$(again) BUILDDIR=$(BUILDDIR)/$(BACKEND) BACKEND=$(BACKEND) test-python || touch $(test_failed)

test-c: $(chosen_programs) $(BUILDDIR)/asttrack ## the C tests, with the library as it is configured
	@scripts/run_tests.sh $(BUILDDIR)/tests/summary "C tests with $(BACKEND)$(if $(SANITIZE), under $(SANITIZE))" $(chosen_programs)
test-programs: $(test_programs)

# A test links the objects of the examples that it calls, the program's own main() never: an archive gives only what is asked for.
$(BUILDDIR)/libexamples.a: $(command_objects) $(BUILDDIR)/sources
	@rm -f $@
	$(call say,LIB)
	$(quiet)$(AR) rcs $@ $(command_objects)
$(BUILDDIR)/libbench.a: $(bench_objects) $(BUILDDIR)/sources
	@rm -f $@
	$(call say,LIB)
	$(quiet)$(AR) rcs $@ $(bench_objects)
$(filter-out $(replay_programs),$(test_programs)): $(BUILDDIR)/tests/%: $(BUILDDIR)/obj/tests/%.o $(test_support_objects) $(other_objects) \
		$(BUILDDIR)/libbench.a $(BUILDDIR)/libexamples.a $(static_lib) $(BUILDDIR)/sources
	@mkdir -p $(@D)
	$(call say,LINK)
	$(quiet)$(link) -o $@ $(filter %.o,$^) $(BUILDDIR)/libbench.a $(BUILDDIR)/libexamples.a $(static_lib) $(test_libs)

# The command with faults on demand, for the tests of what it does then.
faulty_command := $(BUILDDIR)/tests/asttrack-faulty
faulty_calls := open fopen write close rename fread ferror $(if $(SANITIZE),malloc calloc realloc)
$(BUILDDIR)/obj/fault/%.o: tests/fault/%.c $(BUILDDIR)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(test_flags) $(if $(SANITIZE),-DFAULT_WRAPS_ALLOCATION) -c -o $@ $<
$(faulty_command): $(BUILDDIR)/obj/fault/faults.o $(command_objects) $(static_lib) $(BUILDDIR)/sources
	@mkdir -p $(@D)
	$(call say,LINK)
	$(quiet)$(link) $(faulty_calls:%=-Wl$(comma)--wrap=%) -o $@ $< $(command_objects) $(static_lib) $(jpeg_libs) $(lib_libs)
$(BUILDDIR)/tests/test_command_faults: | $(faulty_command)
$(BUILDDIR)/tests/test_command: | $(BUILDDIR)/minimal

$(BUILDDIR)/obj/fuzz/%.o: tests/fuzz/%.c $(BUILDDIR)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(test_flags) -c -o $@ $<
$(replay_programs): $(BUILDDIR)/tests/%: $(BUILDDIR)/obj/fuzz/%.o $(BUILDDIR)/obj/fuzz/replay.o $(BUILDDIR)/libexamples.a \
		$(static_lib) $(BUILDDIR)/sources
	@mkdir -p $(@D)
	$(call say,LINK)
	$(quiet)$(link) -o $@ $(filter %.o,$^) $(BUILDDIR)/libexamples.a $(static_lib) $(test_libs)

unity: $(UNITY_DIR)/src/unity.c ## fetch the C test framework
$(UNITY_DIR)/src/unity.c:
	$(if $(filter .unity,$(UNITY_DIR)),scripts/fetch_unity.sh $(UNITY_DIR),@echo "$@ is missing: UNITY_DIR is not a checkout of \
	Unity" >&2; exit 1)

test-python: .venv/installed $(BUILDDIR)/asttrack lib-shared ## the Python tests, in a virtual environment of their own
	@mkdir -p $(BUILDDIR)/python
	@AST_COMMAND=$(abspath $(BUILDDIR)/asttrack) .venv/bin/python -m pytest -q -rs -p no:cacheprovider --junitxml=$(BUILDDIR)/python/junit.xml bindings/python/tests; status=$$?; \
	sed -n 's/.*<testsuite [^>]*errors="\([0-9]*\)" failures="\([0-9]*\)" skipped="\([0-9]*\)" tests="\([0-9]*\)".*/\1 \2 \3 \4/p' \
	    $(BUILDDIR)/python/junit.xml | awk '{ printf "Python tests: %d passed, %d failed, %d skipped\n", \
	    $$4 - $$1 - $$2 - $$3, $$1 + $$2, $$3 }' > $(BUILDDIR)/python/summary; exit $$status
# The package is built and installed anew when it or the library changes: the library is inside it.
.venv/installed: $(wildcard include/*.h src/*.[ch]) $(shell find bindings/python/pyproject.toml bindings/python/CMakeLists.txt bindings/python/header_version.py \
		bindings/python/src -type f -not -name '*.pyc' 2>/dev/null)
	@$(PYTHON) -c 'import venv, ensurepip' || { echo "$(PYTHON) cannot make virtual environments: on Debian, apt-get install \
	python3-venv; or name another with PYTHON=" >&2; exit 1; }
	[ -x .venv/bin/pip ] || $(PYTHON) -m venv .venv
	.venv/bin/pip install --quiet --disable-pip-version-check './bindings/python[eval,peers,fleet,test]'
	@touch $@

lint-python: .venv/installed ## static analysis and layout of the Python sources
	cd bindings/python && $(CURDIR)/.venv/bin/ruff check . ../../examples/python ../../tests/golden ../../tests/soak ../../calibration && \
	    $(CURDIR)/.venv/bin/ruff format --check . ../../examples/python ../../tests/golden ../../tests/soak ../../calibration && $(CURDIR)/.venv/bin/mypy

# What finds the inputs: libFuzzer, which comes with clang. Findings lie in $(BUILDDIR)/found; a crash becomes a file of
# tests/fuzz/corpus, which every run of the tests replays.
.PHONY: fuzz fuzz-programs
fuzz_programs := $(fuzz_sources:tests/fuzz/%.c=$(BUILDDIR)/fuzz/%)
$(fuzz_programs): $(BUILDDIR)/fuzz/%: $(BUILDDIR)/obj/fuzz/%.o $(BUILDDIR)/libexamples.a $(static_lib) $(BUILDDIR)/sources
	@mkdir -p $(@D)
	$(call say,LINK)
	$(quiet)$(link) -fsanitize=fuzzer -o $@ $< $(BUILDDIR)/libexamples.a $(static_lib) $(test_libs)
fuzz-programs: $(fuzz_programs)
# Comparisons are not traced: that takes nine tenths of the time, and the corpus holds the words that it would find.
fuzz: ## fuzz every harness for its share of MINUTES, with clang under the address and undefined-behaviour sanitizers
	+@$(MAKE) --no-print-directory LAPACKE=no JPEG=$(JPEG) BACKEND=builtin CC=clang BUILDDIR=$(BUILDDIR)/clang-fuzz \
	    CFLAGS='-O2 -g -fno-sanitize-coverage=trace-cmp' \
	    SANITIZE=fuzzer-no-link$(comma)address$(comma)undefined$(comma)float-cast-overflow fuzz-programs
	@scripts/fuzz.sh $(MINUTES) $(BUILDDIR)/found $(fuzz_sources:tests/fuzz/%.c=$(BUILDDIR)/clang-fuzz/fuzz/%)

# One tracker for FRAMES frames, and two hundred that come and go; in C, then through Python. OpenBLAS's own threads, which it never
# uses here, would take memory in their own time.
.PHONY: soak
$(BUILDDIR)/soak: $(BUILDDIR)/obj/soak/soak.o $(BUILDDIR)/obj/tests/support_render.o $(BUILDDIR)/obj/tests/support_noise.o \
		$(static_lib) $(BUILDDIR)/sources
	$(call say,LINK)
	$(quiet)$(link) -o $@ $(filter %.o,$^) $(static_lib) $(lib_libs)
$(BUILDDIR)/obj/soak/%.o: tests/soak/%.c $(BUILDDIR)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(test_flags) -iquote tests -c -o $@ $<
soak: $(BUILDDIR)/soak .venv/installed ## run trackers for FRAMES=1000000 frames and more, and look at their memory, numbers and time
	OPENBLAS_NUM_THREADS=1 $(BUILDDIR)/soak $(or $(FRAMES),100000)
	.venv/bin/python tests/soak/soak.py $(or $(FRAMES),100000)

sanitize: unity ## the C tests under SANITIZE=address, undefined, thread or a list of them
	$(if $(SANITIZE),,$(error say SANITIZE=address$(comma)undefined or another list))
	+@$(again) BUILDDIR=$(BUILDDIR)/$(subst $(comma),-,$(SANITIZE)) CFLAGS=-O1 test-c
asan: ## the C tests under the address sanitizer
	+@$(again) SANITIZE=address sanitize
ubsan: ## the C tests under the undefined-behaviour sanitizer
	+@$(again) SANITIZE=undefined sanitize
# OpenBLAS is not compiled for it and would be reported.
tsan: ## the C tests under the thread sanitizer, with the builtin backend
	+@$(MAKE) --no-print-directory LAPACKE=no JPEG=$(JPEG) BACKEND=builtin SANITIZE=thread sanitize
# Where size_t has 32 bits, as on most targets: the 32-bit x86 of the same machine, whose programs it runs. The arithmetic is that
# of other targets, not the old one of x86 that rounds as registers spill.
X86_32 ?= i686-linux-gnu
test-32: unity ## the C tests with 32-bit addresses, by a cross-compiler of X86_32
	+@$(MAKE) --no-print-directory CC=$(X86_32)-gcc LAPACKE=no JPEG=no BACKEND=builtin BUILDDIR=$(BUILDDIR)/32-bit \
	    CFLAGS='-O2 -msse2 -mfpmath=sse' \
	    LDFLAGS='-Wl,--dynamic-linker=/usr/$(X86_32)/lib/ld-linux.so.2 -Wl,-rpath,/usr/$(X86_32)/lib' test-c

# Single precision throughout, as in firmware: what tests allow then is in tests/support_precision.h. Those of the command and of
# the bench compute nothing of their own.
.PHONY: test-single
single_tests := $(filter-out test_command% test_bench%,$(test_sources:tests/%.c=%))
test-single: unity ## the C tests with ast_real float, as in firmware
	+@$(MAKE) --no-print-directory LAPACKE=no JPEG=no NATIVE=no BACKEND=builtin BUILDDIR=$(BUILDDIR)/single CFLAGS=-O1 \
	    CPPFLAGS=-DAST_REAL=float TESTS='$(or $(TESTS),$(single_tests))' test-c

# ---- Checks ----

.PHONY: size symbols stack stack-objects accuracy accuracy-tables lint analyse memcheck format format-check
size: $(static_lib) ## bytes of code and data; fails when the library has writable data
	@$(SIZE) -t $(static_lib)
	@$(OBJDUMP) -t $(static_lib) | awk -F '\t' '/file format/ { sub(/:.*/, ""); object = $$0 } \
	    NF == 2 { n = split($$1, left, " "); split($$2, right, " "); section = left[n]; name = right[2]; \
	    if (section ~ /^([.](data|bss|tdata|tbss)([.]|$$)|[*]COM[*])/ && section !~ /^[.]data[.]rel[.]ro/ && name != section) \
	        { print object ": " name " is writable data (" section ")"; found = 1 } } \
	    END { if (found) exit 1; print "no writable data in the library" }'

symbols: $(shared_lib) ## fails unless the shared library exports the functions of the header and nothing else
	@sed -n 's/^AST_API .*[ *]\(ast_[a-z0-9_]*\)(.*/\1/p' include/asttrack.h | LC_ALL=C sort > $(BUILDDIR)/declared
	@$(NM) -D --defined-only $(shared_lib) | awk '{ print $$NF }' | LC_ALL=C sort > $(BUILDDIR)/exported
	@diff $(BUILDDIR)/declared $(BUILDDIR)/exported && echo "$$(wc -l < $(BUILDDIR)/exported) functions, as in the header"

# gcc, because it alone writes call graphs; no jump tables, because in them a branch looks like a function's address.
stack: ## stack of the deepest chain of calls below each function of the API; fails above STACK_CEILING
	+@$(MAKE) --no-print-directory BUILDDIR=$(BUILDDIR)/stack CC=gcc LAPACKE=$(LAPACKE) JPEG=no \
	    CFLAGS='-O3 -ffunction-sections -fno-jump-tables -fcallgraph-info=su' stack-objects
stack-objects: $(static_objects) $(other_objects)
	@$(PYTHON) scripts/check_stack.py --ceiling $(STACK_CEILING) --objdump $(OBJDUMP) $^

accuracy: $(BUILDDIR)/asttrack ## hold the default preset to tests/accuracy_bounds.txt; UPDATE=1 measures and writes it anew
	@$(PYTHON) scripts/check_accuracy.py --command $< --bounds tests/accuracy_bounds.txt --sequences $(SEQUENCES) \
	    $(if $(filter 1,$(UPDATE)),--update)

eight := surfer coke_can girl tiger1 tiger2 coupon_book occluded_face occluded_face2
validation := david bolt bag pedestrian1
knowing := $(eight) car panda pedestrian1
peers := csrt,kcf,mil,tld,boosting,medianflow
measured = .venv/bin/python -m asttrack eval $(addprefix $(SEQUENCES)/,$($1)) --seeds $(SEEDS) --jobs $(JOBS) \
	--runs $(BUILDDIR)/accuracy/runs --out $(BUILDDIR)/accuracy/$2
accuracy-tables: .venv/installed $(BUILDDIR)/asttrack ## measure what docs/accuracy.md shows, and write it; hours
	$(call measured,eight,eight) --trackers asttrack,asttrack:paper,asttrack:paper:model=linear$(comma)basis=raw,$(peers)
	$(call measured,validation,validation) --trackers asttrack,asttrack:paper,$(peers)
	$(call measured,eight,ablation) --ablation docs/ablation.toml
	$(call measured,knowing,confidence) --trackers asttrack,$(peers)
	.venv/bin/python -m asttrack recovery --trackers asttrack,$(peers) --jobs $(JOBS) --synth $(BUILDDIR)/asttrack \
	    --out $(BUILDDIR)/accuracy/recovery
	$(PYTHON) scripts/insert_tables.py docs/accuracy.md $(BUILDDIR)/accuracy

# Linked with a step's predictors watched; the constants themselves stay in src/confidence.c.
observed_command := $(BUILDDIR)/asttrack-observed
tunable := $(eight) car panda motor_rolling
$(BUILDDIR)/obj/calibration/%.o: calibration/%.c $(BUILDDIR)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(quiet)$(CC) $(command_flags) -iquote src -c -o $@ $<
$(observed_command): $(BUILDDIR)/obj/calibration/observe.o $(command_objects) $(static_lib) $(BUILDDIR)/sources
	$(call say,LINK)
	$(quiet)$(link) -Wl,--wrap=ast_confidence_probability -o $@ $< $(command_objects) $(static_lib) $(jpeg_libs) $(lib_libs)
.PHONY: calibrate
calibrate: $(observed_command) .venv/installed ## fit the score of the robust preset to ground truth, beside the constants of src/confidence.c
	.venv/bin/python calibration/fit.py --command $< --seeds $(SEEDS) --jobs $(JOBS) $(addprefix $(SEQUENCES)/,$(tunable))

lint: ## static analysis of the C sources
	@$(CLANG_TIDY) --version >/dev/null || { echo "no $(CLANG_TIDY): on Debian, apt-get install clang-tidy" >&2; exit 1; }
	@printf '%s\n' $(filter-out $(if $(filter no,$(LAPACKE)),src/linalg_lapacke.c),$(wildcard src/*.c examples/*.c bench/*.c)) | \
	    xargs -P $$(nproc) -n 1 sh -c '$(CLANG_TIDY) --quiet "$$0" -- -std=c99 -Iinclude -iquote src -iquote examples \
	    -DAST_LINALG=ast_linalg_$(BACKEND) \
	    -D_POSIX_C_SOURCE=200809L $(if $(filter yes,$(JPEG)),-DAST_WITH_JPEG) 2>/dev/null' && echo "lint: nothing found"

# What reads the code rather than runs it, beside lint. gcc's analyser takes a vector's elements for bits where it is shifted: that
# warning is left to cppcheck and to gcc's own -Wshift-count-overflow. cppcheck: each finding is an error; the functions of the API
# have no caller here.
analyse: ## static analysis by gcc -fanalyzer and cppcheck
	@$(CPPCHECK) --version >/dev/null || { echo "no $(CPPCHECK): on Debian, apt-get install cppcheck" >&2; exit 1; }
	$(CPPCHECK) --quiet --std=c99 --error-exitcode=1 --inline-suppr --enable=warning,performance,portability -Iinclude -Isrc \
	    -DAST_LINALG=ast_linalg_$(BACKEND) $(if $(filter yes,$(JPEG)),-DAST_WITH_JPEG) -D_POSIX_C_SOURCE=200809L \
	    --suppress=missingIncludeSystem $(lib_sources) examples/*.c
	+@$(MAKE) --no-print-directory BUILDDIR=$(BUILDDIR)/analyse CC=gcc WERROR=1 LAPACKE=$(LAPACKE) \
	    CFLAGS='-O1 -fanalyzer -Wno-analyzer-shift-count-overflow' JPEG=$(JPEG) BACKEND=$(BACKEND) lib-static examples >/dev/null && echo "gcc -fanalyzer: nothing found"

# A wild read, an uninitialised value and a leak are errors; a tracker's own block is known by the aligned address inside it, so
# that valgrind calls it possibly lost, which is none. TESTS= names some programs: all of them take long. valgrind does not know
# every instruction of this very processor, for which the peaks of the bench are built; a test's own malloc, which counts, is to be
# called.
valgrind := valgrind --quiet --error-exitcode=99 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite \
	--soname-synonyms=somalloc=nouserintercepts
memcheck: unity ## the C tests under valgrind, with the builtin backend
	+@$(MAKE) --no-print-directory LAPACKE=no JPEG=$(JPEG) NATIVE=no BACKEND=builtin BUILDDIR=$(BUILDDIR)/memcheck CFLAGS='-O1 -g' \
	    CPPFLAGS='$(CPPFLAGS) -DAST_TEST_VALGRIND' \
	    AST_TEST_RUNNER='$(valgrind)' test-c

format: ## lay out the C sources
	$(CLANG_FORMAT) -i $(c_files)
# clang-format leaves comments as they are, however long their lines.
format-check: ## fail when `make format` would change a file, or a comment is too wide
	$(CLANG_FORMAT) --dry-run -Werror $(c_files)
	@awk 'length > 132 && (FILENAME ~ /[.][ch]$$/ || /^[ \t]*#/) { long = 1; print FILENAME ":" FNR ": " length " columns" } \
	    END { if (long) print "lines of C and comments have 132 columns at most"; exit long }' \
	    $(c_files) $(filter Makefile %.mk,$(MAKEFILE_LIST)) .ci/run

# ---- Installing ----

.PHONY: install uninstall
install: lib examples ## into PREFIX: header, libraries, pkg-config file, command
	@sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(LIBDIR)|' -e 's|@VERSION@|$(version)|' -e 's|@LIBS_PRIVATE@|$(lib_libs)|' \
	    asttrack.pc.in > $(BUILDDIR)/asttrack.pc
	$(INSTALL) -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/include $(DESTDIR)$(LIBDIR)/pkgconfig
	$(INSTALL) -m 755 $(BUILDDIR)/asttrack $(DESTDIR)$(PREFIX)/bin
	$(INSTALL) -m 644 include/asttrack.h $(DESTDIR)$(PREFIX)/include
	$(INSTALL) -m 644 $(static_lib) $(DESTDIR)$(LIBDIR)
	$(INSTALL) -m 755 $(shared_lib) $(DESTDIR)$(LIBDIR)
	ln -sf $(notdir $(shared_lib)) $(DESTDIR)$(LIBDIR)/libasttrack.so.$(major)
	ln -sf libasttrack.so.$(major) $(DESTDIR)$(LIBDIR)/libasttrack.so
	$(INSTALL) -m 644 $(BUILDDIR)/asttrack.pc $(DESTDIR)$(LIBDIR)/pkgconfig
uninstall: ## remove what `make install` put there
	rm -f $(DESTDIR)$(PREFIX)/bin/asttrack $(DESTDIR)$(PREFIX)/include/asttrack.h $(DESTDIR)$(LIBDIR)/libasttrack.a \
	    $(DESTDIR)$(LIBDIR)/libasttrack.so $(DESTDIR)$(LIBDIR)/libasttrack.so.$(major) \
	    $(DESTDIR)$(LIBDIR)/$(notdir $(shared_lib)) $(DESTDIR)$(LIBDIR)/pkgconfig/asttrack.pc

# ---- Firmware ----

include examples/cortex-m7/firmware.mk

# ---- Housekeeping ----

.PHONY: clean distclean help
clean: ## remove BUILDDIR
	$(if $(filter $(abspath $(BUILDDIR))%,$(CURDIR)),$(error BUILDDIR=$(BUILDDIR) holds these sources: not removed))
	rm -rf $(BUILDDIR)
distclean: clean ## remove also what was fetched: Unity, the virtual environment
	rm -rf .unity .venv
help: ## this text
	@echo "targets:"
	@sed -n 's/^\([a-z0-9-]*\):[^#]*## \(.*\)/\1\t\2/p' $(filter Makefile %.mk,$(MAKEFILE_LIST)) | awk -F '\t' '{ printf "  %-14s %s\n", $$1, $$2 }'
	@echo "variables (make NAME=value):"
	@awk '/^# / { said = substr($$0, 3) } /^[A-Z_]+ \?=/ { if (said) printf "  %-14s %s\n", $$1, said; said = "" }' \
	    $(filter Makefile %.mk,$(MAKEFILE_LIST))

-include $(wildcard $(BUILDDIR)/obj/*/*.d)
