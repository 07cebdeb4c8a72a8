"""Joint names in the dialects of BVH: which joint of a file is which joint of the course.

    CC_Base_L_Thigh   mixamorig:LeftUpLeg   Bip01 L Thigh   thigh.L   lfemur   J_Bip_L_UpperLeg
are all the left thigh. Joints are guessed by their names, without what all names of a file share,
and the guess must make a figure (`refuse_no_figure`). Twist bones and fingers are passed over.
"""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..skeleton import JOINTS
from .bvh import Bvh
from .bvh.tokens import LONGEST_NAME, BvhError

# The joints of one side, best spelling first. The side is a word or a letter, before or after the
# name (LeftKnee, Knee_L). One word can mean two joints: LeftHip is a thigh or a corner of the
# pelvis, LeftFoot an ankle or a toe. So the order matters.
SIDED = {
    "UpLeg": "upleg upperleg upperleg01 thigh thighbend femur hip",
    "Leg": "leg lowleg lowerleg lowerleg01 shin knee calf tibia",
    "Foot": "ankle foot",
    "ToeBase": "toebase toe toes toe0 ball bigtoe footindex foot",
    "Arm": "arm shldr shldrbend uparm uarm upperarm upperarm01 humerus shoulder",
    "ForeArm": "forearm forearmbend lowarm lowerarm lowerarm01 farm radius elbow",
    "Hand": "wrist hand",
    "HandIndex1": (
        "handindex1 handmiddle1 mid1 middle1 middleproximal index1 fingers finger1 "
        "finger handend handtip palm hand"
    ),
}
CENTRAL = {
    "Hips": "hips hip pelvis midhip root spinebase",
    "Head": "head",
    "Neck1": "neck1 neck neck01 lowerneck necklower necktwist01 upperneck",
    "Spine": "spine chest abdomen ab abdomenlower spine01 spine0 lowerback torso l3 spinemid",
    "Spine1": (
        "spine1 chest2 chest upperchest chestupper spine02 spine2 spine3 thorax t8 spineshoulder"
    ),
}
PREFIX = re.compile(r"^(bip\d+|mixamorig\d*|character\d*)")
CENTRE = re.compile(r"^c[_.\- ]+(?=.)", re.IGNORECASE)  # the middle, as in J_Bip_C_Hips
ENDS_A_WORD = "_.- :|"
SHARED = 0.5  # of a file's names: what so many have in common is no part of a joint's name
# The joints that a file must have; the others can be computed from these.
NEEDED = ["Hips", "Head"]
NEEDED += [
    side + part
    for side in ("Left", "Right")
    for part in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm", "Hand")
]


def plain(name: str) -> str:
    """A name without prefix, blanks and punctuation: 'mixamorig:Left_Up Leg' is 'leftupleg'."""
    bare = re.sub(r"[^a-z0-9]", "", CENTRE.sub("", name.split(":")[-1].lower()))
    return PREFIX.sub("", bare) or bare


def without_shared(names: Sequence[str]) -> list[str]:
    """The names without the beginning and the end that half of them share, as CC_Base_ or _jnt."""
    start, end = (common_prefix(words) for words in (names, [name[::-1] for name in names]))
    bare = [name.removeprefix(start).removesuffix(end[::-1]) for name in names]
    return [short or name for short, name in zip(bare, names, strict=True)]


def by_plain(names: Sequence[str]) -> dict[str, str]:
    """{plain name without what is shared: name}; of two alike the first one counts."""
    bare = without_shared(names)
    return {plain(word): name for word, name in reversed(list(zip(bare, names, strict=True)))}


def common_prefix(names: Iterable[str]) -> str:
    """The longest beginning, up to the end of a word, that half of the names have; or ""."""
    names = [name[:LONGEST_NAME] for name in names]
    starts = Counter(
        name[: k + 1] for name in names for k, letter in enumerate(name) if letter in ENDS_A_WORD
    )
    often = [start for start, count in starts.items() if count >= max(2, SHARED * len(names))]
    return max(often, key=len, default="")


def spellings(joint: str) -> list[str]:
    """The plain names that files use for a joint of the course, best first."""
    if joint in CENTRAL:
        return CENTRAL[joint].split()
    side, part = ("Left", joint[4:]) if joint.startswith("Left") else ("Right", joint[5:])
    sides = (side.lower(), side[0].lower())
    return [name for word in SIDED[part].split() for s in sides for name in (s + word, word + s)]


def guess_mapping(bvh: Bvh, given: Mapping[str, str] | None = None) -> dict[str, str]:
    """{course joint: node of the file}: the entries of `given`, the rest guessed from the names.

    End sites serve as toes and hand tips. A joint without a match is left out if it can be computed
    from others.
    Raises BvhError when a needed joint is missing; the message lists the file's joints.
    """
    mapping = by_names(bvh.joints, given)
    for tip, base in [
        (side + tip, side + base) for side in ("Left", "Right") for tip, base in TIPS
    ]:
        ends = end_of(bvh, mapping[base]) if base in mapping else []
        if tip not in mapping and ends:
            mapping[tip] = ends[0]
    mapping |= by_hierarchy(mapping, bvh)
    refuse_incomplete(mapping, bvh)
    refuse_no_figure(mapping, bvh)
    return mapping


def by_names(names: Sequence[str], given: Mapping[str, str] | None = None) -> dict[str, str]:
    """{course joint: name}: the entries of `given`, and the rest by the names alone."""
    known = by_plain(names)
    mapping = dict(given or {})
    for joint in (joint for joint in JOINTS if joint not in mapping):
        taken = set(mapping.values())
        fits = [
            known[word] for word in spellings(joint) if word in known and known[word] not in taken
        ]
        if fits:
            mapping[joint] = fits[0]
    return mapping


TIPS = (("ToeBase", "Foot"), ("HandIndex1", "Hand"))


def end_of(bvh: Bvh, joint: str) -> list[str]:
    """The end site of a joint, as a list of one name or none."""
    parent = bvh.names.index(joint)
    children = [n for n, own in enumerate(bvh.parents) if own == parent and bvh.is_end[n]]
    return [bvh.names[n] for n in children[:1]]


def ancestors(bvh: Bvh, name: str) -> list[str]:
    """The nodes that a node hangs on, from its parent to the root."""
    found, node = [], int(bvh.parents[bvh.names.index(name)])
    while node >= 0:
        found.append(bvh.names[node])
        node = int(bvh.parents[node])
    return found


def by_hierarchy(mapping: Mapping[str, str], bvh: Bvh) -> dict[str, str]:
    """Hips or head that no name tells.

    The hips are where both legs meet. The head is the last joint of what goes up between the arms,
    as spine.006 of Blender's Rigify.
    """
    found = {}
    if "Hips" not in mapping and {"LeftUpLeg", "RightUpLeg"} <= mapping.keys():
        found["Hips"] = lowest_common_node(bvh, mapping["LeftUpLeg"], mapping["RightUpLeg"])
    if "Head" not in mapping and {"LeftArm", "RightArm"} <= mapping.keys():
        chest = lowest_common_node(bvh, mapping["LeftArm"], mapping["RightArm"])
        arms = [mapping["LeftArm"], mapping["RightArm"]]
        taken = {*arms, *(name for arm in arms for name in ancestors(bvh, arm)), *mapping.values()}
        tops = {}
        for name in bvh.joints:
            above = ancestors(bvh, name)
            if chest in above and not ({name, *above[: above.index(chest)]} & taken):
                tops[name] = len(above)
        if tops:
            found["Head"] = max(tops, key=tops.__getitem__)
    return {joint: name for joint, name in found.items() if name}


def lowest_common_node(bvh: Bvh, first: str, second: str) -> str:
    """The lowest node that both hang on; "" for none."""
    above = ancestors(bvh, second)
    return next((name for name in ancestors(bvh, first) if name in above), "")


def check_mapping(mapping: Mapping[str, str], bvh: Bvh) -> dict[str, str]:
    """A mapping given by hand, with the missing joints guessed.

    Raises BvhError for a name that is not in the course's skeleton or not in the file.
    """
    wrong = [name for name in mapping if name not in JOINTS]
    if wrong:
        raise BvhError(
            f"the mapping names '{wrong[0]:.80}', which is no joint of the course. Its joints are "
            f"{', '.join(JOINTS)}."
        )
    missing = [name for name in mapping.values() if name not in bvh.names]
    if missing:
        raise BvhError(
            f"the mapping names '{missing[0]:.80}', but the file has: {', '.join(bvh.names)}.",
            bvh.source,
        )
    return guess_mapping(bvh, given=mapping)


def refuse_incomplete(mapping: Mapping[str, str], bvh: Bvh) -> None:
    """Raise BvhError when a needed joint has no counterpart.

    The message lists the file's joints and shows how to map them.
    """
    lacking = [joint for joint in NEEDED if joint not in mapping]
    if lacking:
        if figures := figures_of(bvh):
            raise BvhError(
                f"the file has {len(figures)} figures: their joints begin with "
                f"{' and '.join(figures)}. Export each figure to its own file.",
                bvh.source,
            )
        first = f"no joint found for {', '.join(lacking)}"
        if twice := [name for name in lacking if name in mapping.values()]:
            ours = next(ours for ours, own in mapping.items() if own == twice[0])
            first += f" ({twice[0]} was taken for {ours})"
        raise BvhError(
            f"{first}. The file has: {', '.join(bvh.joints)}. "
            f"Give the missing ones: md.read_motion(path, mapping={{'{lacking[0]}': '<its joint>', "
            "...}), or motiondiff-edu convert with --joints.",
            bvh.source,
        )


def figures_of(bvh: Bvh) -> list[str]:
    """The beginnings by which the joints of several figures in a file are told apart, if any."""
    rests: dict[str, set[str]] = {}
    for name in bvh.joints:
        start, mark, rest = name.partition(next((x for x in ENDS_A_WORD if x in name), "_"))
        if mark and rest:
            rests.setdefault(start + mark, set()).add(rest)
    alike = [start for start, own in rests.items() if len(own) >= len(NEEDED)]
    same = [start for start in alike if rests[start] == rests[alike[0]]]
    return same if len(same) > 1 else []


Bones = Sequence[tuple[str, str]]  # of joints of the course
LIMBS: tuple[Bones, ...] = tuple(  # both legs, both arms
    [bone for side in ("Left", "Right") for bone in pairwise(side + part for part in limb)]
    for limb in (("UpLeg", "Leg", "Foot"), ("Arm", "ForeArm", "Hand"))
)
UNLIKE = 2.5  # times the length of another bone of both arms, or of both legs, at most


def refuse_no_figure(mapping: Mapping[str, str], bvh: Bvh) -> None:
    """Raise BvhError for joints that make no figure.

    A foot hangs on a shin and that on a thigh; all four bones of both legs are about as long, and
    so are those of both arms.
    """
    pose = dict(
        zip(bvh.names, replace(bvh, frames=bvh.frames[:1]).world_positions()[0], strict=True)
    )
    for bones in LIMBS:
        lengths = []
        for upper, lower in bones:
            above, below = mapping[upper], mapping[lower]
            if above not in ancestors(bvh, below):
                raise _no_figure(f"{lower} ('{below}') does not hang on {upper} ('{above}')", bvh)
            lengths.append(float(np.linalg.norm(pose[above] - pose[below])))
        if words := unlike(bones, lengths, mapping):
            raise _no_figure(words, bvh)


def unlike(bones: Bones, lengths: Sequence[float], mapping: Mapping[str, str]) -> str:
    """What is wrong with the lengths of the bones of both arms, or of both legs; "" if nothing."""
    named = [
        f"{upper} ('{mapping[upper]}') to {lower} ('{mapping[lower]}')" for upper, lower in bones
    ]
    by_bone = dict(zip(named, lengths, strict=True))
    longest, shortest = (choose(by_bone, key=by_bone.__getitem__) for choose in (max, min))
    if by_bone[longest] <= UNLIKE * by_bone[shortest]:
        return ""
    times = by_bone[longest] / max(by_bone[shortest], 1e-9)
    return f"{longest} is {times:.3g} times as long as {shortest}"


def _no_figure(what: str, bvh: Bvh) -> BvhError:
    return BvhError(
        f"the joints make no figure: {what}. The file has: {', '.join(bvh.joints)}. Name them: "
        "md.read_motion(path, mapping={'<joint of the course>': '<its joint>', ...}), or "
        "motiondiff-edu convert with --joints.",
        bvh.source,
    )
