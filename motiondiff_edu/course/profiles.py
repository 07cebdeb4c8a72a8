"""The profile of a notebook's run, `fast` or `full`. Only this file reads MOTIONDIFF_PROFILE."""

import os
from typing import Literal

Profile = Literal["fast", "full"]


class ProfileError(ValueError):
    """MOTIONDIFF_PROFILE is set to a word that is no profile."""


def profile() -> Profile:
    """The chosen profile: `fast` (the default) or `full`.

    `full` means longer trainings, more clips, and a GPU where there is one.

    Raises ProfileError when the environment variable MOTIONDIFF_PROFILE has another value.
    """
    word = os.environ.get("MOTIONDIFF_PROFILE", "fast").strip().lower() or "fast"
    if word not in ("fast", "full"):
        raise ProfileError(
            f"MOTIONDIFF_PROFILE is {word!r}; set it to 'fast' or 'full', or leave it out for fast"
        )
    return "full" if word == "full" else "fast"
