"""What the tests of the Python package share. ctest sets UNDULA (the program), UNDULA_SOURCE, UNDULA_BUILD, PYTHONPATH."""

import http.client
import json
import os
import re
import signal
import socket
import subprocess
from pathlib import Path

import matplotlib
import pytest

matplotlib.use("Agg")

SOURCE = Path(os.environ["UNDULA_SOURCE"])
PROGRAM = os.environ["UNDULA"]
PROJECTED = SOURCE / "data/models/wave_pump_fixed.h5"
OTHER = SOURCE / "data/models/wave_pump_mapped_voltage.h5"  # an emulator driven by a voltage
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


class Explorer:
    """A running `undula explore`."""

    def __init__(self, *words):
        self.process = subprocess.Popen([PROGRAM, "explore", *map(str, words)], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        self.port = int(re.fullmatch(r"http://127\.0\.0\.1:(\d+)/", self.url).group(1))

    def ask(self, path, method="GET", body=None, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, path, body=body, headers=headers or {})
        response = connection.getresponse()
        text = response.read()
        connection.close()
        return response, text

    def send(self, request, more=False):
        """Raw bytes, and the answer; empty where the connection is closed without one. With `more` the server is not
        told that nothing follows: one that sees the end of a connection may leave its answer out."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=20) as stream:
            try:
                stream.sendall(request)
                if not more:
                    stream.shutdown(socket.SHUT_WR)
                answer = b""
                while part := stream.recv(65536):
                    answer += part
            except (ConnectionResetError, BrokenPipeError):
                return b""
        return answer

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=20)



@pytest.fixture(scope="module")
def explorer(emulator_by_stroke):
    """The shipped projected model, an emulator driven alike, and one that a voltage drives."""
    running = Explorer(PROJECTED, emulator_by_stroke, OTHER, "--data", MEASURED)
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="module")
def explorer_by_voltage(emulator_by_voltage):
    running = Explorer(emulator_by_voltage, OTHER, "--data", MEASURED)
    yield running
    assert running.stop() == 0
