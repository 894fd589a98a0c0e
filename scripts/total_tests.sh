#!/bin/sh
# Shows the summary lines that test runs left, with their total as the last, and keeps them in a file. A run that left none was
# not able to start: one failure.
# usage: total_tests.sh TOTAL-FILE SUMMARY-FILE...
set -u

total=${1:?total file}
shift
for summary in "$@"; do
    [ -s "$summary" ] || echo "$summary: 0 passed, 1 failed, 0 skipped (not written, the tests could not be built)" >"$summary"
done
awk -F ': ' '{
        split($2, count, " ")
        passed += count[1]
        failed += count[3]
        skipped += count[5]
        print
    }
    END { printf "all tests: %d passed, %d failed, %d skipped\n", passed, failed, skipped }' "$@" >"$total"
echo
cat "$total"
