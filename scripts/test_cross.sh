#!/bin/bash
# The same bits on every processor, by every compiler, at every optimisation: builds tests/cross/bits.c with the library's sources for
# each, runs it (other processors in qemu-user) and compares what it prints with the first build's, for ast_real double and float. Then
# the C tests themselves, on every processor: by gcc all but those of the command and of the bench, which need the host; by clang, and
# in the short run by gcc, those that are quick. Writes a line a build, and at last the table. JOBS builds run at a time.
# usage: test_cross.sh DIRECTORY short|whole
set -u

usage="usage: test_cross.sh DIRECTORY short|whole"
directory=${1:?$usage}
extent=${2:?$usage}
sources=(src/*.c)
sources=("${sources[@]/src\/linalg_lapacke.c/}")
flags=(-std=c99 -ffp-contract=off -fno-math-errno -Iinclude -Iexamples/cortex-m7 -static)
results=$directory/results

# name, emulator, gcc, clang's target
targets=(
    "x86-64||gcc|x86_64-linux-gnu"
    "aarch64|qemu-aarch64|aarch64-linux-gnu-gcc|aarch64-linux-gnu"
    "armhf|qemu-arm|arm-linux-gnueabihf-gcc|arm-linux-gnueabihf"
    "riscv64|qemu-riscv64|riscv64-linux-gnu-gcc|riscv64-linux-gnu"
    "s390x|qemu-s390x|s390x-linux-gnu-gcc|s390x-linux-gnu"
    "powerpc|qemu-ppc|powerpc-linux-gnu-gcc|powerpc-linux-gnu"
)
quick="test_config test_decision test_random test_resample"
all=$(for source in tests/test_*.c; do
    case $source in *test_command*|*test_bench*|*test_memory*) ;; *) basename "$source" .c ;; esac
done)
# The short run leaves out what takes longest: clang, what is less optimised, all but one little-endian and one big-endian
# target, and the C tests on this machine itself, where `make test` runs them.
case $extent in
short)
    targets=("${targets[0]}" "${targets[1]}" "${targets[4]}")
    compilers=(gcc) optimisations=(-O3) tests_gcc=$quick
    ;;
whole) compilers=(gcc clang) optimisations=(-O0 -O1 -O2 -O3) tests_gcc=$all tests_clang=$quick ;;
*) echo "$usage" >&2; exit 2 ;;
esac

# command_of COMPILER GCC CLANG-TARGET: the compiler's command, in `command`
command_of() {
    # s390x evaluates float in double precision when told to follow C99 to the letter
    if [ "$1" = gcc ]; then command=("$2" -fexcess-precision=fast); else command=(clang --target="$3"); fi
}

# clang 14 for s390x, as soon as it optimises, gets sums of floats in double wrong, in plain C (or the emulator does): docs/firmware.md
left_out() {
    [ "$1-$2" = s390x-clang ]
}

# bits TARGET EMULATOR COMPILER OPTIMISATION REAL COMMAND...: leaves what the program printed, or why there is none
bits() {
    local emulator=$2 output=$results/bits-$1-$3$4-$5 optimisation=$4 real=$5 program
    shift 5
    program=$output.program
    if "$@" "$optimisation" -DAST_REAL="$real" "${flags[@]}" -o "$program" ${sources[@]} tests/cross/bits.c \
        examples/cortex-m7/small_scene.c -lm -pthread >"$output.log" 2>&1; then
        ${emulator:+"$emulator"} "$program" >"$output" 2>&1
    else
        echo "does not build: $(grep -m 1 error "$output.log")" >"$output"
    fi
    rm -f "$program"
}

# c_tests TARGET EMULATOR COMPILER TESTS COMMAND...: leaves a summary
c_tests() {
    local name=$1-$3 emulator=$2 tests=$4 cflags=-O2 summary
    [ "$name" = aarch64-gcc ] && cflags="-O2 -fno-tree-vectorize" # gcc 12 ends on test_resample.c with an internal error
    summary=$directory/$name/tests/summary
    shift 4
    rm -f "$summary"
    AST_TEST_RUNNER=$emulator "${MAKE:-make}" --no-print-directory BUILDDIR="$directory/$name" CC="$*" CFLAGS="$cflags" \
        LDFLAGS=-static LAPACKE=no JPEG=no NATIVE=no BACKEND=builtin TESTS="$(echo $tests)" test-c >"$results/tests-$name.log" 2>&1
    if [ -s "$summary" ]; then sed 's/^[^:]*: //' "$summary"; else echo "0 passed, 1 failed, 0 skipped"; fi >"$results/tests-$name"
}

# A core is given to each as soon as one is free.
at_once() {
    while [ "$(jobs -rp | wc -l)" -ge "${JOBS:-2}" ]; do wait -n; done
    "$@" </dev/null &
}

rm -rf "$results" && mkdir -p "$results" || exit
skipped=0
chosen=()
for row in "${targets[@]}"; do
    IFS='|' read -r target emulator gcc clang_target <<<"$row"
    if type "$gcc" ${emulator:+"$emulator"} >/dev/null 2>&1; then
        chosen+=("$row")
    else
        echo "  skip $target: no $gcc or no $emulator"
        skipped=$((skipped + 1))
    fi
done

for row in "${chosen[@]}"; do
    IFS='|' read -r target emulator gcc clang_target <<<"$row"
    for compiler in "${compilers[@]}"; do
        if left_out "$target" "$compiler"; then
            echo "  skip $target by $compiler: docs/firmware.md says why"
            skipped=$((skipped + 1))
            continue
        fi
        command_of "$compiler" "$gcc" "$clang_target"
        for optimisation in "${optimisations[@]}"; do
            for real in double float; do at_once bits "$target" "$emulator" "$compiler" "$optimisation" "$real" "${command[@]}"; done
        done
        tests=tests_$compiler
        [ "$extent" = short ] && [ -z "$emulator" ] && continue
        at_once c_tests "$target" "$emulator" "$compiler" "${!tests}" "${command[@]}"
    done
done
wait

# ---- What came of it ----

passed=0 failed=0
table=()
for row in "${chosen[@]}"; do
    IFS='|' read -r target _ <<<"$row"
    for compiler in "${compilers[@]}"; do
        if left_out "$target" "$compiler"; then continue; fi
        equal=0 builds=0
        for optimisation in "${optimisations[@]}"; do
            for real in double float; do
                expected=$results/bits-x86-64-gcc${optimisations[-1]}-$real
                output=$results/bits-$target-$compiler$optimisation-$real
                builds=$((builds + 1))
                if grep -q '^literal' "$output" && cmp -s "$output" "$expected"; then
                    equal=$((equal + 1))
                    echo "  ok   $target, $compiler $optimisation, $real"
                else
                    echo "  FAIL $target, $compiler $optimisation, $real:"
                    diff "$expected" "$output" | head -n 6
                fi
            done
        done
        good=0 bad=0 left=0
        [ "$extent" = short ] && [ "$target" = x86-64 ] || read -r good _ bad _ left _ <"$results/tests-$target-$compiler"
        [ "$bad" -eq 0 ] || { grep -a -A 20 FAIL "$results/tests-$target-$compiler.log" || tail -n 20 "$results/tests-$target-$compiler.log"; }
        passed=$((passed + equal + good)) failed=$((failed + builds - equal + bad)) skipped=$((skipped + left))
        table+=("$(printf '| %s | %s | %d of %d | %d of %d |' "$target" "$compiler" "$equal" "$builds" "$good" $((good + bad)))")
    done
done
echo "| target | compiler | builds with the same bits (${optimisations[*]}; ast_real double, float) | C tests passed (-O2) |"
echo "| --- | --- | --- | --- |"
printf '%s\n' "${table[@]}"
echo "cross tests: $passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
