"""What the browsers of this machine can do: open a window, read a temporary file."""

import os
import sys
from pathlib import Path

SNAPS = Path("/snap/bin")
BROWSERS = ("firefox", "chromium", "brave", "opera", "vivaldi.vivaldi-stable")


def has_a_screen() -> bool:
    """Whether a browser can open a window; a text browser would block the terminal."""
    if os.environ.get("BROWSER") or sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def shut_in() -> str | None:
    """The name of an installed browser that sees neither /tmp nor hidden folders, or None.

    Browsers of the snap store are shut in so; Ubuntu's Firefox and Chromium are such.
    """
    return next((name for name in BROWSERS if (SNAPS / name).exists()), None)


def folder_for_pages() -> Path | None:
    """Where a page that nobody named goes: None is the system's temporary folder."""
    return Path.home() if shut_in() else None
