"""Configurations by name."""

import math
from typing import Any

import numpy as np
import pytest

from asttrack import PRESETS, AstError, ErrorCode, Tracker, config_fields


def test_presets_differ_and_all_start() -> None:
    assert set(PRESETS) == {"paper", "robust", "tiny", "compact"}
    sizes = {name: Tracker(name).memory_size for name in PRESETS}
    assert sizes["tiny"] < sizes["paper"] < sizes["robust"]
    assert sizes["tiny"] < sizes["compact"] < sizes["robust"] / 2
    assert Tracker().config == Tracker("robust").config


def test_fields_come_from_the_library() -> None:
    fields = {field.name: field for field in config_fields()}
    assert list(Tracker().config) == list(fields)
    assert fields["basis"].choices == ("centred", "raw")
    assert (fields["particles"].kind, fields["particles"].minimum, fields["particles"].maximum) == ("int", 1, 65536)
    assert (fields["scale_min"].kind, fields["scale_min"].minimum, fields["scale_min"].maximum) == ("float", 0.01, 1.0)
    assert (fields["seed"].kind, fields["seed"].minimum, fields["seed"].maximum) == ("seed", 0, 2**64 - 1)


def test_values_arrive() -> None:
    changes: dict[str, Any] = {"particles": np.int64(17), "walk_x": 2, "alpha": np.float32(0.25), "scoring": "literal", "basis": 1}
    config = Tracker("paper", **changes, seed=2**64 - 1).config
    assert config | {"particles": 17, "walk_x": 2.0, "alpha": 0.25, "scoring": "literal", "basis": "raw"} == config
    assert config["seed"] == 2**64 - 1


def test_the_configuration_configures_an_equal_tracker() -> None:
    config: dict[str, Any] = Tracker("tiny", sigma=0.07, normalisation="mean").config
    assert Tracker(**config).config == config


def test_limits_of_the_table_are_legal_and_nothing_beyond_is() -> None:
    for field in config_fields():
        if field.kind == "seed":
            outside: list[float] = [-1, 2**64]
        elif field.kind == "float":
            outside = [math.nextafter(field.minimum, -math.inf) - 1e-6, field.maximum * 1.001, math.nan, math.inf, -math.inf, 1e300]
        else:
            outside = [int(field.minimum) - 1, int(field.maximum) + 1, 2**31, -(2**40)]
        for value in outside:
            change: dict[str, Any] = {field.name: value}
            with pytest.raises(AstError, match=f"^{field.name}=.*: the legal range is") as caught:
                Tracker(**change)
            assert (caught.value.code, caught.value.field) == (ErrorCode.CONFIG, field.name)


def test_fields_that_contradict_each_other_are_named() -> None:
    with pytest.raises(AstError, match="basis_size=8: legal by itself, but not with the other fields") as caught:
        Tracker("paper", history=3, basis_size=8)
    assert caught.value.field == "basis_size"
    with pytest.raises(AstError, match="basis=centred: legal by itself") as caught:
        Tracker("paper", model="linear")
    assert caught.value.field == "basis"


def test_an_unknown_field_is_named_with_its_neighbours() -> None:
    with pytest.raises(TypeError, match="unknown configuration field 'particels': did you mean particles"):
        Tracker(particels=5)
    with pytest.raises(TypeError, match="unknown configuration field 'zzz': there are particles, shortlist, walk_x"):
        Tracker(zzz=5)
    with pytest.raises(TypeError, match="unknown configuration field 'struct_size'"):
        Tracker(struct_size=5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"particles": 1.5}, r"particles takes an int, not 1\.5 \(float\)"),
        ({"particles": "many"}, "particles takes an int, not 'many'"),
        ({"alpha": "0.5"}, "alpha takes a number, not '0.5'"),
        ({"alpha": None}, r"alpha takes a number, not None \(NoneType\)"),
        ({"alpha": 1j}, "alpha takes a number"),
        ({"basis": 1.0}, r"basis takes one of 'centred', 'raw' or an index into them, not 1\.0 \(float\)"),
        ({"seed": 0.5}, "seed takes an int"),
    ],
)
def test_a_value_of_the_wrong_type_says_what_is_wanted(change: dict[str, Any], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        Tracker(**change)


def test_an_unknown_choice_lists_the_choices() -> None:
    with pytest.raises(AstError, match="basis='cantred': it takes one of 'centred', 'raw'") as caught:
        Tracker(basis="cantred")
    assert (caught.value.code, caught.value.field) == (ErrorCode.CONFIG, "basis")


def test_an_unknown_preset_or_colour_order_lists_them() -> None:
    with pytest.raises(ValueError, match="preset must be one of 'paper', 'robust', 'tiny', 'compact', not 'best'"):
        Tracker("best")
    with pytest.raises(ValueError, match="colour must be 'bgr' or 'rgb', not 'yuv'"):
        Tracker(colour="yuv")  # type: ignore[arg-type]


def test_a_float_too_large_for_any_float_is_out_of_range() -> None:
    with pytest.raises(AstError, match=r"the legal range is 0 \.\. 1e\+06"):
        Tracker(alpha=10**400)
