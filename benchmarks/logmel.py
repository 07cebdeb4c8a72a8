"""Log-Mel of one minute of sound: ours compared with warm librosa, on one thread, in one run.

`bench.logmel_x` has librosa at our settings (window of 1024 samples),
`bench.logmel_x_default_window` at its own 2048. Each repeat times all of them, the best of three,
in changing order; a record is the median of the ratios of repeats. Run: python benchmarks/logmel.py
[--repeats 40] [--out benchmarks/results/logmel.json]
"""

import argparse

import librosa
import numpy as np
import torch
from records import record, show, write_records
from timing import in_turn

from motiondiff_edu.conditions import music

SECONDS = 60
COMMAND = "python -m benchmarks mel"


def noise() -> np.ndarray:
    return np.random.default_rng(0).normal(0, 0.1, SECONDS * music.SAMPLE_RATE).astype(np.float32)


def theirs(audio: np.ndarray, n_fft: int) -> np.ndarray:
    framing = {"sr": music.SAMPLE_RATE, "n_fft": n_fft, "hop_length": music.HOP}
    mel = librosa.feature.melspectrogram(
        y=audio, n_mels=music.BANDS, fmin=music.F_MIN, fmax=music.F_MAX, **framing
    )
    return np.log(np.maximum(mel, music.FLOOR))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=40)
    parser.add_argument("--out", default="benchmarks/results/logmel.json")
    args = parser.parse_args()
    torch.set_num_threads(1)
    audio = noise()
    sound = torch.from_numpy(audio)
    np.testing.assert_allclose(
        music.log_mel(sound, music.SAMPLE_RATE).numpy(), theirs(audio, music.N_FFT).T, atol=1e-4
    )
    times = in_turn(
        {
            "ours": lambda: music.log_mel(sound, music.SAMPLE_RATE),
            "librosa": lambda: theirs(audio, music.N_FFT),
            "default_window": lambda: theirs(audio, 2048),
        },
        args.repeats,
        best_of=3,
        warmup=3,
    )
    milliseconds = {"unit": "ms", "command": COMMAND}
    records = [
        record("bench.logmel_ms_per_minute", times["ours"], **milliseconds),
        record("bench.logmel_ms_per_minute.librosa", times["librosa"], **milliseconds),
        record("bench.logmel_x", times["librosa"] / times["ours"], unit="ratio", command=COMMAND),
        record(
            "bench.logmel_x_default_window",
            times["default_window"] / times["ours"],
            unit="ratio",
            command=COMMAND,
        ),
    ]
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
