"""A judge of genres: it knows what it has learnt, and shuffled labels teach it nothing."""

import numpy as np
import pytest
from gaits import rest_pose

from tools.results.dances.genres import (
    GenreJudge,
    features_by_window,
    genre_measures,
    style_features,
    windows_of,
)

GENRES = np.array(["house", "latin", "pop", "waltz"] * 15)


def hand_made(genres: np.ndarray, seed: int, frames: int = 200) -> np.ndarray:
    """Figures that stand still and wave their right hand, at a height that is the genre's."""
    rng = np.random.default_rng(seed)
    dances = np.tile(rest_pose(), (len(genres), frames, 1, 1))
    height = {genre: 0.1 * k for k, genre in enumerate(sorted(set(genres)))}
    t = np.arange(frames) / 20
    for dance, genre in zip(dances, genres, strict=True):
        dance[:, 19, 1] += height[genre] + 0.05 * np.sin(2 * np.pi * t + rng.uniform(0, 6))
        dance += 0.002 * rng.normal(size=dance.shape)
    return dances


def test_windows_are_of_the_length_of_training_and_lose_nothing():
    dances = hand_made(GENRES[:2], 0)
    windows = windows_of(dances)
    assert windows.shape == (2, 2, 100, 21, 3)
    assert np.array_equal(windows[1, 1], dances[1, 100:])
    assert windows_of(dances[:, :150]).shape[1] == 1


def test_features_know_neither_the_place_nor_the_direction():
    dance = hand_made(GENRES[:1], 0)[0]
    turned = dance[..., [2, 1, 0]] * [1, 1, -1] + [3.0, 0.0, -2.0]  # a quarter turn, elsewhere
    np.testing.assert_allclose(style_features(turned), style_features(dance), atol=1e-9)


def test_what_differs_is_recognised_in_dances_not_seen():
    judge = GenreJudge(features_by_window(hand_made(GENRES, 1)), GENRES)
    assert judge.right(features_by_window(hand_made(GENRES, 2)), GENRES).mean() > 0.95
    wrong = np.roll(GENRES, 1)
    assert judge.right(features_by_window(hand_made(GENRES, 2)), wrong).mean() < 0.05


def test_shuffled_labels_give_chance():
    features, unseen = (features_by_window(hand_made(GENRES, seed)) for seed in (1, 2))
    shares = []
    for seed in range(20):
        labels = np.random.default_rng(seed).permutation(GENRES)
        shares.append(GenreJudge(features, labels).right(unseen, GENRES).mean())
    assert np.mean(shares) == pytest.approx(0.25, abs=0.08)


def test_a_frequent_genre_is_not_favoured():
    many = np.array(["house"] * 40 + ["pop"] * 8)
    judge = GenreJudge(features_by_window(hand_made(many, 1)), many)
    assert judge.model.priors == pytest.approx([0.5, 0.5])
    # the mean is over genres: always saying the frequent one gets a half, not five sixths
    own, data = (many == "house").astype(float), np.ones(48)
    found = {one.name: one.value for one in genre_measures(own, data, many)}
    assert found["genre_accuracy"] == pytest.approx(0.5) == found["genre_accuracy_over_data"]
    assert found["genre_accuracy_data"] == 1
