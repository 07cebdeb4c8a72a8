"""Films (.mp4): pictures go to ffmpeg, a program of its own, and its result is read again.

An encoder can fail late, on a full disk for example, after every picture was taken. So a film gets
its name only after ffmpeg has ended without an error and every picture can be read back.
"""

import os
import subprocess
import tempfile
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from threading import Timer

import numpy as np
from PIL import Image

from .._files import check_writable, replacing
from . import sound
from .sound import Sound

PATIENCE = 120  # seconds for one picture, or for the end of a film: a busy machine needs a second
QUALITY = "25"  # crf of H.264: 0 loses nothing, 51 is the worst


class FilmError(OSError):
    """A film could not be written; the message has the last words of the encoder."""


def write_mp4(
    path: str | os.PathLike,
    pictures: Iterable[Image.Image],
    size: tuple[int, int],
    fps: float,
    music: Sound | None = None,
) -> Path:
    """Write pictures of `size` pixels as MP4, with a sound.

    Raises ImportError without imageio-ffmpeg, OSError for a place where no file can be made, and
    FilmError if ffmpeg fails, does not answer, or leaves a film that cannot be read; a film that
    was there before is still there.
    """
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise ImportError("save_mp4 needs the package imageio-ffmpeg; save_gif does not") from error
    path = Path(path).expanduser()
    check_writable(path)
    with replacing(path) as part, tempfile.TemporaryDirectory() as folder:
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-v", "error"]
        command += ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}"]
        command += ["-r", str(Fraction(fps).limit_denominator()), "-i", "-"]
        if music is not None:
            file = Path(folder) / "sound.wav"
            file.write_bytes(sound.encode(music.samples, music.sample_rate, "wav")[0])
            command += ["-i", str(file), "-map", "0:v:0", "-map", "1:a:0", "-c:a", "aac"]
        # players need yuv420p, which needs even sizes
        command += ["-vf", "scale=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]
        command += ["-crf", QUALITY, "-f", "mp4", str(part)]
        try:
            written = _encode(command, pictures)
            _check_readable(part, written)
        except FilmError as error:
            words = str(error).replace(str(part), str(path))
            kept = "; the film that was there is kept" if path.exists() else ""
            raise FilmError(f"{path} was not written{kept}. {words}") from None
    return path


def _encode(command: list[str], pictures: Iterable[Image.Image]) -> int:
    """Send the pictures to ffmpeg; returns how many.  Raises FilmError unless it ends well."""
    encoder = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    count, complete = 0, True
    try:
        for picture in pictures:
            count += 1
            complete = _send(encoder, picture)
            if not complete:
                break
        try:
            words = encoder.communicate(timeout=PATIENCE)[1].decode(errors="replace")
        except subprocess.TimeoutExpired:
            raise FilmError(f"The encoder (ffmpeg) did not end within {PATIENCE} s") from None
    finally:
        encoder.kill()  # nothing happens to one that has ended
        encoder.wait()
    if encoder.returncode or not complete:
        lines = words.strip().splitlines() or ["none"]
        raise FilmError(
            f"The encoder (ffmpeg) ended with status {encoder.returncode} at picture {count}; its "
            f"last words: {' / '.join(lines[-3:])}"
        )
    return count


def _send(encoder: subprocess.Popen, picture: Image.Image) -> bool:
    """Give ffmpeg a picture; False if it has ended.  It is killed if it takes nothing."""
    stuck = Timer(PATIENCE, encoder.kill)
    stuck.start()
    try:
        encoder.stdin.write(np.ascontiguousarray(picture))
        encoder.stdin.flush()
    except OSError:  # Windows has no BrokenPipeError
        return False
    finally:
        stuck.cancel()
    return True


def _check_readable(film: Path, written: int) -> None:
    """Raise FilmError unless the film has as many pictures as were written, within one."""
    import imageio_ffmpeg

    try:
        found = imageio_ffmpeg.count_frames_and_secs(film)[0]
    except RuntimeError as error:
        *_, why = str(error).strip().splitlines()
        raise FilmError(f"The encoder (ffmpeg) left a film that cannot be read: {why}") from None
    if not found or abs(found - written) > 1:
        raise FilmError(f"The encoder (ffmpeg) left a film with {found} of {written} pictures")
