"""Can one see from a dance which genre it is? A plain classifier says.

It learns from the data's dances to songs of the training split, and is asked about unseen songs:
about the data's dances to them, and about a dancer's. Shares are means over genres, so that
chance is a fifth whatever the genres' frequencies are.

Features leave out accelerations: they would tell a network's dance from the data's, not a genre
from another.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

from data_synth.music.song import Song
from motiondiff_edu.metrics.bodies import standing_feet, travel
from motiondiff_edu.motion.root_frame import body_heading, to_root_frame
from motiondiff_edu.motion.skeleton import HIPS

from ..walks.scores import FPS, Measure, measure_of
from .floor import over_genres
from .songs import TRAINED

SEED = 1  # of the songs on which dancers are trained
SLOW = 0.01  # m/s: added to speeds before their logarithm is taken


def style_features(dance: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "F"]:
    """What a dance looks like, wherever it is and whichever way it faces.

    Mean pose and the spread of poses (metres), the logarithm of each joint's mean speed, the
    standing feet and the travel.
    """
    pelvis = dance[:, HIPS][:, [0, 2]]
    poses, _ = to_root_frame(dance, pelvis, body_heading(dance))
    speeds = np.linalg.norm(np.diff(dance, axis=0), axis=-1).mean(0) * FPS
    floor = [standing_feet(dance), travel(dance)]
    return np.concatenate(
        [poses.mean(0).ravel(), poses.std(0).ravel(), np.log(speeds + SLOW), floor]
    )


def windows_of(dances: Float[np.ndarray, "N T 21 3"]) -> Float[np.ndarray, "N W t 21 3"]:
    """Every dance in windows of the length of training, one after the other."""
    count = dances.shape[1] // TRAINED
    whole = dances[:, : count * TRAINED]
    return whole.reshape(len(dances), count, TRAINED, *dances.shape[2:])


def features_by_window(dances: Float[np.ndarray, "N T 21 3"]) -> Float[np.ndarray, "N W F"]:
    """`style_features` of every window of every dance."""
    return np.stack([np.stack([style_features(w) for w in row]) for row in windows_of(dances)])


class GenreJudge:
    """A linear classifier of genres: all have one (shrunk) covariance, and are equally likely."""

    def __init__(self, features: Float[np.ndarray, "N W F"], genres: np.ndarray):
        """Learn from the windows of N dances of these genres."""
        x = features.reshape(-1, features.shape[-1])
        self.mean, self.scale = x.mean(0), np.maximum(x.std(0), 1e-9)
        count = len(np.unique(genres))
        self.model = LinearDiscriminantAnalysis(
            solver="lsqr", shrinkage="auto", priors=np.full(count, 1 / count)
        )
        self.model.fit(self._standard(x), np.repeat(genres, features.shape[1]))

    def _standard(self, x: np.ndarray) -> np.ndarray:
        return (x - self.mean) / self.scale

    def right(
        self, features: Float[np.ndarray, "N W F"], genres: np.ndarray
    ) -> Float[np.ndarray, "N"]:
        """The share of each dance's windows whose genre is recognised."""
        n, count, width = features.shape
        said = self.model.predict(self._standard(features.reshape(-1, width)))
        return (said.reshape(n, count) == genres[:, None]).mean(1)


def judge_of(dances: Float[np.ndarray, "N T 21 3"], songs: Sequence[Song]) -> GenreJudge:
    """A judge that has learnt from the data's dances to these songs."""
    return GenreJudge(features_by_window(dances), np.array([song.genre for song in songs]))


def genre_measures(
    own: Float[np.ndarray, "N"], data: Float[np.ndarray, "N"], genres: np.ndarray
) -> list[Measure]:
    """The shares recognised of a dancer's and the data's dances, and their ratio.

    Rows are those of `GenreJudge.right`, one for each song.
    """
    return [
        measure_of("genre_accuracy", "share", over_genres, own, genres),
        measure_of("genre_accuracy_data", "share", over_genres, data, genres),
        measure_of("genre_accuracy_over_data", "ratio", _over, own, data, genres),
    ]


def _over(own, data, genres) -> float:
    return over_genres(own, genres) / over_genres(data, genres)
