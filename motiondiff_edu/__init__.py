"""Human-motion diffusion, taken apart in notebooks and put together again: MoDiff and MoFusion,
readable and runnable.

Start at notebook 00 (`python -m motiondiff_edu lab`), or read ddpm.py first and modiff.py next.
"""

__version__ = "0.1.0"

try:
    import torch  # noqa: F401  the one heavy import; everything else is imported where it is used
except (
    ImportError,
    OSError,
):  # `python -m motiondiff_edu doctor` must still be able to say what is wrong
    pass
