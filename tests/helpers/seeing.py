"""How colours look: their contrast, and to people who do not see all of them.

Lab: CIE 1976, D65. Colour blindness: Machado, Oliveira and Fernandes, 2009, at full severity, on
linear RGB.
"""

import numpy as np

BLIND = {
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
TO_XYZ = np.array(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)


def linear(rgb: np.ndarray) -> np.ndarray:
    """sRGB from 0 to 1 to linear light."""
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def gamma(light: np.ndarray) -> np.ndarray:
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def as_seen(rgb: np.ndarray, kind: str) -> np.ndarray:
    """The colours as somebody sees them who has this colour blindness."""
    return gamma(linear(rgb) @ np.array(BLIND[kind]).T)


def lab(rgb: np.ndarray) -> np.ndarray:
    """L*, a*, b* of sRGB colours from 0 to 1."""
    ratio = linear(rgb) @ TO_XYZ.T / (TO_XYZ @ np.ones(3))
    f = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def apart(one: np.ndarray, other: np.ndarray) -> float:
    """The distance of two colours (CIE 1976); 2.3 is just noticed."""
    return float(np.linalg.norm(lab(np.asarray(one)) - lab(np.asarray(other))))


def contrast(one: np.ndarray, other: np.ndarray) -> float:
    """The contrast of two colours, 1 to 21 (WCAG 2)."""
    bright, dark = sorted(
        (float(linear(np.asarray(c)) @ TO_XYZ[1]) for c in (one, other)), reverse=True
    )
    return (bright + 0.05) / (dark + 0.05)
