#!/bin/sh
# The sources are C++ as well: compiled as such by g++ and clang++, without a warning, they track as they do as C, bit for bit.
# usage: test_cxx.sh DIRECTORY
set -eu

directory=${1:?usage: test_cxx.sh DIRECTORY}
# Designated initialisers leave the rest zero; gcc 12 finds its own header of AVX-512 uninitialised when it is C++.
flags='-ffp-contract=off -fno-math-errno -fno-trapping-math -Iinclude -Iexamples/cortex-m7'
warnings='-Wall -Wextra -Werror -Wno-missing-field-initializers -Wno-unknown-warning-option -Wno-maybe-uninitialized'
sources=$(ls src/*.c | grep -v linalg_lapacke)
mkdir -p "$directory"

for program in tests/cross/bits.c examples/cortex-m7/small_scene.c; do
    "${CC:-cc}" -std=c99 -O1 $flags -c -o "$directory/$(basename "$program" .c).o" "$program"
done
objects="$directory/bits.o $directory/small_scene.o"
"${CC:-cc}" -std=c99 -O1 $flags -o "$directory/as-c" $sources $objects -lm
"$directory/as-c" >"$directory/as-c.out"

for compiler in g++ clang++; do
    # shellcheck disable=SC2086
    "$compiler" -x c++ -std=c++17 -fsyntax-only $flags $warnings $sources
    "$compiler" -x c++ -std=c++11 -O1 $flags $warnings $sources -x none $objects -lm -o "$directory/as-$compiler"
    "$directory/as-$compiler" >"$directory/as-$compiler.out"
    cmp "$directory/as-c.out" "$directory/as-$compiler.out"
    echo "$compiler: the sources compile as C++11 and C++17, and give the bits that they give as C"
done
