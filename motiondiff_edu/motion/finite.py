"""A check of arrays: a missing number is an error, and not a plausible measure."""

import numpy as np
from jaxtyping import Float


def check_finite(values: Float[np.ndarray, "*shape"], name: str) -> None:
    """Raise ValueError where a value is NaN or infinite.

    A comparison with NaN is False, so a measure that counts would give a plausible wrong number.
    """
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        raise ValueError(
            f"{name} contain NaN or infinity ({len(bad)} values, the first at index "
            f"{tuple(bad[0].tolist())}): fill or cut them first"
        )
