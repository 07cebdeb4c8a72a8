"""FID: the distance between two sets of feature vectors, and how it depends on the number of clips.

FID compares two sets by their means and covariances alone. A covariance of D features needs many
more than D clips; the published table had 40 generated dances for 72 features. With few clips the
distance is too large, even between two halves of the data. So print `fid_floor` beside it.
Source: MoFusion 4.1 (FID), Table 1; for motion from text Guo and others, 2022.
Notebook: 14
"""

import warnings

import numpy as np
from jaxtyping import Float
from sklearn.covariance import ledoit_wolf


class FewSamplesWarning(UserWarning):
    """There are too few clips for so many features.

    Compare the value only with others from the same number of clips.
    """


def normalise(
    features: Float[np.ndarray, "*N F"], data: Float[np.ndarray, "M F"]
) -> Float[np.ndarray, "*N F"]:
    """(features - mean) / std, with the mean and population std of the *data's* features.

    A feature that is constant in the data is only shifted; otherwise rounding errors would be
    divided by rounding errors.
    Source: MoFusion 4.1, and the code it follows.  Notebook: 14
    """
    mean, std = data.mean(0), data.std(0)
    return (features - mean) / np.where(std > 1e-10 * np.maximum(np.abs(mean), 1e-10), std, 1.0)


def frechet_distance(
    mean_1: Float[np.ndarray, "F"],
    covariance_1: Float[np.ndarray, "F F"],
    mean_2: Float[np.ndarray, "F"],
    covariance_2: Float[np.ndarray, "F F"],
) -> float:
    """The squared Frechet distance of two Gaussians.

    d^2 = |m1 - m2|^2 + tr(C1 + C2 - 2 (C1^1/2 C2 C1^1/2)^1/2).

    The matrix under the root is symmetric, so its root comes from its eigenvalues: d^2 is real and
    never negative, even where C1 or C2 is singular. For covariances that commute it is
    |m1 - m2|^2 + |sqrt(l1) - sqrt(l2)|^2, with l the paired eigenvalues.
    Source: MoFusion 4.1.
    """
    values, vectors = np.linalg.eigh(covariance_1)
    root = (vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T
    middle = np.linalg.eigvalsh(root @ covariance_2 @ root)
    mixed = np.sqrt(np.maximum(middle, 0.0)).sum()
    distance = (
        ((mean_1 - mean_2) ** 2).sum() + np.trace(covariance_1) + np.trace(covariance_2) - 2 * mixed
    )
    return float(max(distance, 0.0))  # rounding can make a distance of 0 negative


def shrunk_covariance(features: Float[np.ndarray, "N F"]) -> Float[np.ndarray, "F F"]:
    """The covariance (divided by N), shrunk towards a multiple of the identity.

    C* = (1 - w) C + w (tr C / F) I, with the weight w of Ledoit and Wolf (2004).

    The weight is larger for fewer clips. C* is singular only if all clips are equal.
    """
    return ledoit_wolf(features)[0]


def fid(generated: Float[np.ndarray, "N F"], data: Float[np.ndarray, "M F"]) -> float:
    """Frechet distance between the features of generated clips and those of the data.

    Both sets are normalised by the data; the covariances are unbiased. Unless both sets have more
    clips than features, the value is much too large and a FewSamplesWarning says so: compare it
    only with `fid_floor` for the same number of clips.
    Raises ValueError for fewer than two clips or features that are not finite.
    Source: MoFusion 4.1.   Notebook: 14
    """
    generated, data = _checked(generated, data)
    if min(len(generated), len(data)) <= data.shape[1]:
        warnings.warn(
            (
                f"{len(generated)} and {len(data)} clips for {data.shape[1]} features: "
                "more clips than features are needed"
            ),
            FewSamplesWarning,
            stacklevel=2,
        )
    parts = [part for x in (generated, data) for part in (x.mean(0), _covariance(x))]
    return frechet_distance(*parts)


def shrunk_fid(generated: Float[np.ndarray, "N F"], data: Float[np.ndarray, "M F"]) -> float:
    """`fid` with `shrunk_covariance`: less noise and bias for few clips, but not the published FID.

    Raises ValueError for fewer than two clips or features that are not finite.  Notebook: 14
    """
    generated, data = _checked(generated, data)
    return frechet_distance(
        generated.mean(0), shrunk_covariance(generated), data.mean(0), shrunk_covariance(data)
    )


def fid_floor(
    data: Float[np.ndarray, "M F"], n: int, rng: np.random.Generator, distance=fid, times: int = 10
) -> tuple[float, float]:
    """The FID of a perfect generator: n random clips of the data against all other clips.

    Returns the mean and standard deviation over `times` draws. A generator whose n clips reach this
    mean cannot be distinguished from the data. `distance` is `fid`, `shrunk_fid` ...
    Raises ValueError unless both sides have two clips.  Notebook: 14
    """
    if not 2 <= n <= len(data) - 2:
        raise ValueError(
            f"{n} of {len(data)} clips cannot be compared with the others: "
            "two are needed on both sides"
        )
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FewSamplesWarning)
        for _ in range(times):
            order = rng.permutation(len(data))
            found.append(distance(data[order[:n]], data[order[n:]]))
    return float(np.mean(found)), float(np.std(found))


def _covariance(features: np.ndarray) -> np.ndarray:
    """The unbiased covariance; it is a matrix for a single feature, too."""
    return np.atleast_2d(np.cov(features.T))


def _checked(generated: np.ndarray, data: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    for name, features in (("generated", generated), ("data's", data)):
        if len(features) < 2:
            raise ValueError(
                f"a covariance needs at least 2 clips; the {name} features have {len(features)}"
            )
        if not np.isfinite(features).all():
            bad = int(np.flatnonzero(~np.isfinite(features).all(1))[0])
            raise ValueError(f"row {bad} of the {name} features is not finite: check that clip")
    return normalise(generated, data), normalise(data, data)
