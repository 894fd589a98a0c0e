#!/bin/bash
# The same bits on every processor, by every compiler, at every optimisation: builds tests/cross/bits.c with the library's sources for
# each, runs it (other processors in qemu-user) and compares what it prints with the first build's, for ast_real double and float. Then
# the C tests themselves, by gcc -O2: the short run takes some of them, the whole run all but those of the command and of the bench.
# usage: test_cross.sh DIRECTORY short|whole
set -u

directory=${1:?usage: test_cross.sh DIRECTORY short|whole}
extent=${2:?usage: test_cross.sh DIRECTORY short|whole}
sources=(src/*.c)
sources=("${sources[@]/src\/linalg_lapacke.c/}")
flags=(-std=c99 -ffp-contract=off -fno-math-errno -Iinclude -Iexamples/cortex-m7 -static)
passed=0 failed=0 skipped=0

# name, emulator, gcc, clang's target
targets=(
    "x86-64||gcc|x86_64-linux-gnu"
    "aarch64|qemu-aarch64|aarch64-linux-gnu-gcc|aarch64-linux-gnu"
    "armhf|qemu-arm|arm-linux-gnueabihf-gcc|arm-linux-gnueabihf"
    "riscv64|qemu-riscv64|riscv64-linux-gnu-gcc|riscv64-linux-gnu"
    "s390x (big-endian)|qemu-s390x|s390x-linux-gnu-gcc|s390x-linux-gnu"
    "powerpc (big-endian)|qemu-ppc|powerpc-linux-gnu-gcc|powerpc-linux-gnu"
)
# The short run leaves out what takes longest: clang, what is less optimised, all but one little-endian and one big-endian target, and
# the C tests on this machine itself, where `make test` runs them.
case $extent in
short)
    targets=("${targets[0]}" "${targets[1]}" "${targets[4]}")
    compilers=(gcc) optimisations=(-O3)
    tests="test_config test_decision test_random test_resample"
    ;;
whole)
    compilers=(gcc clang) optimisations=(-O0 -O1 -O2 -O3)
    tests=$(for source in tests/test_*.c; do
        case $source in *test_command*|*test_bench*|*test_memory*) ;; *) basename "$source" .c ;; esac
    done)
    ;;
*) echo "usage: test_cross.sh DIRECTORY short|whole" >&2; exit 2 ;;
esac

# try TARGET EMULATOR COMPILER OPTIMISATION REAL COMMAND...
try() {
    local target=$1 emulator=$2 compiler=$3 optimisation=$4 real=$5 program=$directory/bits
    shift 5
    if ! "$@" "$optimisation" -DAST_REAL="$real" "${flags[@]}" -o "$program" ${sources[@]} tests/cross/bits.c \
        examples/cortex-m7/small_scene.c -lm -pthread >"$directory/log" 2>&1; then
        failed=$((failed + 1))
        echo "  FAIL $target, $compiler $optimisation, $real: does not build: $(grep -m 1 error "$directory/log")"
        return
    fi
    ${emulator:+"$emulator"} "$program" >"$directory/output" 2>&1
    [ -e "$directory/expected-$real" ] || cp "$directory/output" "$directory/expected-$real"
    if grep -q '^literal' "$directory/output" && cmp -s "$directory/output" "$directory/expected-$real"; then
        passed=$((passed + 1))
        echo "  ok   $target, $compiler $optimisation, $real"
    else
        failed=$((failed + 1))
        echo "  FAIL $target, $compiler $optimisation, $real:"
        diff "$directory/expected-$real" "$directory/output" | head -n 6
    fi
}

# unit_tests TARGET EMULATOR COMPILER: the C tests there; a row of the table
unit_tests() {
    local target=$1 emulator=$2 compiler=$3 name=${1%% *} flags=-O2 summary
    [ "$compiler" = s390x-linux-gnu-gcc ] && flags="-O2 -fexcess-precision=fast"
    [ "$compiler" = aarch64-linux-gnu-gcc ] && flags="-O2 -fno-tree-vectorize" # gcc 12 ends on test_resample.c with an internal error
    summary=$directory/$name/tests/summary
    rm -f "$summary"
    AST_TEST_RUNNER=$emulator "${MAKE:-make}" --no-print-directory BUILDDIR="$directory/$name" CC="$compiler" CFLAGS="$flags" \
        LDFLAGS=-static LAPACKE=no JPEG=no NATIVE=no BACKEND=builtin TESTS="$(echo $tests)" test-c >"$directory/$name.log" 2>&1
    if [ $? -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); grep -a FAIL "$directory/$name.log"; fi
    rows+=("$(printf '  %-22s %-28s %-10s %s' "$target" "$compiler" "-O2" "$(sed 's/^[^:]*: //' "$summary" 2>/dev/null || echo "does not build")")")
}

rows=()
mkdir -p "$directory"
rm -f "$directory"/expected-*
for row in "${targets[@]}"; do
    IFS='|' read -r target emulator gcc clang_target <<<"$row"
    if ! type "$gcc" ${emulator:+"$emulator"} >/dev/null 2>&1; then
        echo "  skip $target: no $gcc or no $emulator"
        skipped=$((skipped + 1))
        continue
    fi
    for compiler in "${compilers[@]}"; do
        for optimisation in "${optimisations[@]}"; do
            # s390x evaluates float in double precision when told to follow C99 to the letter
            if [ "$compiler" = gcc ]; then
                command=("$gcc" -fexcess-precision=fast)
            else
                command=(clang --target="$clang_target")
            fi
            for real in double float; do
                try "$target" "$emulator" "$compiler" "$optimisation" "$real" "${command[@]}"
            done
        done
    done
    [ "$extent" = short ] && [ -z "$emulator" ] || unit_tests "$target" "$emulator" "$gcc"
done
echo "C tests, ast_real double:"
[ ${#rows[@]} -eq 0 ] || printf '%s\n' "${rows[@]}"
echo "cross tests: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
