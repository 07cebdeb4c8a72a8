"""The one skeleton of the course: the 21 joints of MoDiff's data, with constant bones.

Metres; y up, x to the figure's left, z forward. A planted toe joint lies on the floor, y = 0. The
names are those of the locomotion corpus that MoDiff uses; the bone lengths are ours, for a person
of 1.70 m.
Source: MoDiff IV-A.  Notebook: 01
"""

from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

# name, parent, offset from the parent in the rest pose (standing, arms out sideways)
_TABLE = [
    ("Hips", -1, (0.0, 0.97, 0.0)),
    ("LeftUpLeg", 0, (0.085, -0.06, 0.0)),
    ("LeftLeg", 1, (0.0, -0.41, 0.0)),
    ("LeftFoot", 2, (0.0, -0.425, 0.0)),
    ("LeftToeBase", 3, (0.0, -0.075, 0.115)),
    ("RightUpLeg", 0, (-0.085, -0.06, 0.0)),
    ("RightLeg", 5, (0.0, -0.41, 0.0)),
    ("RightFoot", 6, (0.0, -0.425, 0.0)),
    ("RightToeBase", 7, (0.0, -0.075, 0.115)),
    ("Spine", 0, (0.0, 0.12, 0.0)),
    ("Spine1", 9, (0.0, 0.14, 0.0)),
    ("Neck1", 10, (0.0, 0.22, 0.0)),
    ("Head", 11, (0.0, 0.11, 0.02)),
    ("LeftArm", 11, (0.18, -0.05, 0.0)),
    ("LeftForeArm", 13, (0.28, 0.0, 0.0)),
    ("LeftHand", 14, (0.25, 0.0, 0.0)),
    ("LeftHandIndex1", 15, (0.09, 0.0, 0.0)),
    ("RightArm", 11, (-0.18, -0.05, 0.0)),
    ("RightForeArm", 17, (-0.28, 0.0, 0.0)),
    ("RightHand", 18, (-0.25, 0.0, 0.0)),
    ("RightHandIndex1", 19, (-0.09, 0.0, 0.0)),
]

JOINTS: tuple[str, ...] = tuple(name for name, _, _ in _TABLE)
J: int = len(JOINTS)
PARENTS: np.ndarray = np.array([parent for _, parent, _ in _TABLE])
OFFSETS: np.ndarray = np.array([offset for _, _, offset in _TABLE])  # (21, 3), metres

# (parent, child)
BONES: tuple[tuple[int, int], ...] = tuple((int(PARENTS[j]), j) for j in range(1, J))
# (20,), metres, in the order of BONES
BONE_LENGTHS: np.ndarray = np.linalg.norm(OFFSETS[1:], axis=-1)

HIPS = 0
HEELS = (3, 7)  # the Foot joints: the ankle, which the corpus calls heel
TOES = (4, 8)
LEFT: tuple[int, ...] = tuple(j for j, name in enumerate(JOINTS) if name.startswith("Left"))
RIGHT: tuple[int, ...] = tuple(j for j, name in enumerate(JOINTS) if name.startswith("Right"))
CENTRE: tuple[int, ...] = tuple(j for j in range(J) if j not in LEFT + RIGHT)


def _mirror_permutation() -> np.ndarray:
    swap = {"Left": "Right", "Right": "Left"}
    partner = [next((swap[s] + n[len(s) :] for s in swap if n.startswith(s)), n) for n in JOINTS]
    return np.array([JOINTS.index(name) for name in partner])


# MIRROR[j] is the joint on the other side; a central joint is its own
MIRROR: np.ndarray = _mirror_permutation()

# (left bone, right bone), as indices into BONES
BONE_PAIRS: tuple[tuple[int, int], ...] = tuple(
    (k, BONES.index((int(PARENTS[MIRROR[child]]), int(MIRROR[child]))))
    for k, (_, child) in enumerate(BONES)
    if child in LEFT
)


def check_joints(positions: np.ndarray) -> None:
    """Raise ValueError unless the last two axes are the course's joints and their coordinates."""
    if positions.shape[-2:] != (J, 3):
        raise ValueError(
            f"the course's skeleton has {J} joints with 3 coordinates, not {positions.shape[-2:]}"
        )


@dataclass(frozen=True)
class Skeleton:
    """Joints by name, and the number of each joint's parent (-1 for the root, which comes first).

    Raises ValueError where names and parents do not fit together.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]

    def __post_init__(self):
        names = tuple(map(str, self.names))
        parents = tuple(map(int, self.parents))
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "parents", parents)
        if len(names) != len(parents) or len(set(names)) != len(names) or not names:
            raise ValueError(
                f"a skeleton has one parent for each joint, and no name twice; these are "
                f"{len(names)} names ({len(set(names))} different), {len(parents)} parents"
            )
        for joint, parent in enumerate(parents):
            if not -1 <= parent < joint:
                raise ValueError(
                    f"the parent of {names[joint]} (joint {joint}) is {parent}: a parent must come "
                    f"before its children, and -1 marks the root"
                )

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str) -> int:
        """The index of a joint by its name.  Raises KeyError with a list of all names."""
        if name not in self.names:
            near = get_close_matches(name, self.names, n=1)
            meant = f". Did you mean {near[0]!r}?" if near else ""
            several = ". Pass several joints as a list" if "," in name else meant
            raise KeyError(
                f"no joint is called {name!r}; the skeleton has {', '.join(self.names)}{several}"
            )
        return self.names.index(name)


COURSE = Skeleton(JOINTS, tuple(PARENTS.tolist()))  # the one skeleton of the course's networks
joint_index = COURSE.index
