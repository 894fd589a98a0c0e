#!/bin/sh
# Runs libFuzzer harnesses one after the other, each for an equal share of the time, and prints a table. What they learn stays in
# DIRECTORY/NAME and is used again the next time, next to the repository's corpus; an input that ends a harness is kept as
# DIRECTORY/crash-... and makes the run fail.
# usage: fuzz.sh MINUTES DIRECTORY HARNESS...
set -u

minutes=${1:?minutes}
directory=${2:?directory}
shift 2
corpus=$(dirname "$0")/../tests/fuzz/corpus
seconds=$(awk -v minutes="$minutes" -v harnesses=$# 'BEGIN { print int(60 * minutes / harnesses) }')
[ "$seconds" -gt 0 ] || { echo "fuzz.sh: $minutes minutes are not a second for each of $# harnesses" >&2; exit 2; }

failed=0 total=0
printf '%-14s %12s %10s %9s %8s %7s\n' harness executions per-second coverage corpus status
for harness in "$@"; do
    name=$(basename "$harness" | sed 's/^fuzz_//')
    mkdir -p "$directory/$name"
    log=$directory/$name.log
    # A JPEG may take libjpeg a while to give up on; more than a minute for any input is a fault.
    "$harness" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=1024 -print_final_stats=1 \
        -artifact_prefix="$directory/$name-" "$directory/$name" "$corpus/$name" >"$log" 2>&1
    status=$?
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    per_second=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")
    # "#8192 pulse  cov: 1234 ft: 2345 corp: 67/1234b ..."
    coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
    files=$(find "$directory/$name" -type f | wc -l)
    total=$((total + ${executions:-0}))
    printf '%-14s %12s %10s %9s %8s %7s\n' "$name" "${executions:--}" "${per_second:--}" "${coverage:--}" "$files" \
        "$([ "$status" -eq 0 ] && echo ok || echo FAIL)"
    if [ "$status" -ne 0 ]; then
        failed=$((failed + 1))
        grep -a -E 'broken:|ERROR|SUMMARY|runtime error|Test unit written' "$log" | sed 's/^/    | /'
    fi
done
echo "fuzz: $total executions, $failed harnesses failed"
[ "$failed" -eq 0 ]
