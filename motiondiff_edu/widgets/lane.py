"""The music lane under the figure: the sound, its beats, and the strips above and below it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..viz import body
from .listening import Listening, Strips
from .sound import Sound, as_sound, as_times, waveform

PURPLE, GREEN = "#CC79A7", "#009E73"
# pixels
TICKS = 14
WAVE = 56
AXIS = 20
CURVE = 36


@dataclass(frozen=True, eq=False)
class Lane:
    """A sound for `frames` frames of motion, its beats and downbeats (seconds), and strips."""

    sound: Sound
    beats: list[float]
    downbeats: list[float]
    strips: Strips
    frames: int
    fps: float

    @property
    def description(self) -> str:
        """The alternative text: one sentence about the music and its strips."""
        beats = f"{len(self.beats)} beats marked" if self.beats else ""
        said = [
            f"Music: {self.sound.seconds:.1f} s, its waveform below the figure",
            beats,
            self.strips.words(),
        ]
        return "; ".join(filter(None, said)) + "."

    @property
    def height(self) -> int:
        """The height of the lane in the page in pixels, with the line of text below it."""
        more = bool(self.strips.levels) or self.strips.moved is not None
        return 96 + 36 * more + (54 if self.strips.moved is not None else 0)

    def traits(self) -> tuple[bytes, bytes, dict]:
        """The page's data: the sound file, bytes of waveform and attention, and their record."""
        wave = waveform(self.sound.samples)
        record = {
            "mime": self.sound.mime,
            "seconds": self.frames / self.fps,
            "fps": self.fps,
            "frames": self.frames,
            "peaks": len(wave),
            "beats": self.beats,
            "downbeats": self.downbeats,
            "description": self.description,
            **self.strips.record(),
        }
        return self.sound.data, wave.tobytes() + self.strips.codes(), record

    def under(self, picture: Image.Image) -> Image.Image:
        """The picture with the lane below it; attention is drawn as its mean over the motion."""
        width, moved = picture.width, self.strips.moved
        height = TICKS + WAVE + AXIS + (0 if moved is None else CURVE)
        whole = Image.new("RGB", (width, picture.height + height), body.PAPER)
        whole.paste(picture, (0, 0))
        pen, top = ImageDraw.Draw(whole), picture.height + TICKS

        def across(t):
            return np.clip(np.asarray(t) / (self.frames / self.fps), 0, 1) * width

        if self.strips.levels:
            level = self.strips.levels[0]
            mean, ends = level.weights().mean(0), across(level.edges)
            for k, share in enumerate(mean / mean.max()):
                box = [ends[k], top, max(ends[k], ends[k + 1] - 1), top + WAVE]
                pen.rectangle(box, fill=body.mix(PURPLE, body.PAPER, 1 - float(share)))
        for x, low_high in enumerate(waveform(self.sound.samples, width)):
            low, high = (WAVE / 2 * (1 - v / 127) for v in low_high[::-1].astype(float))
            pen.line([x, top + low, x, top + high], fill=body.INK)
        for times, tall, wide in ((self.beats, 5, 1), (self.downbeats, 12, 2)):
            for x in across(times):
                pen.line([x, top - 1 - tall, x, top - 1], fill=body.INK, width=wide)
        if moved is not None:
            foot = whole.height - 1
            x = (np.arange(len(moved)) + 0.5) / len(moved) * width
            curve = np.stack([x, foot - moved / max(moved.max(), 1e-6) * (CURVE - 4)], 1)
            outline = [(0, foot), *map(tuple, curve), (width, foot)]
            pen.polygon(outline, fill=body.mix(GREEN, body.PAPER, 0.5), outline=GREEN)
        font = ImageFont.load_default(13)
        pen.text((6, top + WAVE + 3), "0 s", fill=body.INK, font=font)
        pen.text(
            (width - 6, top + WAVE + 3),
            f"{self.sound.seconds:.1f} s",
            fill=body.INK,
            font=font,
            anchor="ra",
        )
        return whole


@dataclass(frozen=True, eq=False)
class Soundtrack:
    """What is played with a motion, and what is drawn around its waveform.

    `audio`: (N,) from -1 to 1 with their `sample_rate` in Hz, or the bytes of a sound file.
    `beats`, `downbeats`: marked, seconds.
    `codec`: "ogg", "flac" or "wav", as the page gets it.
    `listening`: what a network reads of it.
    """

    audio: Any
    beats: Any = None
    downbeats: Any = None
    sample_rate: int | None = None
    codec: str = "ogg"
    listening: Listening | None = None


def of(audio, frames: int, fps: float) -> Lane | None:
    """The lane of a sound or Soundtrack under a motion of so many frames; None without a sound.

    Raises ValueError for a Soundtrack without audio, and where `as_sound`, `as_times` and
    `Listening.strips` do.
    """
    if audio is None:
        return None
    track = audio if isinstance(audio, Soundtrack) else Soundtrack(audio)
    if track.audio is None:
        raise ValueError("beats and attention are drawn over a waveform: pass `audio` too")
    seconds = frames / fps
    sound = as_sound(track.audio, track.sample_rate, seconds, track.codec)
    beats, downbeats = (as_times(getattr(track, n), n, seconds) for n in ("beats", "downbeats"))
    strips = track.listening.strips(frames) if track.listening else Strips()
    return Lane(sound, beats, downbeats, strips, frames, fps)
