#!/bin/sh
# Puts Unity, the C test framework, into a directory: the copy that Debian ships in the source package cjson, checked by apt.
# The system's own list of sources is read, never changed; all of apt's files live in a temporary directory.
set -eu

target=${1:?usage: fetch_unity.sh DIRECTORY}
package=cjson

give_up() {
    echo "Unity, the C test framework, could not be fetched: $1." >&2
    echo "Get it from https://github.com/ThrowTheSwitch/Unity and say: make test UNITY_DIR=/path/to/Unity" >&2
    exit 1
}

command -v apt-get >/dev/null || give_up "there is no apt-get on this machine"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# One deb-src line for each entry of the system that serves the running release, from one-line and deb822 files alike.
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-sid}")
cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null | awk -v suite="$suite" '
    $1 == "deb" {
        options = ""
        first = 2
        if ($2 ~ /^\[/) {
            do options = options " " $first; while ($(first++) !~ /\]$/ && first <= NF)
        }
        if ($(first + 1) != suite) next
        line = "deb-src" options
        for (i = first; i <= NF; i++) line = line " " $i
        print line
    }' >"$work/sources.list"
for file in /etc/apt/sources.list.d/*.sources; do
    [ -f "$file" ] || continue
    awk -v suite="$suite" -v RS= '
        {
            split("", field)
            n = split($0, lines, "\n")
            for (i = 1; i <= n; i++) {
                if (lines[i] ~ /^#/) continue
                if (lines[i] ~ /^[ \t]/) {
                    field[name] = field[name] " " lines[i]
                    continue
                }
                colon = index(lines[i], ":")
                name = tolower(substr(lines[i], 1, colon - 1))
                field[name] = substr(lines[i], colon + 1)
            }
            if ((" " field["types"] " ") !~ / deb /) next
            if ((" " field["suites"] " ") !~ (" " suite " ")) next
            if (tolower(field["enabled"]) ~ /no/) next
            key = field["signed-by"]
            gsub(/^[ \t]+|[ \t]+$/, "", key)
            options = key ~ /^\/[^ ]*$/ ? " [signed-by=" key "]" : ""
            uris = split(field["uris"], uri, " ")
            for (i = 1; i <= uris; i++) print "deb-src" options, uri[i], suite, field["components"]
        }' "$file" >>"$work/sources.list"
done
[ -s "$work/sources.list" ] || give_up "no entry for $suite in /etc/apt/sources.list or /etc/apt/sources.list.d"

mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
apt() {
    apt-get -qq -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::Cache="$work/cache" \
        -o Dir::State::Lists="$work/lists" -o APT::Sandbox::User="$(id -un)" "$@"
}
cd "$work"
# An entry that has no sources fails here and does no harm when another has them.
apt update >log 2>&1 || true
apt source --download-only "$package" >>log 2>&1 || give_up "apt-get said: $(grep -m 1 '^[EW]:' log)"
mkdir unity
tar -xf "$package"_*.orig.tar.* -C unity --wildcards --strip-components=3 '*/tests/unity/*' || give_up "$package holds no Unity"
cd "$OLDPWD"

# Complete or not there at all; of two that run at once, one wins and both succeed.
rm -rf "$target.new.$$"
cp -r "$work/unity" "$target.new.$$"
[ -f "$target/src/unity.c" ] || rm -rf "$target"
mv -T "$target.new.$$" "$target" 2>/dev/null || rm -rf "$target.new.$$"
[ -f "$target/src/unity.c" ] || give_up "$target cannot be written"
echo "Unity: $target, from Debian's source package $package"
