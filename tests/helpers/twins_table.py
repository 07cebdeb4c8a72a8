"""Which step-by-step function of a notebook must agree with which of the library.

They stand in cells tagged `twin`.

TWINS = {"02": {"name in the notebook": Twin(library function, arguments)}}; `arguments` is a
function without parameters that returns the tuple both are called with. Where the two take
different arguments, give lambdas:


    "q_sample_loop": Twin(ddpm.q_sample, lambda: (x0, 7, schedule, noise)),
    "attention_loop": Twin(lambda q, k, v: attend(q, k, v)[0], lambda: (q, k, v), atol=1e-5),

Sizes pairwise different, numbers from an own generator. Every notebook with twin cells needs an
entry here.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import torch
from scipy.spatial.transform import Rotation, Slerp

from data_synth.mixtures import crossed_bars
from motiondiff_edu import (
    bound,
    ddpm,
    diffusion_dropout,
    exact,
    inbetweening,
    kinematic_loss,
    prediction,
    reconstruction,
    rollout,
    training,
)
from motiondiff_edu import cross_modal_attention as cross
from motiondiff_edu.baselines import linear_dropout, ridge, text
from motiondiff_edu.conditions import music
from motiondiff_edu.metrics import bodies, dances, distributions, walks
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.mofusion import ResBlock
from motiondiff_edu.motion import kinematics, root_frame, skeleton
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.windows import Windows


class Twin(NamedTuple):
    """A function of the library, what to call both with, and how closely they must agree."""

    library: Callable
    arguments: Callable[[], tuple[Any, ...]]
    atol: float = 1e-6
    rtol: float = 1e-5


TWINS: dict[str, dict[str, Twin]] = {}


LINEAR = ddpm.linear_schedule(100)


def _normal(*shape: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(*shape, generator=torch.Generator().manual_seed(seed), dtype=torch.float64)


def _product_on_a_grid(mean_1, variance_1, mean_2, variance_2) -> tuple[torch.Tensor, torch.Tensor]:
    """Mean and variance of the product of two Gaussian densities, by sums."""
    grid = torch.linspace(-9, 9, 20_001, dtype=torch.float64)
    weight = (-((grid - mean_1) ** 2 / variance_1 + (grid - mean_2) ** 2 / variance_2) / 2).softmax(
        0
    )
    mean = (weight * grid).sum()
    return mean, (weight * (grid - mean) ** 2).sum()


def _two_steps(x0, s, beta, noises) -> torch.Tensor:
    return ddpm.q_step(ddpm.q_step(x0, 1, LINEAR, noises[1]), 2, LINEAR, noises[2])


def _kl(*four) -> torch.Tensor:
    return bound.gaussian_kl(*(value[:, None] for value in four))


TWINS["02"] = {
    "step_by_step": Twin(
        _two_steps, lambda: (_normal(2, 5), 2, LINEAR.beta, _normal(3, 2, 5, seed=1))
    ),
    "at_once": Twin(
        lambda x0, s, beta, noise: ddpm.q_sample(x0, s, LINEAR, noise),
        lambda: (_normal(2, 5), 60, LINEAR.beta, _normal(2, 5, seed=1)),
    ),
    "product": Twin(_product_on_a_grid, lambda: (0.3, 0.5, -0.4, 0.2)),
    "between": Twin(ddpm.q_posterior, lambda: (_normal(2, 5), _normal(2, 5, seed=1), 20, LINEAR)),
    "kl": Twin(
        _kl,
        lambda: (
            _normal(7),
            _normal(7, seed=1).exp(),
            _normal(7, seed=2),
            _normal(7, seed=3).exp(),
        ),
    ),
}


def _walk_angles() -> tuple:
    rng = np.random.default_rng(1)
    local = kinematics.euler_to_matrix(rng.uniform(-3, 3, (skeleton.J, 3)), "ZXY")
    return local, rng.normal(size=3), skeleton.OFFSETS, skeleton.PARENTS


def _one_frame(local, root, offsets, parents) -> np.ndarray:
    return kinematics.forward_kinematics(local[None], root[None], offsets, parents)[0][0]


def _scipy_slerp(a, b, u) -> np.ndarray:
    """SciPy's slerp, with the sign of the quaternion that lies nearer to a."""
    found = Slerp([0, 1], Rotation.from_quat([a, b]))(u).as_quat()
    return found if found @ a > 0 else -found


def _two_quaternions(seed: int) -> tuple:
    a, b = Rotation.random(2, rng=np.random.default_rng(seed)).as_quat()
    return a, b, 0.3


TWINS["01"] = {
    "fk_loop": Twin(_one_frame, _walk_angles),
    "root_loop": Twin(
        lambda control: np.column_stack(root_frame.root_path(control)),
        lambda: (np.random.default_rng(2).normal(size=(57, 3)),),
    ),
    "slerp": Twin(_scipy_slerp, lambda: _two_quaternions(5)),
}


def _shrink(x: torch.Tensor, s: torch.Tensor) -> torch.Tensor:
    """A denoiser that depends on x and on s, and on nothing that is tested."""
    return torch.tanh(x) * (s / 100).sqrt()[:, None]


def _means(x_s, alpha_bar, data) -> torch.Tensor:
    x_s, data = x_s.reshape(len(x_s), -1), data.reshape(len(data), -1)
    return exact.dataset_mean(data, x_s, torch.full((len(x_s),), 40), LINEAR)


def _last(steps) -> torch.Tensor:
    *_, step = steps
    return step.x_s


TWINS["03"] = {
    "mean_by_loops": Twin(
        lambda *args: _means(*args)[:, 0],
        lambda: (_normal(7), LINEAR.alpha_bar[40], _normal(5, seed=1)),
    ),
    "mean_at_once": Twin(
        _means, lambda: (_normal(2, 5), LINEAR.alpha_bar[40], _normal(7, 5, seed=1))
    ),
    "algorithm_2": Twin(
        lambda denoise, x, schedule, noises: _last(
            ddpm.sample_steps(denoise, x, schedule, noise=noises[1:])
        ),
        lambda: (_shrink, _normal(2, 5), LINEAR, _normal(101, 2, 5, seed=1)),
    ),
    "ddim": Twin(
        lambda *args: _last(ddpm.ddim_steps(*args)),
        lambda: (_shrink, _normal(2, 5), LINEAR, [100, 60, 25, 3]),
    ),
}


def _sway(past, control, generator) -> torch.Tensor:
    """A window sampler that depends on everything it is given: (B, 7, D)."""
    drift = 0.1 * control[:, -7:].mean(-1, keepdim=True) + 0.05 * past.mean((1, 2), keepdim=True)
    return (
        past[:, -1:] + drift + 0.1 * torch.randn(len(past), 7, past.shape[-1], generator=generator)
    )


def _rolled(sample, past, control, frames, T_p, generator) -> torch.Tensor:
    loop = rollout.rollout_steps(sample, past, control, frames, T_p, generator=generator)
    return torch.stack([frame.pose for frame in loop], 1)


def _two_walkers() -> tuple:
    return (
        _sway,
        _normal(2, 5, 4).float(),
        _normal(2, 30, 3, seed=1).float(),
        11,
        7,
        torch.Generator().manual_seed(1),
    )


def _planted_walk() -> tuple:
    """Twelve frames whose toes are always under 3 cm, and a control with a turn."""
    rng = np.random.default_rng(3)
    poses = rng.normal(0, 0.1, (12, skeleton.J, 3))
    poses[:, skeleton.TOES, 1] = rng.uniform(0, 0.02, (12, 2))
    return poses, rng.normal(size=(12, 3))


TWINS["08"] = {
    "roll": Twin(_rolled, _two_walkers),
    "bone_rmse_loop": Twin(bodies.bone_rmse, lambda: _planted_walk()[:1]),
    "residual_loop": Twin(walks.residual_velocity, _planted_walk),
    "runs_loop": Twin(walks.runs, lambda: (np.array([1, 0, 0, 1, 1, 1, 0, 1], dtype=bool),)),
}


def _column(terms: torch.Tensor) -> torch.Tensor:
    """The library keeps one number for each sample.

    The notebook has one for each entry, here the same.
    """
    return terms[..., None]


def _one_by_one(n: int, size: int) -> list[torch.Tensor | None]:
    """Noises of steps 1..n as the library draws them from seed 5."""
    generator = torch.Generator().manual_seed(5)
    return [None] + [
        torch.randn(size, 1, generator=generator, dtype=torch.float64) for _ in range(n)
    ]


TWINS["04"] = {
    "prior_term": Twin(
        lambda x0, alpha_bar: _column(bound.prior_kl(x0, LINEAR)),
        lambda: (_normal(7, 1), LINEAR.alpha_bar[-1]),
    ),
    "step_term": Twin(
        lambda *args: _column(bound.step_kl(*args)),
        lambda: (_normal(7, 1), _normal(7, 1, seed=1), 30, _normal(7, 1, seed=2), LINEAR),
    ),
    "last_term": Twin(
        lambda *args: _column(bound.reconstruction_nll(*args)),
        lambda: (_normal(7, 1), _normal(7, 1, seed=1), _normal(7, 1, seed=2), LINEAR),
    ),
    "all_terms": Twin(
        lambda denoise, x0, schedule, noises: bound.bound_terms(
            denoise, x0, schedule, torch.Generator().manual_seed(5)
        ),
        lambda: (_shrink, _normal(7, 1), LINEAR, _one_by_one(100, 7)),
    ),
    "weight": Twin(lambda s, schedule: bound.dropped_weight(schedule)[s], lambda: (30, LINEAR)),
}


def _small_block() -> tuple:
    torch.manual_seed(3)
    block = (
        cross.Block(width=12, heads=3, hidden=20, with_context=True).double().requires_grad_(False)
    )
    return block, _normal(2, 5, 12), _normal(2, 7, 12, seed=1)


TWINS["06"] = {
    "attention_loop": Twin(
        lambda q, k, v: cross.attention(*(x[None, None] for x in (q, k, v)))[0, 0],
        lambda: (_normal(5, 4), _normal(7, 4, seed=1), _normal(7, 3, seed=2)),
    ),
    "heads_loop": Twin(
        lambda layer, x, context: layer(x, context),
        lambda: (_small_block()[0].cross_attention, *_small_block()[1:]),
    ),
    "bucket_loop": Twin(
        lambda distance: cross.relative_position_bucket(torch.tensor(distance)), lambda: (-46,)
    ),
    "block_by_hand": Twin(
        lambda block, x, context: block(x, context=block.cross_attention.keys_and_values(context)),
        _small_block,
    ),
}


def _batch_of_plane() -> tuple:
    x0, eps = _normal(7, 3, seed=51), _normal(7, 3, seed=52)
    return x0, eps, torch.tensor([1, 12, 30, 55, 70, 95, 100]), LINEAR


def _all_targets(x0, eps, s, schedule) -> tuple[torch.Tensor, ...]:
    return tuple(
        prediction.target_of(x0, eps, s, schedule, target) for target in ("eps", "x0", "v")
    )


def _toy_training() -> tuple:
    torch.manual_seed(53)

    def loss_fn(model, generator):
        x = torch.randn(11, 5, generator=generator)
        return (model(x) - x[:, :2] * x[:, 3:]).square().mean()

    return torch.nn.Linear(5, 2), loss_fn, 6, torch.Generator().manual_seed(54)


def _train_by_library(model, loss_fn, steps, generator) -> torch.Tensor:
    state = training.TrainState.start(model)
    state.generator = generator
    list(training.train_steps(state, loss_fn, steps, clip=1e9, progress=False))
    return torch.cat([p.detach().flatten() for p in model.parameters()])


TWINS["05"] = {
    "targets_loop": Twin(_all_targets, _batch_of_plane),
    "train_by_hand": Twin(_train_by_library, _toy_training),
}


def _ridge(inputs, outputs, ridge) -> torch.Tensor:
    """The same by the singular values of the inputs: no normal equations."""
    u, d, v = torch.linalg.svd(inputs, full_matrices=False)
    return v.T @ ((d / (d**2 + ridge * len(inputs)))[:, None] * (u.T @ outputs))


def _windows_of_walking() -> tuple:
    """A tiny network, and five windows with their steps and noise."""
    torch.manual_seed(55)
    network = MoDiff(MoDiffConfig(T_h=4, T_p=3, S=100, width=16, heads=2, hidden=24))
    past, future, eps = (
        _normal(5, frames, 63, seed=n).float() for n, frames in ((56, 4), (57, 3), (58, 3))
    )
    return (
        network,
        past,
        future,
        _normal(5, 7, 3, seed=59).float(),
        torch.tensor([1, 30, 55, 80, 100]),
        eps,
        LINEAR.alpha_bar,
    )


def _algorithm_1(network, past, future, control, s, eps, alpha_bar) -> torch.Tensor:
    return ddpm.simple_loss(lambda x_s, s: network(x_s, s, past, control), future, s, LINEAR, eps)


TWINS["07"] = {
    "ridge_loop": Twin(
        _ridge, lambda: (_normal(40, 7, seed=60), _normal(40, 3, seed=61), 0.02), atol=1e-9
    ),
    "algorithm_1": Twin(_algorithm_1, _windows_of_walking),
}


def _whole_stft(audio, n_fft, hop) -> torch.Tensor:
    window = torch.hann_window(n_fft, dtype=audio.dtype)
    return torch.stft(audio, n_fft, hop, window=window, pad_mode="constant", return_complex=True).mT


def _librosas_onsets(mel) -> np.ndarray:
    import librosa  # slow to import

    return librosa.onset.onset_strength(S=mel.T, center=False)


class _GoesOn:
    """A walker without noise: its last pose plus the steps that the control gives.

    Called, it goes on by itself.
    """

    class config:
        T_h = 4
        T_p = 4
        D = 6
        C = 3

    pose_scaler = Scaler(torch.linspace(-1, 1, 6), torch.linspace(0.5, 2, 6))
    control_scaler = Scaler.nothing(3)

    def window_sampler(self, steps=None):
        def sample(past, control, generator):
            return past[:, -1:] + control[:, 3:7].cumsum(1).repeat(1, 1, 2)

        return sample

    def __call__(self, past, control):
        return rollout.generate(self, past, control, keep=4, hold=False)


def _broken_walk() -> tuple:
    known = _normal(2, 4, 6, seed=80) > -0.5
    past = _normal(2, 4, 6, seed=81).float().masked_fill(~known, float("nan"))
    return _GoesOn(), past, known, _GoesOn.pose_scaler.mean, _normal(2, 8, 3, seed=82).float(), 3


def _repaired(walker, past, known, mean, control, rounds) -> torch.Tensor:
    there_and_back = reconstruction.Rollout(walker, torch.Generator())
    stop = reconstruction.Stop(rounds, tolerance=-1)
    return reconstruction.reconstruct(there_and_back, past, known, control, stop=stop)


def _conditional_mean(mean, covariance, x, known, rho) -> torch.Tensor:
    return ridge.ConditionalMean(mean, covariance, rho).fill(x[None], known[None])[0]


def _gaussian_of_seven() -> tuple:
    root = _normal(7, 7, seed=83)
    known = torch.tensor([1, 0, 1, 1, 0, 0, 1], dtype=torch.bool)
    return _normal(7, seed=84), root @ root.T, _normal(7, seed=85), known, 0.3


TWINS["10"] = {
    "repair_loop": Twin(_repaired, _broken_walk, atol=1e-5),
    "expected": Twin(_conditional_mean, _gaussian_of_seven),
}


TWINS["11"] = {
    "dft_loop": Twin(np.fft.rfft, lambda: (np.random.default_rng(62).normal(size=22),)),
    "stft_loop": Twin(_whole_stft, lambda: (_normal(500, seed=63), 64, 20)),
    "filters_loop": Twin(
        lambda rate, *sizes: music.mel_filters(rate, *sizes, 0, rate / 2),
        lambda: (11_025, 512, 13),
        atol=1e-8,
    ),
    "onset_loop": Twin(_librosas_onsets, lambda: (_normal(7, 5, seed=64).numpy(),)),
}


def _a_convolution() -> tuple:
    """Seven frames of two numbers, answers of four."""
    return _normal(7, 2, seed=120), _normal(4, 6, seed=121), _normal(4, seed=122)


def _conv1d(x, weight, bias) -> torch.Tensor:
    """PyTorch's own, whose weights have the frame last."""
    kernel = weight.unflatten(1, (3, x.shape[1])).transpose(1, 2)
    return torch.nn.functional.conv1d(x.T[None], kernel, bias, padding=1)[0].T


def _told_block() -> tuple:
    torch.manual_seed(123)
    block = ResBlock(6, 8, 5).double().requires_grad_(False)
    for weight in block.parameters():
        weight.add_(0.3 * torch.randn(weight.shape))
    return block, _normal(2, 7, 6, seed=124), _normal(2, 5, seed=125)


TWINS["12"] = {
    "conv_loop": Twin(_conv1d, _a_convolution),
    "res_by_hand": Twin(
        lambda block, x, told: block(x, told, torch.ones(1, 7, 1, dtype=torch.float64)), _told_block
    ),
    "turn_loop": Twin(cross.rotary, lambda: (_normal(5, 6, seed=126), _normal(5, 3, seed=127))),
}


def _shaken_chain() -> tuple:
    """Two motions of five frames and four joints, and three bones."""
    return _normal(2, 5, 4, 3, seed=70), ((0, 1), (1, 2), (0, 3))


def _steps_of_toes() -> tuple:
    stands = torch.tensor([[1, 1], [1, 0], [1, 1], [0, 1], [1, 1], [1, 1]], dtype=torch.bool)
    return _normal(6, 4, 3, seed=71), stands, (1, 3)


TWINS["13"] = {
    "x0_hat_loop": Twin(
        lambda x_s, s, eps_hat, alpha_bar: prediction.x0_from_eps(x_s, s, eps_hat, LINEAR),
        lambda: (
            _normal(3, 5, 2),
            torch.tensor([1, 40, 100]),
            _normal(3, 5, 2, seed=72),
            LINEAR.alpha_bar,
        ),
    ),
    "lengths_loop": Twin(kinematic_loss.bone_lengths, _shaken_chain),
    "skeleton_loop": Twin(kinematic_loss.skeleton_loss, lambda: (_normal(2, 5, 3, seed=73),)),
    "asymmetry_loop": Twin(
        kinematic_loss.asymmetry_loss, lambda: (_normal(2, 5, 6, seed=74), ((0, 2), (1, 5)))
    ),
    "slide_loop": Twin(
        lambda motion, planted, toes: kinematic_loss.slide_loss(motion[None], planted[None], toes)[
            0
        ],
        _steps_of_toes,
    ),
}


def _short_dance() -> np.ndarray:
    return np.random.default_rng(62).normal(size=(11, 3, 3)).cumsum(0) / 50 + 1.0


def _stops_and_beats() -> tuple:
    rng = np.random.default_rng(63)
    return np.sort(rng.uniform(0, 9, 7)), np.sort(rng.uniform(0, 9, 13))


TWINS["14"] = {
    "speed_loop": Twin(dances.mean_speed, lambda: (_short_dance(), 25)),
    "alignment_loop": Twin(dances.beat_alignment, lambda: (*_stops_and_beats(), 0.2)),
    "chance_by_sum": Twin(
        dances.chance_level, lambda: (_stops_and_beats()[1], 9.0, 0.1), atol=1e-4
    ),
    "published_loop": Twin(
        lambda p: distributions.published_kinetic_features(p, 60), lambda: (_short_dance(),)
    ),
}


def _dropped(past, s, alpha_bar, rate, u, noise) -> torch.Tensor:
    return diffusion_dropout.diffusion_dropout(
        past, s, LINEAR, rate, torch.Generator().manual_seed(81)
    )


def _past_and_its_draws() -> tuple:
    """Seven pasts, and the throws and noises that the library draws from the same seed."""
    draw = torch.Generator().manual_seed(81)
    past = _normal(7, 5, 3, seed=80)
    u = torch.rand(7, generator=draw)
    noise = torch.randn(past.shape, generator=draw, dtype=past.dtype)
    return past, torch.arange(5, 75, 10), LINEAR.alpha_bar, 0.4, u, noise


UNIT = Scaler(torch.zeros(1), torch.ones(1))


def _ridge_by_dropout(xx, xy, past, alpha_bar) -> torch.Tensor:
    """Least squares on pasts that are always noised to one step.

    They have `past` frames, one number each.
    """
    clip = Windows(torch.zeros(9, 1), torch.zeros(9, 3), torch.arange(2), past, 1, *[UNIT] * 2)
    clean = linear_dropout.Products(xx, xy, torch.eye(1).double(), clip)
    dropped = linear_dropout.expected_products(
        clean, linear_dropout.noise_moments(1.0, torch.tensor([alpha_bar]))
    )
    return torch.linalg.solve(dropped.xx, dropped.xy)


def _products_of_six() -> tuple:
    inputs, weights = _normal(40, 6, seed=82), _normal(6, 1, seed=83)
    return inputs.T @ inputs / 40, inputs.T @ (inputs @ weights) / 40, 4, 0.36


TWINS["09"] = {
    "dropout_loop": Twin(_dropped, _past_and_its_draws),
    "ridge_of_one_step": Twin(_ridge_by_dropout, _products_of_six, atol=1e-5),
}


def _a_plane_half_known() -> tuple:
    """Seven points of a plane.

    Of three of them the first coordinate is given, of two the second.
    """
    schedule = ddpm.cosine_schedule(30)
    known = torch.zeros(7, 2, dtype=torch.bool)
    known[:3, 0], known[3:5, 1] = True, True
    denoise = exact.exact_denoiser(crossed_bars(), schedule)
    start, given = _normal(7, 2, seed=150), _normal(7, 2, seed=151)
    return (
        denoise,
        start,
        schedule,
        given,
        known,
        [30, 23, 15, 8],
        torch.Generator().manual_seed(152),
    )


def _inpainted(denoise, start, schedule, given, known, visited, generator) -> torch.Tensor:
    """The library's, by the steps that four of thirty visits."""
    loop = inbetweening.inpaint_steps(
        denoise, start, schedule, given, known, steps=len(visited), generator=generator
    )
    *_, last = loop
    return last.x_s


TWINS["15"] = {"masked_loop": Twin(_inpainted, _a_plane_half_known)}


def _two_texts() -> tuple:
    """Tokens of texts with three and with five words."""
    there = torch.arange(5) < torch.tensor([[3], [5]])
    return _normal(2, 5, 4, seed=160), there


TWINS["16"] = {"bag_loop": Twin(text.bag, _two_texts)}


def _texts_and_motions() -> tuple:
    texts = _normal(32, 3, seed=170).numpy()
    return texts, texts + 0.5 * _normal(32, 3, seed=171).numpy(), 2


def _of_one_pool(texts, motions, k) -> float:
    return distributions.r_precision(texts, motions, range(32), np.random.default_rng(0))[k - 1]


TWINS["17"] = {"r_precision_loop": Twin(_of_one_pool, _texts_and_motions)}
