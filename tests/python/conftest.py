"""What the tests of the Python package share. ctest sets UNDULA (the program), UNDULA_SOURCE, UNDULA_BUILD, PYTHONPATH."""

import json
import os
import subprocess
from pathlib import Path

import matplotlib
import pytest

matplotlib.use("Agg")

SOURCE = Path(os.environ["UNDULA_SOURCE"])
PROGRAM = os.environ["UNDULA"]
PROJECTED = SOURCE / "data/models/wave_pump_fixed.h5"
MEASURED = SOURCE / "data/measured/corwave_120hz_0.53mm.csv"


def run_undula(*words, folder=None, exit_code=0):
    """Output and log of the program. Fails where it ends with another exit code."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=200)
    assert done.returncode == exit_code, done.stderr
    return done.stdout, done.stderr


def curve_json(*words):
    return json.loads(run_undula("hq", *words, "--json")[0])


def train_emulator(folder, scene, settings):
    words = ["train", SOURCE / "data/scenes" / scene, "--output", "model.h5", "--set", "training.model=emulator"]
    for setting in settings:
        words += ["--set", setting]
    run_undula(*words, folder=folder)
    return folder / "model.h5"


@pytest.fixture(scope="session")
def emulator_by_voltage(tmp_path_factory):
    return train_emulator(
        tmp_path_factory.mktemp("by_voltage"),
        "wave_pump_bench_calibrated.toml",
        [
            "training.frequency_low_Hz=120", "training.frequency_high_Hz=120",
            "training.voltage_low_V=40", "training.voltage_high_V=55",
            "training.head_low_mmHg=0", "training.head_high_mmHg=110",
            "training.training_points=20", "training.held_out_points=4",
        ],
    )  # fmt: skip


@pytest.fixture(scope="session")
def emulator_by_stroke(tmp_path_factory):
    return train_emulator(
        tmp_path_factory.mktemp("by_stroke"),
        "wave_pump_thin_gap.toml",
        [
            "training.frequency_low_Hz=100", "training.frequency_high_Hz=130",
            "training.stroke_low_mm=0.4", "training.stroke_high_mm=0.6",
            "training.head_low_mmHg=30", "training.head_high_mmHg=60",
            "training.training_points=6", "training.held_out_points=0",
        ],
    )  # fmt: skip
