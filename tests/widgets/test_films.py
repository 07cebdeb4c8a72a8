"""Films: an encoder that fails, lies or hangs never replaces a good film by a broken one."""

import os
import sys

import numpy as np
import pytest
from PIL import Image

from motiondiff_edu.widgets import films

imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")

if os.name == "nt":
    pytest.skip("the encoders of these tests are shell scripts", allow_module_level=True)

FFMPEG = imageio_ffmpeg.get_ffmpeg_exe()
SIZE = (64, 34)
# what stands in for ffmpeg: $out is the last argument, the film to write
ENCODERS = {
    "fails after half": ('head -c 30000 >/dev/null; printf half > "$out"; '
                         'echo "No space left on device" >&2; exit 1'),
    "fails at the end": 'cat >/dev/null; printf half > "$out"; echo "No space left" >&2; exit 1',
    "ends early and is content": 'head -c 9000 >/dev/null; printf half > "$out"; exit 0',
    "leaves no film": "cat >/dev/null; exit 0",
    "leaves an empty film": 'cat >/dev/null; : > "$out"; exit 0',
    "leaves noise": 'cat >/dev/null; head -c 5000 /dev/urandom > "$out"; exit 0',
    "leaves half a film": 'cat >/dev/null; cp "$short" "$out"; exit 0',
    # ffmpeg itself, on a disk that takes no more than 1024 bytes
    "has a full disk": f'trap "" XFSZ; ulimit -f 2; exec {FFMPEG} "$@"',
    "never takes a picture": "exec sleep 100",
    "never ends": "exec 3<&0; cat <&3 >/dev/null; exec sleep 100",
}  # fmt: skip
WORDS = {
    "fails after half": "status 1 at picture .*: No space left on device",
    "fails at the end": "status 1 .*No space left",
    "ends early and is content": "status 0 at picture .*last words: none",
    "leaves half a film": "a film with 10 of 24 pictures",
    "has a full disk": "File too large|No space|-27|Conversion failed",
    "never takes a picture": "status -9",
    "never ends": "did not end within 0.5 s",
}


def pictures(count: int = 24):
    """Noise, so that films cannot be made small."""
    random = np.random.default_rng(5)
    for _ in range(count):
        yield Image.fromarray(random.integers(0, 256, (*SIZE[::-1], 3), dtype=np.uint8))


@pytest.fixture
def encoder(tmp_path_factory, monkeypatch):
    """A function that puts one of ENCODERS in ffmpeg's place; what is written is read by ffmpeg."""
    folder = tmp_path_factory.mktemp("encoder")
    short = films.write_mp4(folder / "short.mp4", pictures(10), SIZE, 20.0)

    def use(name: str) -> None:
        program = folder / "ffmpeg"
        last = f'for out; do :; done\nshort="{short}"'
        program.write_text(f"#!/bin/sh\n{last}\n{ENCODERS[name]}\n")
        program.chmod(0o755)
        monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", lambda: str(program))

    return use


@pytest.mark.parametrize("name", ENCODERS)
def test_a_film_that_fails_leaves_the_one_that_was_there(name, encoder, tmp_path, monkeypatch):
    path = films.write_mp4(tmp_path / "walk.mp4", pictures(), SIZE, 20.0)
    before = path.read_bytes()
    encoder(name)
    if name.startswith("never"):
        monkeypatch.setattr(films, "PATIENCE", 0.5)
    # more pictures than a pipe holds, where the encoder takes none
    count = 200 if name == "never takes a picture" else 24
    with pytest.raises(films.FilmError, match=WORDS.get(name, "cannot be read")) as caught:
        films.write_mp4(path, pictures(count), SIZE, 20.0)
    told = str(caught.value)
    assert told.startswith(f"{path} was not written; the film that was there is kept")
    assert ".part" not in told
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == ["walk.mp4"]


def test_without_an_older_film_nothing_is_left(encoder, tmp_path):
    encoder("fails at the end")
    with pytest.raises(films.FilmError, match=r"walk\.mp4 was not written\. The encoder"):
        films.write_mp4(tmp_path / "walk.mp4", pictures(), SIZE, 20.0)
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize("size", [(64, 34), (63, 35)])
@pytest.mark.parametrize("count", [1, 2, 24])
def test_a_film_has_its_pictures_and_an_even_size(size, count, tmp_path):
    given = (Image.new("RGB", size, (9 * k, 90, 0)) for k in range(count))
    path = films.write_mp4(tmp_path / "a film.mp4", given, size, 30000 / 1001)
    assert imageio_ffmpeg.count_frames_and_secs(path)[0] == count
    told = next(imageio_ffmpeg.read_frames(path))
    assert told["size"] == tuple(n + n % 2 for n in size)
    assert told["fps"] == pytest.approx(29.97, abs=0.01)


def test_an_error_while_drawing_ends_the_encoder(tmp_path):
    def drawn():
        yield from pictures(3)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        films.write_mp4(tmp_path / "walk.mp4", drawn(), SIZE, 20.0)
    assert not any(tmp_path.iterdir())


def test_without_imageio_ffmpeg_the_error_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(ImportError, match="save_gif does not"):
        films.write_mp4(tmp_path / "walk.mp4", pictures(), SIZE, 20.0)
