#!/bin/sh
# Runs Unity test programs, shows what failed or was skipped, and writes one summary line. A program that crashes, prints no
# summary or runs no test is a failure too.
# usage: run_tests.sh SUMMARY-FILE TITLE PROGRAM...
set -u

summary=${1:?summary file}
title=${2:?title}
shift 2
mkdir -p "$(dirname "$summary")"
rm -f "$summary"
log=$(mktemp)
trap 'rm -f "$log"' EXIT

passed=0 failed=0 skipped=0
echo "$title:"
for program in "$@"; do
    name=$(basename "$program")
    # AST_TEST_RUNNER: what runs them, such as valgrind and its options
    timeout 1500 ${AST_TEST_RUNNER:-} "$program" >"$log" 2>&1
    status=$?
    # Unity's last word: "12 Tests 1 Failures 0 Ignored"
    counts=$(sed -n 's/^\([0-9][0-9]*\) Tests \([0-9][0-9]*\) Failures \([0-9][0-9]*\) Ignored *$/\1 \2 \3/p' "$log" | tail -n 1)
    read -r tests bad ignored <<COUNTS
${counts:-0 0 0}
COUNTS
    grep -a -E ':(FAIL|IGNORE)' "$log" | sed 's/^/    /'
    why=
    if [ -z "$counts" ]; then
        why="ended without a summary, status $status"
    elif [ "$tests" -eq 0 ]; then
        why="ran no test"
    elif [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then
        why="passed its tests, then ended with status $status"
    fi
    if [ -n "$why" ]; then
        bad=$((bad + 1))
        tests=$((tests + 1))
        echo "    $name $why; it said last:"
        tail -n 20 "$log" | sed 's/^/    | /'
    fi
    passed=$((passed + tests - bad - ignored))
    failed=$((failed + bad))
    skipped=$((skipped + ignored))
    printf '  %-4s %s: %d tests\n' "$([ "$bad" -eq 0 ] && echo ok || echo FAIL)" "$name" "$tests"
done
if [ $# -eq 0 ]; then
    echo "  there are no test programs"
    failed=1
fi
echo "$title: $passed passed, $failed failed, $skipped skipped" | tee "$summary"
[ "$failed" -eq 0 ]
