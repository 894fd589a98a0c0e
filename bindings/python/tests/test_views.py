"""Looking inside a tracker through numpy."""

import gc
import tracemalloc
from typing import Any

import numpy as np
import pytest

from asttrack import Tracker, subspace_distance, subspace_fit
from short_scene import BOXES, FRAMES


def tracked(count: int = 12, preset: str = "paper", **config: Any) -> Tracker:
    """A tracker after `count` updates; patches that are not square, bag and history rings that have gone round."""
    tracker = Tracker(preset, patch_width=12, patch_height=10, bag_interval=1, bag_size=4, particles=64, **config)
    tracker.init(FRAMES[0], BOXES[0])
    for frame in FRAMES[1 : count + 1]:
        tracker.update(frame)
    return tracker


def test_particles() -> None:
    tracker = tracked()
    particles = tracker.particles
    for array in (particles.x, particles.y, particles.scale, particles.weight):
        assert array.shape == (64,)
        assert array.dtype == np.dtype(np.float32)
    assert particles.weight.sum() == pytest.approx(1, abs=1e-5)
    assert particles.distance is not None
    assert particles.distance.shape == (64, 4)
    assert (particles.distance >= 0).all()
    best = int(particles.distance.min(axis=1).argmin())
    assert particles.weight[best] > 1 / 64


def test_distances_are_there_from_the_first_update() -> None:
    before = tracked(0).particles
    assert before.distance is None
    after = tracked(1).particles
    assert after.distance is not None
    assert after.distance.shape == (64, 1)


def test_distances_are_the_shortlists() -> None:
    tracker = Tracker("robust", particles=64, shortlist=20)
    tracker.init(FRAMES[0], BOXES[0])
    rows = []
    for frame in FRAMES[1:9]:
        models = len(tracker.bag)
        result = tracker.update(frame)
        particles = tracker.particles
        assert particles.distance is not None
        scored = len(particles.distance)
        assert particles.distance.shape == (20 if models else 64, max(models, 1))
        assert particles.weight.shape == (64,)
        assert particles.weight[:scored].sum() == pytest.approx(1, abs=1e-5)
        assert not particles.weight[scored:].any()
        assert result.best < scored
        assert result.distance == particles.distance[result.best].min()
        rows.append(scored)
    assert set(rows) == {20, 64}  # the bag has its first model on the way


def test_history_is_oldest_first() -> None:
    tracker = tracked(7)
    before = [vector.copy() for vector in tracker.history]
    assert [vector.shape for vector in before] == [(120,)] * 3
    tracker.update(FRAMES[8])
    after = tracker.history
    np.testing.assert_array_equal(after[0], before[1])
    np.testing.assert_array_equal(after[1], before[2])
    assert (after[2] != before[2]).any()
    assert np.stack(after).shape == (3, 120)


def test_patches_are_upright_pictures() -> None:
    ramp = np.tile(np.arange(160, dtype=np.uint8), (120, 1))  # brighter to the right
    tracker = Tracker("tiny", patch_width=12, patch_height=10)
    tracker.init(ramp, (40, 40, 24, 20))
    (vector,) = tracker.history
    patch = tracker.patch(vector)
    assert patch.shape == (10, 12)
    assert np.shares_memory(patch, vector)
    assert (np.diff(patch, axis=1) > 0).all()
    assert np.abs(np.diff(patch, axis=0)).max() < 1e-6


def test_a_patch_is_the_head_of_a_longer_vector() -> None:
    tracker = Tracker("robust", patch_weight=2.0, gradient_weight=1.5, normalisation="unit")
    tracker.init_sequence(FRAMES[:3], BOXES[:3])
    settings = tracker.config
    model = tracker.bag[0]
    for vector in (*tracker.history, model.mean, model.basis[:, 0]):
        assert vector.shape == (tracker.feature_length,)
        patch = tracker.patch(vector)
        assert patch.shape == (settings["patch_height"], settings["patch_width"])
        assert patch.size < vector.size
    for vector in tracker.history:
        assert np.linalg.norm(tracker.patch(vector)) == pytest.approx(2, rel=0.01)  # unit norm, but for 1/255, times its weight
        assert np.linalg.norm(vector[tracker.patch(vector).size :]) == pytest.approx(1.5, rel=0.05)


def test_what_has_no_patch_says_so() -> None:
    tracker = Tracker("robust", patch_weight=0.0)
    tracker.init_sequence(FRAMES[:3], BOXES[:3])
    with pytest.raises(ValueError, match="have no grey patch: patch_weight is 0"):
        tracker.patch(tracker.history[0])
    with pytest.raises(ValueError, match=rf"is \({tracker.feature_length},\), not \(5,\)"):
        tracker.patch(np.zeros(5, np.float32))


def test_the_bag_is_oldest_first_and_orthonormal() -> None:
    tracker = tracked(9, keep_first="no")
    before = [model.mean.copy() for model in tracker.bag]
    tracker.update(FRAMES[10])
    after = tracker.bag
    assert len(after) == 4
    np.testing.assert_array_equal([model.mean for model in after[:3]], before[1:])
    for model in after:
        assert (model.mean.shape, model.basis.shape) == ((120,), (120, 3))
        present = model.basis[:, : model.rank].astype(np.float64)
        np.testing.assert_allclose(present.T @ present, np.eye(model.rank), atol=1e-5)
        assert not model.basis[:, model.rank :].any()


def test_the_newest_model_is_the_fit_of_the_history() -> None:
    tracker = tracked(9)
    model = tracker.bag[-1]
    fitted = subspace_fit([*tracker.history])
    # The history has moved on by the patch that the model was fitted with, so it is the model's last three of four.
    assert model.mean.shape == fitted.mean.shape
    assert subspace_distance(model, fitted, 1.0).mahalanobis < subspace_distance(tracker.bag[0], fitted, 1.0).mahalanobis
    assert subspace_distance(model, model, 1.0).distance == pytest.approx(0, abs=1e-2)


def test_views_are_read_only_for_good() -> None:
    tracker = tracked()
    particles = tracker.particles
    model = tracker.bag[0]
    assert particles.distance is not None
    for view in (particles.x, particles.weight, particles.distance, model.mean, model.basis, tracker.history[0]):
        with pytest.raises(ValueError, match="read-only"):
            view[...] = 0
        with pytest.raises(ValueError, match="WRITEABLE"):
            view.flags.writeable = True


def test_views_show_the_trackers_memory() -> None:
    tracker = tracked()
    x = tracker.particles.x
    kept = x.copy()
    tracker.update(FRAMES[13])
    assert (x != kept).any()
    np.testing.assert_array_equal(x, tracker.particles.x)


def test_views_outlive_the_tracker() -> None:
    tracker = tracked()
    particles, bag, history = tracker.particles, tracker.bag, tracker.history
    weight, mean, patch = particles.weight.copy(), bag[0].mean.copy(), history[0].copy()
    tracker.close()
    del tracker, particles
    gc.collect()
    scribble = [np.full(100_000, 255, np.uint8) for _ in range(50)]  # would land where freed memory was
    np.testing.assert_array_equal(bag[0].mean, mean)
    np.testing.assert_array_equal(history[0], patch)
    assert weight.sum() == pytest.approx(1, abs=1e-5)
    assert len(scribble) == 50


def test_memory_goes_when_the_last_view_goes() -> None:
    tracemalloc.start()
    try:
        tracker = tracked(2)
        size = tracker.memory_size
        view = tracker.particles.x
        gc.collect()
        held = tracemalloc.get_traced_memory()[0]
        tracker.close()
        del tracker
        gc.collect()
        assert tracemalloc.get_traced_memory()[0] > held - size / 2
        del view
        gc.collect()
        assert tracemalloc.get_traced_memory()[0] < held - size / 2
    finally:
        tracemalloc.stop()


def test_updates_do_not_allocate_more_and_more() -> None:
    tracker = tracked(2)
    colour = [np.dstack([frame] * 3) for frame in FRAMES]
    for frame in colour:
        tracker.update(frame)
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(20):
            for frame in colour:
                tracker.update(frame)
        gc.collect()
        assert tracemalloc.get_traced_memory()[0] - before < 5_000
    finally:
        tracemalloc.stop()
