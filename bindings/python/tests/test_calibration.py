"""The fit of the score to ground truth, `make calibrate`: it finds what made the outcomes, and knows the source's constants."""

import importlib.util
import sys
from types import ModuleType

import numpy as np
import pytest

from asttrack.failures import DataError
from header import REPOSITORY

TRUE = np.array([4.0, 1.5, 0.8, -3.0])


@pytest.fixture(scope="module")
def calibration() -> ModuleType:
    specification = importlib.util.spec_from_file_location("fit", REPOSITORY / "calibration" / "fit.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules["fit"] = module
    specification.loader.exec_module(module)
    return module


def frames(calibration: ModuleType, name: str, seed: int, count: int = 20000, unknown: float = 0) -> object:
    """Frames whose outcomes follow TRUE, scored by it, and by a predictor that nobody knows of."""
    chance = np.random.default_rng(seed)
    start, inside, spread = chance.uniform(0, 1, count), chance.uniform(0, 1, count), chance.exponential(0.1, count)
    terms = np.column_stack([start, -np.log(spread + 0.01), inside, np.ones(count)])
    right = 1 / (1 + np.exp(-terms @ TRUE - unknown * chance.normal(size=count)))
    return calibration.Seen(name, terms, right, chance.uniform(size=count) > right)


def test_the_fit_finds_what_made_the_outcomes(calibration: ModuleType) -> None:
    # A sequence of half the length has the same weight.
    fitted = calibration.fit([frames(calibration, "a", 1), frames(calibration, "b", 2, 10000)])
    np.testing.assert_allclose(fitted, TRUE, atol=0.3)


def test_the_constants_of_the_source_are_seen_in_its_scores(calibration: ModuleType) -> None:
    np.testing.assert_allclose(calibration.of_source([frames(calibration, "a", 3)]), TRUE, atol=1e-6)


def test_a_source_with_other_predictors_is_refused(calibration: ModuleType) -> None:
    with pytest.raises(DataError, match=r"give calibration/observe\.c and TERMS its predictors"):
        calibration.of_source([frames(calibration, "a", 4, unknown=1)])


def test_outcomes_without_an_error_are_refused(calibration: ModuleType) -> None:
    seen = frames(calibration, "a", 5, 50)
    with pytest.raises(DataError, match="does not settle"):
        calibration.logistic(seen.terms, seen.terms[:, 0] < 0.5, np.ones(50))  # type: ignore[attr-defined]
