"""The drawn body: the thickness at each joint, a camera, and polygons to fill.

The browser's player draws from the same table of parts, so the poster and the live figure look the
same.
Notebook: 01
"""

from dataclasses import asdict, dataclass, replace
from functools import lru_cache

import numpy as np
from jaxtyping import Float

from ..motion.skeleton import J

GREY = "#5B6472"
INK = "#1F2933"
PAPER = "#FFFFFF"
# Okabe-Ito blue and vermillion
LEFT_COLOUR = "#0072B2"
RIGHT_COLOUR = "#D55E00"
CENTRE_COLOUR = GREY
PATH_COLOUR = "#009E73"
COLOURS = {"L": LEFT_COLOUR, "R": RIGHT_COLOUR, "C": CENTRE_COLOUR}
PAST_WASH = 0.55  # how far the colours of given frames are mixed with the background

ANGLES = np.linspace(0, 2 * np.pi, 20, endpoint=False)
_RING = np.stack([np.cos(ANGLES), np.sin(ANGLES)], -1)


@dataclass(frozen=True)
class Part:
    """The convex hull of circles (joint a, joint b, w, radius in m), centred at a + w (b - a)."""

    side: str  # L, R or C
    circles: tuple[tuple[int, int, float, float], ...]


def _limb(side: str, *joint_radius: tuple[int, float]) -> Part:
    return Part(side, tuple((joint, joint, 0.0, radius) for joint, radius in joint_radius))


def _side(side: str, leg: int, arm: int) -> list[Part]:
    foot = Part(
        side,
        (
            (leg + 2, leg + 2, 0.0, 0.045),
            (leg + 3, leg + 3, 0.0, 0.036),
            (leg + 2, leg + 3, 1.4, 0.026),
        ),
    )
    return [
        _limb(side, (leg, 0.078), (leg + 1, 0.052)),
        _limb(side, (leg + 1, 0.054), (leg + 2, 0.036)),
        foot,
        _limb(side, (arm, 0.05), (arm + 1, 0.037)),
        _limb(side, (arm + 1, 0.038), (arm + 2, 0.027)),
        _limb(side, (arm + 2, 0.032), (arm + 3, 0.022)),
    ]


BODY: tuple[Part, ...] = (
    _limb("C", (1, 0.082), (5, 0.082), (9, 0.098)),
    _limb("C", (9, 0.096), (10, 0.108), (13, 0.052), (17, 0.052), (11, 0.05)),
    _limb("C", (11, 0.045), (12, 0.045)),
    Part("C", ((11, 12, 1.2, 0.082), (11, 12, 1.7, 0.096))),
    *_side("L", 1, 13),
    *_side("R", 5, 17),
)


def stick_parts(parents: list[int], radius: float = 0.025) -> tuple[Part, ...]:
    """Parts for any other skeleton: one thin limb per bone, a ball for a root without bones."""
    bones = [_limb("C", (p, radius), (j, radius)) for j, p in enumerate(parents) if p >= 0]
    return tuple(bones) or (_limb("C", (0, radius)),)


def parts_for(joints: int, parents: list[int] | None = None) -> tuple[Part, ...]:
    """The course's body for 21 joints, sticks for another skeleton, which needs its `parents`."""
    if parents is not None:
        if len(parents) != joints:
            raise ValueError(f"`parents` has {len(parents)} joints, but the positions {joints}")
        return stick_parts(list(parents))
    if joints != J:
        raise ValueError(
            f"positions have {joints} joints, the course's skeleton has {J}: "
            "give `parents` for another"
        )
    return BODY


def parts_record(parts: tuple[Part, ...]) -> list[dict]:
    """The parts as plain lists, for the browser."""
    return [asdict(part) for part in parts]


@dataclass(frozen=True)
class Camera:
    """A camera that looks at (x, height, z) from `distance` metres.

    Yaw 0 stands at the figure's right side.

    `focal` is in picture heights: an object of h metres at the target covers focal h / distance of
    the picture's height.
    """

    x: float = 0.0
    z: float = 0.0
    height: float = 0.86
    yaw: float = 0.6
    pitch: float = 0.2
    distance: float = 5.0
    focal: float = 2.05

    def at(self, x: float, z: float) -> "Camera":
        """The same camera, which looks at another place on the floor."""
        return replace(self, x=float(x), z=float(z))

    def axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Unit vectors to the right, up and ahead."""
        return _axes(self.yaw, self.pitch)


@lru_cache(maxsize=16)  # a picture projects a hundred times with one camera
def _axes(yaw: float, pitch: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    cos = np.cos(yaw)
    sin = np.sin(yaw)
    rise = np.sin(pitch)
    flat = np.cos(pitch)
    ahead = -np.array([-flat * cos, rise, flat * sin])
    right = np.array([sin, 0.0, cos])
    axes = right, np.cross(right, ahead), ahead
    for one in axes:
        one.setflags(write=False)
    return axes


def project(
    points: Float[np.ndarray, "*N 3"], camera: Camera, size: tuple[int, int]
) -> tuple[Float[np.ndarray, "*N 2"], Float[np.ndarray, "*N"]]:
    """Pixels (x to the right, y down) and pixels per metre at each point, in a picture of `size`.

    `size` is (width, height).
    """
    right, up, ahead = camera.axes()
    target = np.array([camera.x, camera.height, camera.z])
    away = points - (target - camera.distance * ahead)
    scale = camera.focal * size[1] / np.maximum(away @ ahead, 0.1)
    return np.stack(
        [size[0] / 2 + scale * (away @ right), size[1] / 2 - scale * (away @ up)], -1
    ), scale


def hull(points: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, "K 2"]:
    """Convex hull, by Andrew's monotone chain."""
    ordered = sorted(map(tuple, points.tolist()))
    kept: list[tuple[float, float]] = []
    for way in (ordered, ordered[::-1]):
        first = len(kept)
        for c in way:
            while len(kept) > first + 1:
                (a_x, a_y), (b_x, b_y) = kept[-2:]
                if (b_x - a_x) * (c[1] - a_y) > (b_y - a_y) * (c[0] - a_x):
                    break
                kept.pop()
            kept.append(c)
        kept.pop()
    return np.array(kept)


def circle_centres(pose: Float[np.ndarray, "J 3"], part: Part) -> Float[np.ndarray, "N 3"]:
    """The centres of a part's circles."""
    a, b, w, _ = (np.array(column) for column in zip(*part.circles, strict=True))
    return pose[a] + w[:, None] * (pose[b] - pose[a])


def outline(
    pixels: Float[np.ndarray, "N 2"], radii: Float[np.ndarray, "N"]
) -> Float[np.ndarray, "K 2"]:
    """The polygon around circles."""
    return hull((pixels[:, None] + radii[:, None, None] * _RING).reshape(-1, 2))


def mix(colour: str, other: str, share: float) -> str:
    """`colour` mixed with a fraction `share` of `other`, both #RRGGBB."""
    a, b = (np.array([int(c[i : i + 2], 16) for i in (1, 3, 5)]) for c in (colour, other))
    return "#" + "".join(f"{int(round(v)):02X}" for v in a + share * (b - a))


def body_polygons(
    pose: Float[np.ndarray, "J 3"],
    camera: Camera,
    size: tuple[int, int],
    parts: tuple[Part, ...] = BODY,
    wash: float = 0.0,
) -> list[tuple[Float[np.ndarray, "_ 2"], str, bool]]:
    """Filled polygons of one pose (points, colour, is outline), far ones first.

    Each part has its outline and a lighter streak that makes it look round. Parts behind the middle
    of the body are a little paler, which shows depth.
    """
    drawn = []
    _, middle = project(np.array([[camera.x, camera.height, camera.z]]), camera, size)
    for part in parts:
        pixels, scale = project(circle_centres(pose, part), camera, size)
        radii = scale * np.array([circle[3] for circle in part.circles])
        behind = float(np.clip(4 * (1 - scale.mean() / middle[0]), 0, 0.45))
        colour = mix(COLOURS[part.side], PAPER, min(1.0, wash + behind * (1 - wash)))
        shine = outline(pixels - 0.3 * radii[:, None] * [0.5, 1], 0.45 * radii)
        drawn.append(
            (
                scale.mean(),
                [(outline(pixels, radii), colour, True), (shine, mix(colour, PAPER, 0.22), False)],
            )
        )
    return [polygon for _, pair in sorted(drawn, key=lambda item: item[0]) for polygon in pair]


def shadow_polygons(
    pose: Float[np.ndarray, "J 3"],
    camera: Camera,
    size: tuple[int, int],
    parts: tuple[Part, ...] = BODY,
) -> list[Float[np.ndarray, "_ 2"]]:
    """The shadow on the floor, under a light from above and a little to the side."""
    shadows = []
    for part in parts:
        centres = circle_centres(pose, part)
        radii = np.array([circle[3] for circle in part.circles])
        floor = np.stack(
            [centres[:, 0] + 0.25 * centres[:, 1], centres[:, 2] - 0.15 * centres[:, 1]], -1
        )
        ring = (floor[:, None] + 0.9 * radii[:, None, None] * _RING).reshape(-1, 2)
        pixels, _ = project(
            np.stack([ring[:, 0], np.zeros(len(ring)), ring[:, 1]], -1), camera, size
        )
        shadows.append(hull(pixels))
    return shadows
