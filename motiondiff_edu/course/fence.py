"""On Linux, a process that can write, remove and make files in one folder alone (Landlock).

The kernel refuses the rest to it and to all that it starts, for whoever runs it, root included. It
can still read. Newer kernels also refuse connections by TCP (6.7), and signals to other processes
(6.12).
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
FILES = {1: WRITE | sum(1 << bit for bit in range(4, 13)), 2: 1 << 13, 3: 1 << 14}
TCP = {4: 0b11}  # to bind, to connect
OTHERS = {6: 0b11}  # sockets without a file, and signals
DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")


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
    handled = [_known(of, has) for of in (FILES, TCP, OTHERS)]
    most = 1 if has < 4 else 2 if has < 6 else 3
    libc = ctypes.CDLL(None, use_errno=True)
    attributes = (ctypes.c_uint64 * most)(*handled[:most])
    rules = _call(libc.syscall(CREATE, attributes, ctypes.sizeof(attributes), 0))
    _allow(libc, rules, handled[0], [folder])
    _allow(libc, rules, WRITE, filter(os.path.exists, DEVICES))
    _call(libc.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0))
    _call(libc.syscall(RESTRICT, rules, 0))
    os.close(rules)
    return True


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("parent", ctypes.c_int32))


def _allow(libc: ctypes.CDLL, rules: int, rights: int, paths: Iterable) -> None:
    for path in paths:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
        rule = _Beneath(rights, place)
        _call(libc.syscall(ADD, rules, BENEATH, ctypes.byref(rule), 0))
        os.close(place)


def _known(rights: dict[int, int], has: int) -> int:
    return sum(bits for since, bits in rights.items() if since <= has)


def _call(answer: int) -> int:
    if answer < 0:
        raise OSError(ctypes.get_errno(), f"Landlock: {os.strerror(ctypes.get_errno())}")
    return answer
