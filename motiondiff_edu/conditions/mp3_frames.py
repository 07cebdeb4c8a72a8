"""How long an MP3 is: its frames, counted one by one.

An MP3 has no length of its own. Programs believe a header in its first frame (Xing, Info, VBRI),
which may be missing or, where files were joined, speak of the first one alone; else they estimate
from the first bitrate. Here the frames are walked through, and `with_length` writes the true count.
Source: ISO/IEC 11172-3 and 13818-3 (frame headers), layer III alone.
"""

from collections.abc import Iterator
from dataclasses import dataclass

# kilobits a second by index, of MPEG 1 and of MPEG 2 and 2.5
BITRATES = {
    True: (32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320),
    False: (8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160),
}
RATES = {3: (44_100, 48_000, 32_000), 2: (22_050, 24_000, 16_000), 0: (11_025, 12_000, 8_000)}
LENGTH_TAGS = (b"Xing", b"Info", b"VBRI")
VBRI_AT = 36  # bytes into a frame


@dataclass(frozen=True)
class Frame:
    """A frame: where it begins and how long it is (bytes), its samples, and where a tag may be."""

    start: int
    length: int
    samples: int
    tag_at: int


def frame_at(raw: bytes, at: int) -> Frame | None:
    """The frame that begins here, or None if none does."""
    if at + 4 > len(raw) or raw[at] != 0xFF or raw[at + 1] & 0xE0 != 0xE0:
        return None
    version, layer = raw[at + 1] >> 3 & 3, raw[at + 1] >> 1 & 3
    bits, speed = raw[at + 2] >> 4, raw[at + 2] >> 2 & 3
    if version == 1 or layer != 1 or not 0 < bits < 15 or speed == 3:
        return None
    newest = version == 3
    samples = 1152 if newest else 576
    kilobits, rate = BITRATES[newest][bits - 1], RATES[version][speed]
    length = samples // 8 * 1000 * kilobits // rate + (raw[at + 2] >> 1 & 1)
    mono = raw[at + 3] >> 6 == 3
    side = (17 if mono else 32) if newest else (9 if mono else 17)
    return Frame(at, length, samples, 4 + side)


def frames_of(raw: bytes) -> Iterator[Frame]:
    """The frames of a file; what lies between them, as tags and pictures, is passed over."""
    at, last = 0, None
    while at < len(raw):
        if raw[at : at + 3] == b"ID3" and at + 10 <= len(raw):
            at += 10 + sum((raw[at + 6 + k] & 127) << 7 * (3 - k) for k in range(4))
            continue
        found = frame_at(raw, at)
        # a lone header may be chance: another one must follow it, or one have been before it
        if found and (last == at or frame_at(raw, at + found.length)):
            yield found
            at = last = at + found.length
            continue
        next_ones = [k for k in (raw.find(b"\xff", at + 1), raw.find(b"ID3", at + 1)) if k > 0]
        at = min(next_ones, default=len(raw))


def has_length_tag(raw: bytes, frame: Frame) -> bool:
    """Whether a frame has no sound, and says how long the file is."""
    places = (frame.start + frame.tag_at, frame.start + VBRI_AT)
    return any(raw[at : at + 4] in LENGTH_TAGS for at in places)


def promised(raw: bytes) -> int:
    """The samples that the first frame says the file has; 0 where it says nothing."""
    first = next(frames_of(raw), None)
    if first is None:
        return 0
    at = first.start + first.tag_at
    if raw[at : at + 4] not in (b"Xing", b"Info") or not raw[at + 7] & 1:
        return 0
    return int.from_bytes(raw[at + 8 : at + 12], "big") * first.samples


def with_length(raw: bytes) -> tuple[bytes, int]:
    """The same sound with the true number of frames in its first one; and its samples.

    (b"", 0) for what has no frames.
    """
    sound = [frame for frame in frames_of(raw) if not has_length_tag(raw, frame)]
    if not sound:
        return b"", 0
    first = sound[0]
    tag = bytearray(raw[first.start : first.start + 4].ljust(first.length, b"\0"))
    tag[1] |= 1  # without a checksum
    words = b"Xing" + (1).to_bytes(4, "big") + len(sound).to_bytes(4, "big")
    tag[first.tag_at : first.tag_at + len(words)] = words
    body = b"".join(raw[one.start : one.start + one.length] for one in sound)
    return bytes(tag) + body, sum(frame.samples for frame in sound)
