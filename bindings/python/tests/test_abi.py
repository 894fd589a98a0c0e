"""The mirror of the C interface is the C interface."""

import ctypes
import re
from pathlib import Path

import pytest

import asttrack
from asttrack import ErrorCode, Status, _abi, _library
from header import compile_shared, header_text, run_program

STRUCTURES: dict[str, type[ctypes.Structure]] = {
    "ast_config": asttrack.library.config,
    "ast_config_field": _abi.ConfigField,
    "ast_frame": _abi.Frame,
    "ast_box": _abi.Box,
    "ast_result": _abi.Result,
    "ast_particles": _abi.Particles,
    "ast_subspace": _abi.Subspace,
    "ast_distance": _abi.Distance,
}
CONSTANTS = {
    "AST_MAX_FRAME": _abi.MAX_FRAME,
    "AST_MAX_HISTORY": _abi.MAX_HISTORY,
    "AST_MAX_BASIS": _abi.MAX_BASIS,
    "AST_FIELD_INT": _abi.FIELD_INT,
    "AST_FIELD_FLOAT": _abi.FIELD_FLOAT,
    "AST_FIELD_ENUM": _abi.FIELD_ENUM,
    "AST_FIELD_SEED": _abi.FIELD_SEED,
    **{f"AST_{status.name}": status.value for status in Status},
    **{f"AST_E_{code.name}": code.value for code in ErrorCode},
    **{f"AST_PRESET_{name.upper()}": value for name, value in _abi.PRESETS.items()},
    **{f"AST_BASIS_{name.upper()}": value for name, value in _abi.BASES.items()},
}


def field_names(structure: type[ctypes.Structure]) -> list[str]:
    return [row[0] for row in structure._fields_]


def test_structures_are_the_headers(tmp_path: Path) -> None:
    mirrored, questions = [], []
    for name, structure in STRUCTURES.items():
        mirrored.append(f"{name} {ctypes.sizeof(structure)}")
        questions.append(f'printf("{name} %zu\\n", sizeof({name}));')
        for member in field_names(structure):
            place = getattr(structure, member)
            mirrored.append(f"{name}.{member} {place.offset} {place.size}")
            questions.append(f'printf("{name}.{member} %zu %zu\\n", offsetof({name}, {member}), sizeof((({name} *)0)->{member}));')
    program = "#include <stdio.h>\n#include <asttrack.h>\nint main(void) {\n" + "\n".join(questions) + "\nreturn 0;\n}\n"
    assert run_program(program, tmp_path).split("\n")[:-1] == mirrored


def test_no_structure_of_the_header_is_missing() -> None:
    declared = set(re.findall(r"^} (ast_\w+);$", header_text(), re.MULTILINE))
    assert declared == set(STRUCTURES)


def test_constants_are_the_headers(tmp_path: Path) -> None:
    questions = "\n".join(f'printf("{name} %d\\n", {name});' for name in CONSTANTS)
    program = f"#include <stdio.h>\n#include <asttrack.h>\nint main(void) {{\n{questions}\nreturn 0;\n}}\n"
    printed = dict(line.split() for line in run_program(program, tmp_path).splitlines())
    assert {name: int(value) for name, value in printed.items()} == CONSTANTS


@pytest.mark.parametrize("prefix", ["AST_E_", "AST_PRESET_", "AST_FIELD_", "AST_BASIS_"])
def test_no_constant_of_the_header_is_missing(prefix: str) -> None:
    declared = set(re.findall(rf"^\s*(?:enum {{ )?({prefix}\w+) =|, ({prefix}\w+) =", header_text(), re.MULTILINE))
    names = {name for pair in declared for name in pair if name}
    assert names == {name for name in CONSTANTS if name.startswith(prefix)}


def test_prototypes_have_the_headers_arguments() -> None:
    calls = {
        name: 0 if arguments.strip() == "void" else arguments.count(",") + 1
        for name, arguments in re.findall(r"^AST_API [^(]*?(ast_\w+)\(([^)]*)\);", header_text(), re.MULTILINE)
    }
    assert {name: len(arguments) for name, (_, arguments) in _abi.PROTOTYPES.items()} == {
        name: calls[name] for name in _abi.PROTOTYPES
    }
    # What the binding has no use for: numpy users do not hold packed camera formats.
    assert set(calls) - set(_abi.PROTOTYPES) == {"ast_get_config", "ast_grey_from_yuyv", "ast_grey_from_rgb565"}


def test_every_code_has_the_librarys_words() -> None:
    unknown = asttrack.library.text(-99)
    for code in ErrorCode:
        assert asttrack.library.text(code) not in ("", unknown)


# ---- A library that does not fit is refused when it is loaded. ----

FIELDS = """
static const ast_config_field rows[] = {
    {"particles", NULL, offsetof(ast_config, particles) + SHIFT, KIND, 1, 2},
};
const ast_config_field *ast_config_fields(int32_t *count) { *count = 1; return rows; }
int ast_config_preset(ast_config *cfg, int preset) { (void)preset; cfg->struct_size = SIZE; return 0; }
"""


def stub(version: str = "0.1.9", leave_out: str = "", shift: int = 0, kind: int = 0, size: int = 8) -> str:
    """C source of a library with every name of the interface, in which only the checks of loading get answers."""
    answered = {"ast_version", "ast_config_fields", "ast_config_preset"}
    others = [name for name in _abi.PROTOTYPES if name not in answered | {leave_out}]
    return (
        f"#define SHIFT {shift}\n#define KIND {kind}\n#define SIZE {size}\n"
        + "#include <stddef.h>\n#include <asttrack.h>\n"
        + f'const char *ast_version(void) {{ return "{version}"; }}\n'
        + FIELDS
        + "".join(f'__asm__(".globl {name}\\n{name} = ast_version\\n");\n' for name in others)
    )


def test_a_fitting_stub_loads(tmp_path: Path) -> None:
    loaded = _library.load(compile_shared(stub(), tmp_path), "0.1.0")
    assert loaded.version == "0.1.9"
    assert field_names(loaded.config) == ["struct_size", "particles"]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (stub(version="0.2.0"), r"is version 0\.2\.0, but this package is version 0\.1\.0"),
        (stub(leave_out="ast_step"), "it has no ast_step"),
        (stub(shift=4), "particles lies at byte 8, expected at 4"),
        (stub(kind=9), "particles is of unknown kind 9"),
        (stub(size=12), "ast_config has 12 bytes, expected 8"),
        ("int other(void) { return 0; }\n", "is not a libasttrack that fits this package: it has no ast_version"),
    ],
    ids=["version", "function", "offset", "kind", "size", "stranger"],
)
def test_a_library_that_does_not_fit_is_refused(tmp_path: Path, source: str, message: str) -> None:
    with pytest.raises(ImportError, match=message):
        _library.load(compile_shared(source, tmp_path), "0.1.0")


def test_a_file_that_is_no_library_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "text.so"
    path.write_text("not a library")
    with pytest.raises(ImportError, match=r"cannot load .*text\.so"):
        _library.load(path, "0.1.0")
