"""Actions: what a sentence says, performed by the course's figure, and captions of it.

Notebook: 16, 17
"""

from .acts import VERBS, Act, Phrase, Sentence
from .captions import caption
from .dataset import Described, clips, mirror
from .performance import Acted, Span, act_out

__all__ = [
    "VERBS",
    "Act",
    "Acted",
    "Described",
    "Phrase",
    "Sentence",
    "Span",
    "act_out",
    "caption",
    "clips",
    "mirror",
]
