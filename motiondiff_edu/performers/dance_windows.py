"""Training windows of dance: seconds of motion, with the music of the same seconds.

Motion has 20 frames a second, the Mel spectrogram 31.25. Both have a frame at the same moment only
every 0.8 s. Windows start there, so that the Mel frames have the same times in every window.
Source: MoFusion 4.1; lengths are ours, for the paper gives only those of its dances, 7.4 to 48 s.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor

from ..conditions.music import frame_times
from ..motion.dance_frame import mirror, to_features, to_positions
from ..motion.motion import Motion, MotionError, MotionWarning
from ..motion.planting import find_contacts
from ..motion.scaler import Scaler
from ..motion.skeleton import TOES

FPS, D = 20.0, 63
FITTED = 5000  # at most so many windows are used to fit the motion's scaler
MOTION_GRID, MEL_GRID = 16, 25  # frames in 0.8 s


def mel_frames(n: int) -> int:
    """How many Mel frames lie within n frames of motion, including the one at the start."""
    return n * MEL_GRID // MOTION_GRID + 1


def warn_of_short(short: int, dances: int, n: int) -> None:
    """Say how many dances are shorter than a window of n frames."""
    warnings.warn(
        f"{short} of {dances} dances are left out: with their music they are shorter than a window "
        f"of {n} frames, {n / FPS:g} s",
        MotionWarning,
        stacklevel=3,
    )


@dataclass(frozen=True, eq=False)
class DanceWindows:
    """Windows of n frames, standardised, with the Mel frames and the contacts of the same seconds.

    Windows 2k and 2k + 1 are the same seconds, the second one mirrored. Windows overlap and would
    need a dozen times the memory of the dances, so each is cut when it is taken.
    """

    n: int
    dances: Float[Tensor, "F 21 3"]  # of all dances, one after the other; metres
    contacts: Bool[Tensor, "F 2"]
    starts: Int[Tensor, "K"]  # in `dances`
    mel: Float[Tensor, "G C"]  # of all songs, one after the other, standardised
    song_starts: Int[Tensor, "K"]  # in `mel`
    motion_scaler: Scaler
    mel_scaler: Scaler

    @classmethod
    def of(
        cls,
        dances: Sequence[Float[np.ndarray, "_ 21 3"]],
        contacts: Sequence[Bool[np.ndarray, "_ 2"]],
        mels: Sequence[Float[Tensor, "_ C"]] | None,
        n: int = 100,
    ) -> "DanceWindows":
        """Windows of dances and the log-Mel of their songs.

        Consecutive dances with the same tensor in `mels` share it. `mels=None` is for motion
        without music, C = 0.
        Warns with the number of dances that are shorter than a window: they are left out.
        Raises ValueError when no dance is long enough, or lists or lengths do not match.
        """
        mels = (
            [torch.zeros(mel_frames(len(dance)), 0) for dance in dances] if mels is None else mels
        )
        if not len(dances) == len(contacts) == len(mels):
            raise ValueError(
                f"{len(dances)} dances, {len(contacts)} contacts and {len(mels)} songs: "
                "each dance needs its contacts and its song"
            )
        lengths = enumerate(zip(map(len, dances), map(len, contacts), strict=True))
        uneven = next(((k, *both) for k, both in lengths if both[0] != both[1]), None)
        if uneven:
            raise ValueError(
                "dance {} has {} frames but contacts for {}; each frame needs one".format(*uneven)
            )
        starts = []
        song_starts = []
        songs = []
        short = 0
        first = 0
        song = 0
        for dance, mel in zip(dances, mels, strict=True):
            if not songs or mel is not songs[-1]:
                song += len(songs[-1]) if songs else 0
                songs.append(mel)
            last = min(len(dance) - n, (len(mel) - mel_frames(n)) // MEL_GRID * MOTION_GRID)
            short += last < 0
            starts += range(first, first + last + 1, MOTION_GRID)
            song_starts += (
                range(song, song + last // MOTION_GRID * MEL_GRID + 1, MEL_GRID)
                if last >= 0
                else ()
            )
            first += len(dance)
        if not starts:
            raise ValueError(f"no dance has {n} frames with music")
        if short:
            warn_of_short(short, len(dances), n)
        positions = torch.from_numpy(np.concatenate(dances)).float()
        stands, mel = torch.from_numpy(np.concatenate(contacts)), torch.cat(songs).float()
        units = Scaler.fit(mel) if mel.shape[1] else Scaler.nothing(0)
        at = torch.tensor(starts), torch.tensor(song_starts)
        raw = cls(
            n, positions, stands, at[0], units.transform(mel), at[1], Scaler.nothing(D), units
        )
        some = torch.linspace(0, len(raw) - 1, min(len(raw), FITTED)).long()
        return replace(raw, motion_scaler=Scaler.fit(raw.take(some)[0]))

    @classmethod
    def of_motions(
        cls,
        motions: Sequence[Motion],
        mels: Sequence[Float[Tensor, "_ C"]] | None = None,
        n: int = 100,
    ) -> "DanceWindows":
        """Windows of motions and the log-Mel of their songs, which begin with their first frames.

        `mels` as in `of`.
        Contacts are found where a motion has none.
        Raises MotionError for a motion at another rate than 20 frames/s, with missing joints or
        with another skeleton, and ValueError as `of`.
        """
        for motion in motions:
            motion.check_whole()
            if motion.fps != FPS:
                raise MotionError(
                    f"{motion.name} has {motion.fps:g} frames/s: pass motion.resampled({FPS:g})"
                )
        dances = [motion.positions for motion in motions]
        contacts = [
            find_contacts(one.positions[:, list(TOES)], FPS)
            if one.contacts is None
            else one.contacts
            for one in motions
        ]
        return cls.of(dances, contacts, mels, n)

    def __len__(self) -> int:
        return 2 * len(self.starts)

    @property
    def mel_times(self) -> Float[Tensor, "M"]:
        """The times of a window's Mel frames, in seconds from its first frame."""
        return frame_times(mel_frames(self.n)).float()

    def take(
        self, chosen: Int[Tensor, "B"]
    ) -> tuple[Float[Tensor, "B T D"], Float[Tensor, "B M C"], Bool[Tensor, "B T 2"]]:
        """The windows with these indices: motion, music, and which feet are planted."""
        k, mirrored = chosen // 2, chosen % 2 == 1
        frames = self.starts[k][:, None] + torch.arange(self.n)
        positions, stands = self.dances[frames].double().numpy(), self.contacts[frames]
        positions[mirrored.numpy()] = mirror(positions[mirrored.numpy()])
        motion = torch.from_numpy(to_features(positions)).float()
        music = self.mel[self.song_starts[k][:, None] + torch.arange(mel_frames(self.n))]
        return (
            self.motion_scaler.transform(motion),
            music,
            stands.where(~mirrored[:, None, None], stands.flip(-1)),
        )

    def draw(
        self, batch: int, generator: torch.Generator
    ) -> tuple[Float[Tensor, "B T D"], Float[Tensor, "B M C"], Bool[Tensor, "B T 2"]]:
        """A random batch: motion, music, and which feet are planted."""
        return self.take(torch.randint(len(self), (batch,), generator=generator))


def toes_moved(windows: DanceWindows, samples: int = 1000) -> float:
    """The mean square change of a toe's coordinate from one frame of the data to the next, in m^2.

    Raises ValueError if no toe moves.
    """
    some = torch.linspace(0, len(windows) - 1, min(len(windows), samples)).long()
    positions = to_positions(windows.motion_scaler.inverse(windows.take(some)[0]))
    moved = float(positions[:, :, list(TOES)].diff(dim=1).square().mean())
    if not moved:
        raise ValueError("no toe moves in these windows, so errors of feet cannot be scaled")
    return moved
