"""Inverse kinematics: a joint is dragged and the body follows.

Every bone keeps its length, and joints that need not move stay. The method depends on the joint:

    elbow, knee             turns about the shoulder or the hip
    wrist, ankle            two bones, by the triangle of their lengths
    fingertip, toe          pulls the hand or the foot
    head, neck, spine,
    shoulders               bend the trunk by FABRIK; shoulders are one block with the chest
    pelvis                  carries the body; the feet stay as far as the legs reach
The limb points towards a target that is out of reach.
Source: FABRIK: Aristidou and Lasenby, 2011; two bones: the law of cosines.
"""

import numpy as np
from jaxtyping import Float

from .directions import ARMS, SPINE1, UP, UPLEGS, least_turn, unit
from .skeleton import HEELS, HIPS, JOINTS, PARENTS, J

Pose = Float[np.ndarray, "21 3"]
Point = Float[np.ndarray, "3"]
Length = float | Float[np.ndarray, "*T"]

# fraction of its length to which a limb is stretched; a straight limb would have no side to bend to
STRAIGHTEST = 0.9995
# m: a middle joint nearer than this to the line through its limb does not define the side to which
# the limb bends; the body's own direction is mixed in
STIFF = 0.03
PELVIS = (HIPS, *UPLEGS)  # one rigid piece


def drag(pose: Pose, joint: int, target: Point) -> Pose:
    """The pose with a joint at `target` (metres, world), or as near as its bones reach.

    All bones keep their lengths. Dragging a joint to where it is changes nothing.
    Raises IndexError for a joint that does not exist, ValueError for a target that is not finite.
    """
    if not 0 <= joint < J:
        raise IndexError(f"joint {joint} is not one of the skeleton's {J} (0 to {J - 1})")
    check_target(joint, target)
    if joint in PELVIS:
        return pelvis_moved(pose, target - pose[joint])
    if joint in HEELS:
        return ankles_dragged(pose[None], joint, target[None])[0]
    chain = chain_to(joint)
    if chain[0] == HIPS:
        return move_chain(pose, chain, fabrik(pose[chain], target))
    if len(chain) == 2:
        return move_chain(
            pose, chain, np.stack([pose[chain[0]], pose[chain[0]] + _bone(pose, chain, target)])
        )
    solve = two_bones if len(chain) == 3 else tow_limb
    bends = bends_to(pose[None], chain[0])[0]
    return move_chain(pose, chain, solve(pose[chain], target, bends))


def check_target(joint: int, target: Float[np.ndarray, "*T 3"]) -> None:
    """Raise ValueError for a target of this joint that is not finite; the first one is named."""
    bad = target[~np.isfinite(target).all(-1)]
    if bad.size:
        first = bad.reshape(-1, 3)[0].tolist()
        raise ValueError(f"{JOINTS[joint]} cannot be dragged to {first}: the target is not finite")


def chain_to(joint: int) -> list[int]:
    """The chain of joints that moves `joint`, from the joint that stays.

    A limb's chain starts at the hip or shoulder, the trunk's at the pelvis. A shoulder hangs from
    the chest, which is one block, so its chain leaves out the neck.
    """
    chain = [joint, SPINE1] if joint in ARMS else [joint]
    while chain[-1] != HIPS and (len(chain) == 1 or chain[-1] not in (*UPLEGS, *ARMS)):
        chain.append(int(PARENTS[chain[-1]]))
    return chain[::-1]


def bends_to(poses: Float[np.ndarray, "T 21 3"], root: int) -> Float[np.ndarray, "T 2 3"]:
    """Two directions in which a straight limb can start to bend, frame by frame.

    The second serves when the limb points along the first. Knees bend ahead or up, elbows back or
    down. `root` is the limb's first joint, a hip or a shoulder.
    """
    sense = 1.0 if root in UPLEGS else -1.0
    ahead = pelvis_ahead(poses)
    return sense * np.stack([ahead, np.broadcast_to(UP, ahead.shape)], 1)


def two_bones(
    limb: Float[np.ndarray, "3 3"], target: Point, bends: Float[np.ndarray, "2 3"]
) -> Float[np.ndarray, "3 3"]:
    """`limbs_bent` for a single limb."""
    return limbs_bent(limb[None], target[None], bends[None])[0]


def limbs_bent(
    limbs: Float[np.ndarray, "T 3 3"],
    targets: Float[np.ndarray, "T 3"],
    bends: Float[np.ndarray, "T 2 3"],
) -> Float[np.ndarray, "T 3 3"]:
    """Root, middle and end of a limb in each frame, with the end at the target.

    Two bones and a distance form a triangle (`triangle`). The middle joint stays on its
    side, which turns with the line from root to end. A target out of reach is moved closer along
    the line from the root.
    """
    root, middle, end = limbs.swapaxes(0, 1)
    a, b, far = (np.linalg.norm(v, axis=-1) for v in (middle - root, end - middle, end - root))
    longest = np.maximum(STRAIGHTEST * (a + b), np.minimum(far, a + b))
    wanted = np.linalg.norm(targets - root, axis=-1)
    before = unit(end - root)
    line = np.where((wanted > 1e-9)[:, None], unit(targets - root), before)
    d = np.clip(wanted, np.minimum(np.abs(a - b) + 0.01, far), longest)
    along, aside = triangle(a, b, d)
    bent = perpendicular(middle - root, before)
    was = np.linalg.norm(bent, axis=-1)
    more = np.maximum(0.0, 1 - was / STIFF) * np.maximum(aside - was, 0.0)
    side = np.einsum("tij,tj->ti", least_turn(before, line), bent)
    side = unit(side + more[:, None] * _first_aside(bends, line))
    # along and aside are arrays, since d is one
    knee = root + along[:, None] * line + aside[:, None] * side  # type: ignore[index]
    return np.stack([root, knee, root + d[:, None] * line], 1)


def _first_aside(
    directions: Float[np.ndarray, "T 2 3"], line: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, "T 3"]:
    """The part of the first direction at right angles to the line.

    The second direction serves where the first points along the line.
    """
    first, second = (perpendicular(v, line) for v in directions.swapaxes(0, 1))
    plain = np.linalg.norm(first, axis=-1, keepdims=True) > 0.2
    return np.where(plain, unit(first), unit(second))


def ankles_dragged(
    poses: Float[np.ndarray, "T 21 3"], heel: int, targets: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, "T 21 3"]:
    """`drag` of an ankle in every frame: the knee bends, and the foot keeps its direction.

    Raises ValueError for a target that is not finite.
    """
    check_target(heel, targets)
    if not len(poses):
        return np.array(poses)
    hip, knee = heel - 2, heel - 1
    toe = heel + 1
    places = limbs_bent(poses[:, [hip, knee, heel]], targets, bends_to(poses, hip))
    moved = np.array(poses)
    moved[:, [knee, heel]] = places[:, 1:]
    moved[:, toe] += places[:, 2] - poses[:, heel]
    return moved


def tow_limb(
    limb: Float[np.ndarray, "4 3"], target: Point, bends: Float[np.ndarray, "2 3"]
) -> Float[np.ndarray, "4 3"]:
    """Two bones and a hand or foot: its tip moves to the target, and the rest follows the tip."""
    three, last = limb[:3], float(np.linalg.norm(limb[3] - limb[2]))
    tip = limb[3]
    for _ in range(20):
        if np.linalg.norm(tip - target) < 1e-9:
            break
        three = two_bones(
            limb[:3], target + last * _aim(three[2] - target, limb[2] - limb[3]), bends
        )
        tip = three[2] + last * _aim(target - three[2], limb[3] - limb[2])
    return np.concatenate([three, tip[None]])


def fabrik(
    chain: Float[np.ndarray, "N 3"], target: Point, rounds: int = 60
) -> Float[np.ndarray, "N 3"]:
    """The chain with its end at the target and its start unchanged.

    The method alternates between passes from the end and from the start. A pass puts each joint on
    the line to its neighbour's new place, at the bone's length.

    A target out of reach makes the chain straight. If two joints coincide, their bone keeps its
    direction.
    """
    lengths = np.linalg.norm(np.diff(chain, axis=0), axis=-1)
    places = np.array(chain)
    for _ in range(rounds):
        if np.linalg.norm(places[-1] - target) < 1e-7:
            break
        places[-1] = target
        for i in range(len(chain) - 2, -1, -1):
            places[i] = places[i + 1] + lengths[i] * _aim(
                places[i] - places[i + 1], chain[i] - chain[i + 1]
            )
        places[0] = chain[0]
        for i in range(len(chain) - 1):
            places[i + 1] = places[i] + lengths[i] * _aim(
                places[i + 1] - places[i], chain[i + 1] - chain[i]
            )
    return places


def move_chain(pose: Pose, chain: list[int], places: Float[np.ndarray, "N 3"]) -> Pose:
    """The pose with a chain at new places; joints below turn with the bone that carries them."""
    moved = np.array(pose)
    for k in range(1, len(chain)):
        joint, above = chain[k], chain[k - 1]
        turn = least_turn((pose[joint] - pose[above])[None], (places[k] - places[k - 1])[None])[0]
        below = [
            j
            for j in block(joint, above)
            if k + 1 == len(chain) or j not in block(chain[k + 1], joint)
        ]
        moved[below] = places[k] + (pose[below] - pose[joint]) @ turn.T
        moved[joint] = places[k]
    return moved


def block(joint: int, above: int) -> list[int]:
    """The joints that turn with the bone between two neighbours of a chain:
    the first joint on the way from `above` to `joint`, and all joints below it.
    """
    first = joint
    while PARENTS[first] != above:
        first = int(PARENTS[first])
    return descendants(first, True)


def descendants(joint: int, itself: bool = False) -> list[int]:
    """All joints that hang from one (a parent comes before its children)."""
    found = [joint]
    for j in range(joint + 1, J):
        if PARENTS[j] in found:
            found.append(j)
    return found if itself else found[1:]


def pelvis_moved(pose: Pose, shift: Point) -> Pose:
    """The body moved; each ankle and its foot stay, as far as the leg reaches."""
    moved = pose + shift
    for heel in HEELS:
        moved = ankles_dragged(moved[None], heel, pose[None, heel])[0]
    return moved


def triangle(a: Length, b: Length, d: Length) -> tuple[Length, Length]:
    """The place where two bones of lengths a and b meet, if their ends are d apart.

    Returns the distance along the line between the ends, and the distance aside of it:
    (a^2 - b^2 + d^2) / 2d and sqrt(a^2 - that^2), by the law of cosines.
    """
    along = (a**2 - b**2 + d**2) / (2 * d)
    return along, np.sqrt(np.maximum(a**2 - along**2, 0.0))


def pelvis_ahead(world: Float[np.ndarray, "T 21 3"]) -> Float[np.ndarray, "T 3"]:
    """Unit vector in the direction that the hips face."""
    return unit(np.cross(world[:, 1] - world[:, 5], world[:, 9] - world[:, 0]))


def perpendicular(
    vector: Float[np.ndarray, "T 3"], line: Float[np.ndarray, "T 3"]
) -> Float[np.ndarray, "T 3"]:
    """The part of a vector at right angles to a unit line."""
    return vector - np.einsum("ti,ti->t", vector, line)[:, None] * line


def _bone(pose: Pose, chain: list[int], target: Point) -> Point:
    """One bone, turned towards the target."""
    root, end = pose[chain]
    return np.linalg.norm(end - root) * _aim(target - root, end - root)


def _aim(wanted: Point, before: Point) -> Point:
    """The wanted direction with length one, or the one before where `wanted` is zero."""
    return unit(wanted if np.linalg.norm(wanted) > 1e-9 else before)
