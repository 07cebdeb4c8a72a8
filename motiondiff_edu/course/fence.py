"""On Linux, a process that can write, remove and make files in one folder alone (Landlock).

The kernel (5.13 and newer) refuses the rest to it and to all that it starts, for whoever runs it,
root included; what each version of Landlock adds is in `without`. It can still read all, change
permissions and times of files, use UDP, and talk to programs that listen at a socket in a folder.
Source: Linux, Documentation/userspace-api/landlock.rst
"""

import ctypes
import os
import sys
from collections.abc import Iterable

# system calls, of the same number on every processor
CREATE = 444
ADD, RESTRICT = 445, 446
BENEATH, VERSION = 1, 1
NO_NEW_PRIVILEGES = 38
WRITE = 1 << 1
# by the version of Landlock that has them first: writes of files, in folders, and across them
FILES = {1: WRITE | sum(1 << bit for bit in range(4, 13)), 2: 1 << 13, 3: 1 << 14, 5: 1 << 15}
TCP = {4: 0b11}  # to bind, to connect
OTHERS = {6: 0b11}  # sockets without a file, and signals
DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")


MISSING = {  # below a version of Landlock, with the Linux that has it
    1: "change and remove all your files (Linux 5.13 keeps them from it)",
    3: "empty your files (Linux 6.2 keeps them from it)",
    4: "use the network (Linux 6.7 keeps them from TCP)",
    6: "end other processes of yours (Linux 6.12 keeps them from it)",
}


def without(has: int) -> list[str]:
    """What a process can do all the same where Landlock has this version, in words."""
    return [words for since, words in MISSING.items() if has < since]


def version() -> int:
    """The version of Landlock that this kernel has; 0 for none."""
    if sys.platform != "linux":
        return 0
    return max(ctypes.CDLL(None).syscall(CREATE, None, 0, VERSION), 0)


def keep_within(folder: str | os.PathLike) -> bool:
    """From now on, let this process write in `folder` alone; whether the system can.

    Raises OSError where it can and does not.
    """
    has = version()
    if not has:
        return False
    handled = [rights_of(kind, has) for kind in (FILES, TCP, OTHERS)]
    most = 1 if has < 4 else 2 if has < 6 else 3
    libc = ctypes.CDLL(None, use_errno=True)
    attributes = (ctypes.c_uint64 * most)(*handled[:most])
    rules = _call(libc.syscall(CREATE, attributes, ctypes.sizeof(attributes), 0))
    try:
        _allow(libc, rules, handled[0], [folder])
        _allow(libc, rules, WRITE, filter(os.path.exists, DEVICES))
        _call(libc.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0))
        _call(libc.syscall(RESTRICT, rules, 0))
    finally:
        os.close(rules)
    return True


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("parent", ctypes.c_int32))


def _allow(libc: ctypes.CDLL, rules: int, rights: int, paths: Iterable) -> None:
    for path in paths:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
        rule = _Beneath(rights, place)
        try:
            _call(libc.syscall(ADD, rules, BENEATH, ctypes.byref(rule), 0))
        finally:
            os.close(place)


def rights_of(rights: dict[int, int], has: int) -> int:
    """The bits that a version of Landlock knows; it takes no others."""
    return sum(bits for since, bits in rights.items() if since <= has)


def _call(answer: int) -> int:
    if answer < 0:
        raise OSError(ctypes.get_errno(), f"Landlock: {os.strerror(ctypes.get_errno())}")
    return answer
