"""Still pictures of the player's scene, with pillow: a filmstrip for places where no widget runs,
and the frames of a GIF or MP4.
"""

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from PIL import Image, ImageDraw, ImageFont

from ..motion.root_frame import FPS
from ..motion.skeleton import BONES, HEELS, TOES
from ..performers.performer import bar
from ..viz import body

TRAIL = 1200  # frames of the root's trail in a picture: a film of all would cost their square
SMOOTH = 2  # pictures are drawn larger by this factor and then shrunk: pillow has no antialiasing
GROUND, LINE = "#F1F3F5", "#9AA3AE"


@dataclass(frozen=True, eq=False)
class Thin:
    """Thin limbs of n motions over a figure's body: the bones with an end in `away`."""

    motions: Float[np.ndarray, "n T J 3"]
    away: Bool[np.ndarray, "T J"]
    colour: str
    dashed: bool = False


@dataclass(frozen=True, eq=False)
class Figure:
    """One figure of a scene; `past` frames were given, `path` (metres, [x, z]) is on the floor.

    Raises ValueError for more past than frames, a path of another shape or with gaps, and a label
    that is no text.
    """

    positions: Float[np.ndarray, "T J 3"]
    label: str = ""
    past: int | None = None
    contacts: Bool[np.ndarray, "T 2"] | None = None
    path: Float[np.ndarray, "n 2"] | None = None
    parts: tuple[body.Part, ...] = body.BODY
    thin: tuple[Thin, ...] = ()

    def __post_init__(self):
        if not isinstance(self.label, str):
            raise ValueError(f"labels are texts, not {self.label!r:.40}")
        if self.past is not None and not 0 <= self.past <= len(self.positions):
            raise ValueError(
                f"past = {self.past}: it is a number of frames, from 0 to the "
                f"{len(self.positions)} of the motion"
            )
        if self.path is None:
            return
        if self.path.ndim != 2 or self.path.shape[1] != 2 or not np.isfinite(self.path).all():
            raise ValueError(
                f"path must be [x, z] in metres, of shape (n, 2) and finite; it has the shape "
                f"{self.path.shape}, and {int((~np.isfinite(self.path)).sum())} values that are not"
            )

    def __len__(self) -> int:
        return len(self.positions)

    def tense(self, t: int) -> str:
        """The word given or generated for frame t; empty if `past` is None."""
        return "" if self.past is None else ("past" if t < self.past else "future")


def camera_at(
    positions: Float[np.ndarray, "T J 3"], t: int, camera: body.Camera, fps: float = FPS
) -> body.Camera:
    """The camera that follows the root, averaged over a second around frame t for a calm view."""
    half = int(fps // 2)
    around = positions[np.clip(np.arange(t - half, t + half + 1), 0, len(positions) - 1), 0]
    return camera.at(*around[:, [0, 2]].mean(0))


def floor_lines(
    camera: body.Camera, reach: int = 5
) -> tuple[Float[np.ndarray, "N 2 3"], Float[np.ndarray, "N"]]:
    """Segments of a 1 m grid around the camera's target; their strength 1..0 fades outwards."""
    rows = np.arange(-reach, reach + 1)
    starts = np.stack(np.meshgrid(rows, rows[:-1], indexing="ij"), -1).reshape(-1, 2)
    along_z = np.stack([starts, starts + [0, 1]], axis=1)
    ground = np.stack([along_z, along_z[..., ::-1]], axis=1).reshape(-1, 2, 2)
    ground = np.round([camera.x, camera.z]) + ground
    away = np.linalg.norm(ground.mean(1) - [camera.x, camera.z], axis=-1) / reach
    near = away < 1
    return _floor_points(ground[near]), 1 - away[near] ** 2


def _floor_points(xz: np.ndarray) -> np.ndarray:
    return np.insert(np.asarray(xz, dtype=np.float64), 1, 0.0, axis=-1)


def _in_sight(points: np.ndarray, camera: body.Camera, size: tuple) -> tuple[np.ndarray, ...]:
    """The pixels of points, and whether they lie before the camera."""
    *_, ahead = camera.axes()
    depth = (points - [camera.x, camera.height, camera.z]) @ ahead + camera.distance
    pixels, _ = body.project(points, camera, size)
    return np.clip(pixels, -9 * size[0], 9 * size[0]), depth > 0.3


def _line(
    pen: ImageDraw.ImageDraw,
    points: np.ndarray,
    camera: body.Camera,
    size: tuple,
    colour: str,
    width: int,
):
    pixels, there = _in_sight(points, camera, size)
    for i in np.flatnonzero(there[1:] & there[:-1]):
        pen.line([*pixels[i], *pixels[i + 1]], fill=colour, width=width)


def _ground(
    pen: ImageDraw.ImageDraw, figure: Figure, t: int, camera: body.Camera, size: tuple
) -> None:
    """Floor grid, given path, trail of the root, marks under planted feet."""
    segments, strengths = floor_lines(camera)
    pixels, there = _in_sight(segments, camera, size)
    for i in np.flatnonzero(there.all(1)):
        colour = body.mix(GROUND, LINE, 0.55 * strengths[i])
        pen.line(pixels[i].ravel().tolist(), fill=colour, width=SMOOTH)
    if figure.path is not None:
        _line(pen, _floor_points(figure.path), camera, size, body.PATH_COLOUR, 2 * SMOOTH)
    trail = _floor_points(figure.positions[max(0, t - TRAIL) : t + 1, 0][:, [0, 2]])
    _line(pen, trail, camera, size, LINE, 2 * SMOOTH)
    if figure.contacts is None or t >= len(figure):
        return
    for side in np.flatnonzero(figure.contacts[t]):
        foot = figure.positions[t, [HEELS[side], TOES[side]]].mean(0)
        ring = foot * [1, 0, 1] + 0.17 * np.stack(
            [np.cos(body.ANGLES), 0 * body.ANGLES, np.sin(body.ANGLES)], -1
        )
        colour = body.COLOURS["LR"[side]]
        pixels = [tuple(p) for p in body.project(ring, camera, size)[0]]
        pen.polygon(pixels, fill=body.mix(colour, GROUND, 0.75), outline=colour, width=SMOOTH)


def _thin_limbs(
    pen: ImageDraw.ImageDraw, thin: Thin, t: int, camera: body.Camera, size: tuple
) -> None:
    """Draw thin limbs over a body; a dashed limb has five dashes per bone."""
    bones = [bone for bone in BONES if thin.away[t, list(bone)].any()]
    shares = np.linspace(0, 1, 10 if thin.dashed else 2).reshape(-1, 2)
    for pose in thin.motions[:, t]:
        for a, b in bones:
            for ends in shares:
                dash = pose[a] + ends[:, None] * (pose[b] - pose[a])
                _line(pen, dash, camera, size, thin.colour, 2 * SMOOTH)


def render(
    figure: Figure,
    t: int,
    size: tuple[int, int],
    camera: body.Camera | None = None,
    fps: float = FPS,
) -> Image.Image:
    """Frame t of one figure, with a camera that follows it; `size` is in pixels.

    After the figure's end it is the last frame.
    """
    t = min(t, len(figure) - 1)
    big = (size[0] * SMOOTH, size[1] * SMOOTH)
    camera = camera_at(figure.positions, t, camera or body.Camera(), fps)
    picture = Image.new("RGB", big, GROUND)
    _ground(ImageDraw.Draw(picture), figure, t, camera, big)
    shade = Image.new("L", big, 0)
    for polygon in body.shadow_polygons(figure.positions[t], camera, big, figure.parts):
        ImageDraw.Draw(shade).polygon([tuple(p) for p in polygon], fill=46)
    picture.paste("#1E2837", mask=shade)
    pen = ImageDraw.Draw(picture)
    wash = body.PAST_WASH if figure.tense(t) == "past" else 0.0
    for polygon, colour, is_outline in body.body_polygons(
        figure.positions[t], camera, big, figure.parts, wash
    ):
        points = [tuple(p) for p in polygon]
        if is_outline:
            pen.line([*points, points[0]], fill=GROUND, width=2 * SMOOTH, joint="curve")
        pen.polygon(points, fill=colour)
    for thin in figure.thin:
        _thin_limbs(pen, thin, t, camera, big)
    return picture.resize(size, Image.Resampling.LANCZOS)


def _write(
    pen: ImageDraw.ImageDraw, at: tuple[int, int], text: str, size: int, anchor: str = "la"
) -> None:
    pen.text(at, text, fill=body.INK, font=ImageFont.load_default(size), anchor=anchor)


def _legend(pen: ImageDraw.ImageDraw, right: int, y: int, text_size: int) -> None:
    for word, colour in (("right", body.RIGHT_COLOUR), ("left", body.LEFT_COLOUR)):
        width = round(pen.textlength(word, font=ImageFont.load_default(text_size)))
        _write(pen, (right - width, y), word, text_size)
        pen.ellipse(
            [right - width - text_size, y + 2, right - width - 4, y + text_size - 2], fill=colour
        )
        right -= width + 2 * text_size


def filmstrip(
    figures: list[Figure],
    fps: float,
    n: int = 6,
    width: int = 960,
    between: Sequence[int] | None = None,
) -> Image.Image:
    """n poses from the first to the last frame, or of the frames `between` (both inclusive).

    Each figure has a row; the times stand above.
    """
    cell, head = width // n, 30
    tall = int(cell * {1: 2.1, 2: 1.45}.get(len(figures), 1.2))
    picture = Image.new("RGB", (width, head + tall * len(figures)), body.PAPER)
    pen = ImageDraw.Draw(picture)
    moments = np.linspace(*(between or (0, max(map(len, figures)) - 1)), n).round().astype(int)
    for row, figure in enumerate(figures):
        for column, t in enumerate(moments):
            drawn = render(figure, int(t), (cell, tall), fps=fps)
            picture.paste(drawn, (column * cell, head + row * tall))
            _write(pen, (column * cell + 6, head + row * tall + 5), figure.tense(int(t)), 15)
        if figure.label:
            _write(pen, (6, head + (row + 1) * tall - 22), figure.label, 16)
    for column, t in enumerate(moments):
        _write(pen, (column * cell + 6, 7), f"{t / fps:.{2 if between else 1}f} s", 16)
    _legend(pen, width - 10, picture.height - 24, 16)
    return picture


def as_png(picture: Image.Image) -> bytes:
    """PNG bytes of a picture in 128 colours: a third of the size, without a visible difference."""
    buffer = io.BytesIO()
    picture.quantize(128, dither=Image.Dither.NONE).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def film(
    figures: list[Figure], fps: float, size: tuple[int, int] = (400, 360), every: int = 1
) -> Iterator[Image.Image]:
    """Each frame, or each n-th with every=n, with the figures side by side.

    Each figure has a field of `size` with its label.
    """
    frames = range(0, max(map(len, figures)), every)
    for t in bar("drawing", len(frames))(frames):
        picture = Image.new("RGB", (size[0] * len(figures), size[1]), body.PAPER)
        pen = ImageDraw.Draw(picture)
        for i, figure in enumerate(figures):
            picture.paste(render(figure, t, size, fps=fps), (i * size[0], 0))
            words = " · ".join(w for w in (figure.label, figure.tense(t)) if w)
            _write(pen, (i * size[0] + 10, 8), words, 18)
        _write(pen, (10, size[1] - 28), f"{t / fps:.1f} s", 18)
        _legend(pen, picture.width - 10, size[1] - 28, 18)
        yield picture


def film_palette(figures: list[Figure], size: tuple[int, int]) -> Image.Image:
    """One palette of 96 colours for all frames, from the first and the last frame.

    These two have the colours of the past and of the future.
    """
    both = Image.new("RGB", (2 * size[0], size[1]))
    for i, t in enumerate((0, len(figures[0]) - 1)):
        both.paste(render(figures[0], t, size), (i * size[0], 0))
    return both.quantize(96)
