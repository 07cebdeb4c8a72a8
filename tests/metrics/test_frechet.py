"""FID: closed forms, the roots of scipy, shrinkage by hand, and what few clips do."""

import warnings

import numpy as np
import pytest
from scipy.linalg import sqrtm

from motiondiff_edu.metrics.distributions import (
    FewSamplesWarning,
    diversity,
    fid,
    fid_floor,
    frechet_distance,
    multimodality,
    normalise,
    shrunk_covariance,
    shrunk_fid,
)


def cloud(n, width=5, seed=0):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, width)) @ np.random.default_rng(99).normal(size=(width, width)) + 2.0


def test_commuting_covariances_have_the_distance_of_their_roots():
    axes = np.linalg.qr(np.random.default_rng(3).normal(size=(4, 4)))[0]
    first = np.array([4.0, 1.0, 0.25, 0.0])
    second = np.array([1.0, 9.0, 0.25, 4.0])
    apart = np.array([1.0, 0.0, 2.0, 0.0])
    distance = frechet_distance(np.zeros(4), axes * first @ axes.T, apart, axes * second @ axes.T)
    assert distance == pytest.approx(5 + (2 - 1) ** 2 + (1 - 3) ** 2 + 0 + 2**2)


def test_covariances_that_do_not_commute_agree_with_scipys_root():
    first = np.cov(cloud(50).T)
    second = np.cov(cloud(70, seed=1)[:, ::-1].T)
    wanted = 3.0 + np.trace(first + second - 2 * sqrtm(first @ second)).real
    assert frechet_distance(
        np.zeros(5), first, np.array([1.0, 1, 1, 0, 0]), second
    ) == pytest.approx(wanted)


def test_numbers_one_by_one_in_one_dimension():
    # the data: mean 2, population std 1
    data = np.array([[1.0], [3.0]])
    generated = np.array([[2.0], [8.0]])
    assert fid(generated, data) == pytest.approx(3.0**2 + (np.sqrt(18.0) - np.sqrt(2.0)) ** 2)


def test_a_single_feature_has_a_distance_in_every_form():
    """Of numbers: (m1 - m2)^2 + (s1 - s2)^2, in units of the data's deviation."""
    generated = np.array([[1.0], [2.0], [6.0], [3.0]])
    data = np.array([[0.0], [4.0], [5.0]])
    unbiased = [x.std(ddof=1) / data.std() for x in (generated, data)]
    wanted = ((generated.mean() - data.mean()) / data.std()) ** 2 + (unbiased[0] - unbiased[1]) ** 2
    assert fid(generated, data) == pytest.approx(wanted)


def test_equal_clouds_are_at_distance_nought_and_a_shift_is_counted_in_the_datas_deviations():
    data = cloud(60)
    assert abs(fid(data, data)) < 1e-9
    shifted = data + 2 * data.std(0) * [1, 0, 0, 0, 0]
    assert fid(shifted, data) == pytest.approx(4.0) and shrunk_fid(shifted, data) == pytest.approx(
        4.0
    )


def test_features_are_normalised_by_the_data():
    data = np.array([[1.0, 10.0], [3.0, 10.0]])
    np.testing.assert_allclose(
        normalise(np.array([[4.0, 11.0]]), data), [[2.0, 1.0]]
    )  # the second never changes


def published_fid(generated: np.ndarray, data: np.ndarray) -> complex:
    """FID as the public code has it: scipy's root of C1 C2, which is not symmetric, taken as it
    comes."""
    ours, theirs = (np.cov(normalise(x, data).T) for x in (generated, data))
    apart = normalise(generated, data).mean(0) - normalise(data, data).mean(0)
    return complex((apart**2).sum() + np.trace(ours + theirs - 2 * sqrtm(ours @ theirs)))


def test_the_published_root_has_an_imaginary_part_and_the_mended_one_agrees_without():
    few, data = cloud(40, width=63), cloud(30, width=63, seed=1)
    published = published_fid(few, data)
    assert published.imag != 0
    with pytest.warns(FewSamplesWarning, match="40 and 30 clips for 63 features"):
        assert fid(few, data) == pytest.approx(published.real, rel=1e-5)


def test_enough_clips_do_not_warn():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fid(cloud(6), cloud(7, seed=1))


def test_few_clips_of_the_very_same_kind_score_badly_and_shrinkage_helps():
    data = cloud(1000, width=24)
    floors = {n: fid_floor(data, n, np.random.default_rng(2), times=4)[0] for n in (12, 50, 400)}
    assert floors[12] > 3 * floors[50] > 12 * floors[400]
    shrunk = fid_floor(data, 12, np.random.default_rng(2), distance=shrunk_fid, times=4)[0]
    assert shrunk < 0.8 * floors[12]


@pytest.mark.parametrize("features", [cloud(37), cloud(12, width=25)], ids=["many", "few"])
def test_the_covariance_is_shrunk_as_ledoit_and_wolf_say(features):
    """Their equations: weight = b^2 / d^2, where b^2 is the mean of |x x^T - C|^2 / n, at most
    d^2 = |C - m I|^2."""
    x = features - features.mean(0)
    n, width = x.shape
    C = x.T @ x / n
    m = np.trace(C) / width
    d2 = np.square(C - m * np.eye(width)).sum()
    b2 = min(sum(np.square(np.outer(row, row) - C).sum() for row in x) / n**2, d2)
    wanted = b2 / d2 * m * np.eye(width) + (1 - b2 / d2) * C
    assert 0 < b2 / d2 < 1
    np.testing.assert_allclose(shrunk_covariance(features), wanted, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    "generated, told",
    [
        (cloud(1), "generated features have 1"),
        (np.where(cloud(9) > -1e9, np.nan, 0.0), "row 0 of the generated"),
    ],
)
def test_what_has_no_covariance_is_refused(generated, told):
    with pytest.raises(ValueError, match=told):
        fid(generated, cloud(9))


def test_a_floor_needs_clips_on_both_sides():
    with pytest.raises(ValueError, match="two are needed on both sides"):
        fid_floor(cloud(9), 8, np.random.default_rng(0))


def test_diversity_is_the_mean_distance_of_all_pairs():
    corners = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])  # sides 3, 4, 5
    assert diversity(corners) == pytest.approx(4.0)
    assert np.asarray(diversity(np.stack([corners, 2 * corners]))) == pytest.approx(
        np.array([4.0, 8.0])
    )
    assert diversity(np.zeros((7, 3))) == 0
    with pytest.raises(ValueError, match="at least 2 motions, not 1"):
        diversity(corners[:1])


def test_multimodality_looks_within_each_song_alone():
    corners = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])
    far_apart = np.stack([corners, corners + 1000.0])
    assert (
        multimodality(far_apart) == pytest.approx(4.0) and diversity(far_apart.reshape(6, 2)) > 800
    )


def test_diversity_of_normal_features_is_the_known_one():
    # the distance of two standard normal vectors: sqrt(2) times a chi variable of 63 degrees
    features = np.random.default_rng(4).normal(size=(300, 63))
    chi = np.sqrt(63) * (1 - 1 / (4 * 63) + 1 / (32 * 63**2))
    assert diversity(features) == pytest.approx(np.sqrt(2) * chi, rel=0.01)
