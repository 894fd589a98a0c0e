#!/bin/sh
# The manifests of Zephyr, ESP-IDF, PlatformIO and Arduino: their files parse, carry the header's version, and name sources that exist; the
# flags that they give build the library without its heap. Their own tools are not asked.
set -eu

version=$(sed -n 's/^.define AST_VERSION_[A-Z]* \([0-9][0-9]*\)$/\1/p' include/asttrack.h | paste -s -d .)
python3 - "$version" <<'END'
import json, pathlib, re, sys
version = sys.argv[1]
library = json.loads(pathlib.Path("library.json").read_text())
assert library["version"] == version, f"library.json says {library['version']}, the header {version}"
arduino = dict(line.split("=", 1) for line in pathlib.Path("library.properties").read_text().splitlines())
assert arduino["version"] == version, f"library.properties says {arduino['version']}, the header {version}"
wanted = {"name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures"}
assert wanted <= set(arduino), f"library.properties lacks {sorted(wanted - set(arduino))}"
assert pathlib.Path("src", arduino["includes"]).exists(), "library.properties names a header that is not in src/"
component = pathlib.Path("idf_component.yml").read_text()
assert f'version: "{version}"' in component, f"idf_component.yml does not say {version}"
for name, key in (("zephyr/module.yml", "kconfig"), ("zephyr/module.yml", "cmake")):
    place = re.search(rf"^  {key}: (\S+)$", pathlib.Path(name).read_text(), re.M).group(1)
    assert pathlib.Path(place).exists(), f"{name} names {place}, which is not there"
for name in ("CMakeLists.txt", "zephyr/CMakeLists.txt"):
    text = pathlib.Path(name).read_text()
    for flag in library["build"]["flags"]:
        bare = flag.removeprefix("-D").split("=")[0]
        assert bare in text, f"{name} lacks {bare}, which library.json has"
    assert text.count("(") == text.count(")"), f"{name}: parentheses"
END
for source in src/*.c; do
    [ "$source" = src/linalg_lapacke.c ] || ${CC:-cc} -DAST_NO_HEAP -DAST_REAL=float -ffp-contract=off -fno-math-errno -Iinclude \
        -fsyntax-only "$source"
done
# As Arduino's builder compiles: every file of src/, with nothing but src/ on the path.
for source in src/*.c; do
    ${CC:-cc} -DARDUINO=10819 -Isrc -Wall -Wextra -Werror -fsyntax-only "$source"
done
printf '#include <asttrack.h>\nstatic ast_config cfg;\nint f(void) { return ast_config_preset(&cfg, AST_PRESET_TINY); }\n' |
    ${CXX:-c++} -x c++ -DARDUINO=10819 -Isrc -Wall -Wextra -Werror -fsyntax-only -
echo "manifests: version $version, sources and flags as they should be"
