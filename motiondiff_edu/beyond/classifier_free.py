"""Classifier-free guidance: away from what the network makes without a text, towards its text.

    eps_hat = (1 - w) eps_hat(x_s, s, nothing) + w eps_hat(x_s, s, text)
w = 1 is the conditional network, as in the paper. A larger w follows the text more closely, and the
samples differ less; the result is no sample of the conditional any more. In training, some texts
are left out, so that one network is both. It costs two evaluations at every step.
A mover that plans guides the timeline first. Where the text of the motion is left out, its timeline
stays, in training too, so for the motion a larger w stresses what the timeline does not say.
Gain: docs/RESULTS.md, *MoFusion's Table 2* (`words.guided.*`).
Source: Ho and Salimans, 2022. Ours; MoFusion has no guidance.
Notebook: 16
"""

from ..ddpm import Denoiser


def guided_by_text(conditional: Denoiser, unconditional: Denoiser, w: float) -> Denoiser:
    """A denoiser between the two for w from 0 to 1, and beyond the conditional one above 1."""
    if w == 1:
        return conditional
    return lambda x_s, s: (1 - w) * unconditional(x_s, s) + w * conditional(x_s, s)
