"""The metrics, against figures worked out by hand and against their definitions."""

import numpy as np
import pytest

from asttrack.evaluation.metrics import (
    OVERLAPS,
    RADII,
    accuracy,
    centre_errors,
    overlaps,
    precision_curve,
    success_curve,
)

TRUTH = np.array([[0, 0, 10, 10], [0, 0, 10, 10], [np.nan] * 4, [0, 0, 10, 10], [0, 0, 10, 10.0]])
BOXES = np.array([[90, 90, 10, 10], [3, 4, 10, 10], [7, 7, 7, 7], [0, 0, 10, 20], [50, 0, 10, 10.0]])
OK = np.array([True, True, False, True, False])


def test_centre_error_is_the_distance_of_the_centres() -> None:
    errors = centre_errors(BOXES, TRUTH)
    assert np.allclose(errors[[1, 3, 4]], [5, 5, 50])
    assert np.isnan(errors[2])


def test_overlap_is_intersection_over_union() -> None:
    shares = overlaps(BOXES, TRUTH)
    assert np.allclose(shares[[1, 3, 4]], [42 / 158, 0.5, 0])
    assert np.isnan(shares[2])


def test_the_first_frame_and_those_without_truth_are_not_counted() -> None:
    figures = accuracy(BOXES, TRUTH, OK)
    assert figures.compared == 3
    assert figures.centre_error == pytest.approx(20)
    assert figures.precision == pytest.approx(2 / 3)
    assert figures.success == pytest.approx((42 / 158 + 0.5) / 3)
    assert figures.lost == 2


def test_twenty_pixels_are_within() -> None:
    truth = np.tile([0.0, 0, 10, 10], (3, 1))
    boxes = np.array([[0, 0, 10, 10], [20, 0, 10, 10], [20.001, 0, 10, 10]])
    assert accuracy(boxes, truth, np.ones(3, bool)).precision == 0.5


def test_a_sequence_annotated_in_its_first_frame_only_has_no_figures() -> None:
    truth = np.full((3, 4), np.nan)
    truth[0] = [0, 0, 10, 10]
    figures = accuracy(np.ones((3, 4)), truth, np.ones(3, bool))
    assert figures.compared == 0
    assert np.isnan([figures.centre_error, figures.precision, figures.success]).all()


def test_curves_are_their_definitions() -> None:
    random = np.random.default_rng(3)
    truth = random.uniform(20, 40, (60, 4))
    boxes = truth + random.normal(0, 8, truth.shape).clip(-15, 15)
    truth[::7] = np.nan
    errors, shares = centre_errors(boxes, truth), overlaps(boxes, truth)
    known = ~np.isnan(errors)
    assert np.allclose(precision_curve(errors), [np.mean(errors[known] <= radius) for radius in RADII])
    assert np.allclose(success_curve(shares), [np.mean(shares[known] > overlap) for overlap in OVERLAPS])


def test_success_is_the_area_under_its_curve() -> None:
    random = np.random.default_rng(4)
    truth = random.uniform(20, 40, (300, 4))
    boxes = truth + random.normal(0, 5, truth.shape).clip(-15, 15)
    curve = success_curve(overlaps(boxes, truth)[1:])
    area = float(np.mean((curve[1:] + curve[:-1]) / 2))
    assert accuracy(boxes, truth, np.ones(300, bool)).success == pytest.approx(area, abs=2e-3)


def test_a_perfect_track_has_perfect_figures() -> None:
    truth = np.random.default_rng(5).uniform(1, 50, (9, 4))
    figures = accuracy(truth, truth, np.ones(9, bool))
    assert (figures.centre_error, figures.precision, figures.lost) == (0, 1, 0)
    assert figures.success == pytest.approx(1)
