"""Joint names in the dialects of BVH: which joint of a file is which joint of the course."""

import re
from collections.abc import Mapping

from .bvh import Bvh
from .bvh.tokens import BvhError
from .skeleton import JOINTS

# The joints of one side, best spelling first. The side is a word or a letter, before or after the
# name (LeftKnee, Knee_L). One word can mean two joints: LeftHip is a thigh or a corner of the
# pelvis, LeftFoot an ankle or a toe. So the order matters.
SIDED = {
    "UpLeg": "upleg upperleg thigh hip femur",
    "Leg": "leg lowleg lowerleg shin knee calf tibia",
    "Foot": "ankle foot",
    "ToeBase": "toebase toe toes toe0 ball foot",
    "Arm": "arm shldr uparm upperarm shoulder humerus",
    "ForeArm": "forearm lowarm lowerarm elbow radius",
    "Hand": "wrist hand",
    "HandIndex1": (
        "handindex1 handmiddle1 mid1 middle1 index1 fingers finger1 "
        "finger handend handtip palm hand"
    ),
}
CENTRAL = {
    "Hips": "hips hip pelvis root",
    "Head": "head",
    "Neck1": "neck1 neck neck01 lowerneck upperneck",
    "Spine": "spine chest abdomen spine01 spine0 lowerback torso",
    "Spine1": "spine1 chest2 chest upperchest spine02 spine2 spine3 thorax",
}
PREFIX = re.compile(r"^(bip\d+|mixamorig\d*|character\d*)")
# The joints that a file must have; the others can be computed from these.
NEEDED = ["Hips", "Head"]
NEEDED += [
    side + part
    for side in ("Left", "Right")
    for part in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm", "Hand")
]


def plain(name: str) -> str:
    """A name without prefix, blanks and punctuation: 'mixamorig:Left_Up Leg' is 'leftupleg'."""
    bare = re.sub(r"[^a-z0-9]", "", name.split(":")[-1].lower())
    return PREFIX.sub("", bare) or bare


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
    known = {plain(name): name for name in reversed(bvh.joints)}
    mapping = dict(given or {})
    for joint in (joint for joint in JOINTS if joint not in mapping):
        taken = set(mapping.values())
        fits = [
            known[word] for word in spellings(joint) if word in known and known[word] not in taken
        ]
        if fits:
            mapping[joint] = fits[0]
    for tip, base in [
        (side + tip, side + base) for side in ("Left", "Right") for tip, base in TIPS
    ]:
        ends = end_of(bvh, mapping[base]) if base in mapping else []
        if tip not in mapping and ends:
            mapping[tip] = ends[0]
    refuse_incomplete(mapping, bvh)
    return mapping


TIPS = (("ToeBase", "Foot"), ("HandIndex1", "Hand"))


def end_of(bvh: Bvh, joint: str) -> list[str]:
    """The end site of a joint, as a list of one name or none."""
    parent = bvh.names.index(joint)
    children = [n for n, own in enumerate(bvh.parents) if own == parent and bvh.is_end[n]]
    return [bvh.names[n] for n in children[:1]]


def check_mapping(mapping: Mapping[str, str], bvh: Bvh) -> dict[str, str]:
    """A mapping given by hand, with the missing joints guessed.

    Raises BvhError for a name that is not in the course's skeleton or not in the file.
    """
    wrong = [name for name in mapping if name not in JOINTS]
    if wrong:
        raise BvhError(
            f"the mapping names '{wrong[0]}', which is no joint of the course. Its joints are "
            f"{', '.join(JOINTS)}."
        )
    missing = [name for name in mapping.values() if name not in bvh.names]
    if missing:
        raise BvhError(
            f"the mapping names '{missing[0]}', but the file has: {', '.join(bvh.names)}.",
            bvh.source,
        )
    return guess_mapping(bvh, given=mapping)


def refuse_incomplete(mapping: Mapping[str, str], bvh: Bvh) -> None:
    """Raise BvhError when a needed joint has no counterpart.

    The message lists the file's joints and shows how to map them.
    """
    lacking = [joint for joint in NEEDED if joint not in mapping]
    if lacking:
        raise BvhError(
            f"no joint found for {', '.join(lacking)}. The file has: {', '.join(bvh.joints)}. "
            f"Give the missing ones: md.read_motion(path, mapping={{'{lacking[0]}': '<its joint>', "
            "...}), or motiondiff-edu convert with --joints.",
            bvh.source,
        )
