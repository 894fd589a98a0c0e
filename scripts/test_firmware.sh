#!/bin/sh
# Runs the firmware's images in the emulator and compares what they write with the same program on the host.
# usage: test_firmware.sh DIRECTORY VARIANT:REAL:BOARD...
set -u

directory=${1:?usage: test_firmware.sh DIRECTORY VARIANT:REAL:BOARD...}
shift
passed=0 failed=0

report() {
    if [ "$1" -eq 0 ]; then
        passed=$((passed + 1))
        echo "  ok   $2"
    else
        failed=$((failed + 1))
        echo "  FAIL $2"
    fi
}

# Lines that begin with # tell of the machine and may differ.
numbers() {
    grep -v '^#' "$1"
}

for real in float double minutes; do
    "$directory/host-$real/program" >"$directory/host-$real/output" 2>&1
    report $? "host-$real: $(numbers "$directory/host-$real/output" | grep -c '^ok') conditions hold"
    grep '^FAIL' "$directory/host-$real/output"
done

for row in "$@"; do
    variant=${row%%:*} board=${row##*:}
    real=${row#*:} && real=${real%:*}
    image=$directory/$variant/program.elf output=$directory/$variant/output
    timeout 300 "$QEMU_ARM" -M "$board" -nographic -monitor none -serial none -semihosting-config enable=on,target=native \
        -kernel "$image" >"$output" 2>&1 </dev/null
    report $? "$variant on $board: $(numbers "$output" | grep -c '^ok') conditions hold; $(sed -n 's/^# //p' "$output" | sort -u | paste -s -d ';')"
    grep '^FAIL' "$output"
    numbers "$directory/host-$real/output" >"$directory/host-$real/numbers"
    numbers "$output" | diff "$directory/host-$real/numbers" - >"$directory/$variant/difference"
    report $? "$variant writes the host's $(grep -c ' bits ' "$directory/host-$real/numbers") results, bit for bit"
    head -n 5 "$directory/$variant/difference"
    if [ "$real" = float ]; then
        doubles=$("${ARM_PREFIX}nm" "$image" | grep -E '__aeabi_(d|[a-z]*2d)' | awk '{ print $NF }' | paste -s -d ' ')
        [ -z "$doubles" ]
        report $? "$variant links no arithmetic in double precision${doubles:+: $doubles}"
    fi
done

echo "firmware tests: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
