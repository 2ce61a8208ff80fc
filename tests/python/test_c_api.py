"""The C library: the curves of the command line, refusals in four parts, nothing of MPI, a program that is compiled against it."""

import ctypes
import math
import os
import re
import subprocess
import sys
import threading

import numpy as np
import pytest
import undula
from conftest import PROJECTED, SOURCE, curve_json

Double = ctypes.POINTER(ctypes.c_double)


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("c")
    words = ["cmake", "--install", os.environ["UNDULA_BUILD"], "--component", "c", "--prefix", folder]
    subprocess.run(words, check=True, capture_output=True)
    return folder.rename(folder.with_name("moved"))  # it does not depend on where


@pytest.fixture(scope="module")
def library(installed):
    library = ctypes.CDLL(str(installed / "lib/libundula_pump.so"))
    library.undula_version.restype = library.undula_last_error.restype = library.undula_pump_drive.restype = ctypes.c_char_p
    library.undula_pump_drive.argtypes = library.undula_pump_close.argtypes = [ctypes.c_void_p]
    library.undula_pump_open.argtypes = [ctypes.c_char_p, ctypes.POINTER(ctypes.c_void_p)]
    library.undula_pump_box.argtypes = [ctypes.c_void_p, Double, Double]
    asked = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double, Double, ctypes.c_size_t]
    library.undula_pump_curve.argtypes = [*asked, Double, Double, ctypes.POINTER(ctypes.c_int)]
    library.undula_pump_quantity.argtypes = [*asked, ctypes.c_char_p, Double]
    return library


def opened(library, file):
    pump = ctypes.c_void_p()
    assert library.undula_pump_open(str(file).encode(), ctypes.byref(pump)) == 0, library.undula_last_error()
    return pump


def numbers(values):
    return (ctypes.c_double * len(values))(*values)


def asked(library, pump, frequency, drive, heads):
    flow, error, inside = numbers(heads), numbers(heads), (ctypes.c_int * len(heads))()
    status = library.undula_pump_curve(pump, frequency, drive, numbers(heads), len(heads), flow, error, inside)
    assert status == 0, library.undula_last_error()
    return list(flow), list(error), list(inside)


def refused(library, status, *texts):
    assert status == 2
    message = library.undula_last_error().decode()
    for part in ("\n  seen:    ", "\n  allowed: ", "\n  where:   ", *texts):
        assert part in message


def test_curves_are_those_of_the_command_line(library, emulator_by_voltage, emulator_by_stroke):
    cases = [
        (PROJECTED, "stroke", 97.3, 0.41, [3, 12.5, 61]),
        (PROJECTED, "stroke", 120, 0.53, [-30, 50, 400]),
        (emulator_by_voltage, "voltage", 120, 43.7, [0, 33.3, 101]),
        (emulator_by_stroke, "stroke", 117, 0.53, [31, 44.4]),
    ]
    for file, drive, frequency, value, heads in cases:
        pump = opened(library, file)
        assert library.undula_pump_drive(pump) == (b"voltage_V" if drive == "voltage" else b"stroke_mm")
        points = curve_json(file, "--frequency", frequency, f"--{drive}", value, "--head=" + ",".join(map(str, heads)))["points"]
        flow, error, inside = asked(library, pump, frequency, value, heads)
        assert flow == [p["flow_l_per_min"] for p in points]
        assert [e if math.isfinite(e) else None for e in error] == [p["error_l_per_min"] for p in points]
        assert [bool(i) for i in inside] == [p["inside_training_box"] for p in points]
        power = numbers(heads)
        assert library.undula_pump_quantity(pump, frequency, value, numbers(heads), len(heads), b"holder_power_mW", power) == 0
        assert [p if math.isfinite(p) else None for p in power] == [p["holder_power_mW"] for p in points]
        low, high = numbers([0] * 3), numbers([0] * 3)
        assert library.undula_pump_box(pump, low, high) == 0
        assert list(zip(low, high)) == [tuple(v) for v in undula.load(file).training_box.values()]
        library.undula_pump_close(pump)
    library.undula_pump_close(None)


def test_wrong_input_is_refused_in_four_parts(library, tmp_path):
    pump = ctypes.c_void_p(17)
    refused(library, library.undula_pump_open(str(tmp_path / "none.h5").encode(), ctypes.byref(pump)), "no such file")
    assert not pump.value
    (tmp_path / "text.h5").write_text("nothing")
    refused(library, library.undula_pump_open(str(tmp_path / "text.h5").encode(), ctypes.byref(pump)), "text.h5")
    refused(library, library.undula_pump_open(None, ctypes.byref(pump)), "null pointer")
    refused(library, library.undula_pump_open(b"x", None), "null pointer")

    pump, one = opened(library, PROJECTED), numbers([50])
    curve = library.undula_pump_curve
    refused(library, curve(pump, 0, 0.5, one, 1, one, None, None), "frequency")
    refused(library, curve(pump, 120, -1, one, 1, one, None, None), "stroke")
    refused(library, curve(pump, math.nan, 0.5, one, 1, one, None, numbers_of_int()), "frequency")
    refused(library, curve(pump, 120, 0.5, numbers([math.nan]), 1, one, None, numbers_of_int()), "head")
    refused(library, curve(pump, 120, 0.5, one, 0, one, None, None), "count = 0")
    refused(library, curve(pump, 120, 0.5, None, 1, one, None, None), "head_mmHg")
    refused(library, curve(None, 120, 0.5, one, 1, one, None, None), "pump")
    refused(library, curve(pump, 120, 0.5, one, 1, None, None, None), "flow_l_per_min")
    refused(library, library.undula_pump_quantity(pump, 120, 0.5, one, 1, b"flow", one), "flow_l_per_min")
    refused(library, library.undula_pump_box(pump, None, one), "low or high")
    library.undula_pump_close(pump)


def numbers_of_int():
    return (ctypes.c_int * 1)()


def test_nobody_extrapolates_without_seeing_it(library):
    pump, flow = opened(library, PROJECTED), numbers([0])
    refused(library, library.undula_pump_curve(pump, 120, 0.53, numbers([90]), 1, flow, None, None), "head 90 mmHg is outside the trained 0 to 70 mmHg")
    assert library.undula_pump_curve(pump, 120, 0.53, numbers([60]), 1, flow, None, None) == 0
    inside = (ctypes.c_int * 1)(7)
    assert library.undula_pump_curve(pump, 120, 0.53, numbers([90]), 1, flow, None, inside) == 0 and inside[0] == 0
    library.undula_pump_close(pump)


def test_errors_belong_to_their_thread_and_threads_share_a_pump(library):
    pump, alone = opened(library, PROJECTED), None
    refused(library, library.undula_pump_open(None, None), "null pointer")
    heads = list(np.linspace(0, 70, 40))
    alone = asked(library, pump, 120, 0.53, heads)
    answers = []

    def ask():
        assert library.undula_last_error() == b""
        answers.append(asked(library, pump, 120, 0.53, heads))

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert answers == [alone] * 3
    library.undula_pump_close(pump)


def test_the_library_shows_its_functions_alone_and_loads_no_mpi(installed, library):
    file = installed / "lib/libundula_pump.so"
    names = subprocess.run(["nm", "-D", "--defined-only", file], capture_output=True, text=True, check=True).stdout.split("\n")
    shown = {line.split()[-1].split("@")[0] for line in names if line}
    header = (installed / "include/undula_pump.h").read_text()
    assert shown == set(re.findall(r"\b(undula_\w+)\(", re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)))
    needed = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
    assert "libhdf5" in needed and not re.search(r"lib(mpi|open-rte|petsc|slepc)", needed)
    assert library.undula_version().decode() == re.search(r'UNDULA_PUMP_VERSION "(.*)"', header).group(1)


def compiled(installed, source):
    """A program of strict C99, compiled by what pkg-config says."""
    environment = {**os.environ, "PKG_CONFIG_PATH": str(installed / "lib/pkgconfig")}
    flags = subprocess.run(
        ["pkg-config", "--cflags", "--libs", "undula_pump"], env=environment, capture_output=True, text=True, check=True
    ).stdout.split()  # fmt: skip
    strict = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    program = installed / source.stem
    subprocess.run(["cc", *strict, source, "-o", program, *flags, f"-Wl,-rpath,{installed}/lib", "-lm"], check=True)
    # C++ takes the header as well.
    (installed / "x.cpp").write_text('#include "undula_pump.h"\nint main() { return undula_version() == nullptr; }\n')
    subprocess.run(["c++", "-std=c++11", *strict[1:], installed / "x.cpp", "-o", installed / "x", *flags], check=True)
    return program


def test_what_the_page_says_runs(installed):
    (text,) = re.findall(r"```c\n(.*?)```", (SOURCE / "docs/c_api.md").read_text(), re.DOTALL)
    (installed / "page.c").write_text(text)
    said = subprocess.run([compiled(installed, installed / "page.c")], cwd=SOURCE, capture_output=True, text=True, check=True).stdout
    curve = undula.load(PROJECTED).curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[40, 50, 60])
    assert said == "".join("%g mmHg  %.3f -+ %.3f l/min\n" % row for row in zip(curve.head_mmHg, curve.flow_l_per_min, curve.error_l_per_min))


def test_a_circulation_in_c_beats_as_the_one_in_python(installed, emulator_by_voltage):
    windkessel = compiled(installed, SOURCE / "apps/c/examples/windkessel.c")
    said = subprocess.run([windkessel, emulator_by_voltage, "120", "50"], capture_output=True, text=True, check=True).stdout
    pressure, low, high, flow = map(float, re.findall(r"[0-9]+\.[0-9]+", said))

    sys.path.insert(0, str(SOURCE / "apps/python/examples"))
    import windkessel as example

    sys.path.pop(0)
    pump = example.sampled_pump(undula.load(emulator_by_voltage), 120, {"voltage_V": 50})
    _, pressures, flows = example.last_beat(pump, example.ventricle_mmHg)
    flows = flows / example.ML_PER_S_PER_L_PER_MIN
    assert (pressure, low, high) == pytest.approx((pressures[:-1].mean(), pressures[:-1].min(), pressures[:-1].max()), abs=1e-4)
    assert flow == pytest.approx(flows[:-1].mean(), abs=1e-5) and 1 < flow < 10

    done = subprocess.run([windkessel, PROJECTED, "500", "0.5"], capture_output=True, text=True)
    assert done.returncode == 2 and "outside of the model's box" in done.stderr and "where:" in done.stderr
    done = subprocess.run([windkessel, "none.h5", "120", "0.5"], capture_output=True, text=True)
    assert done.returncode == 2 and "no such file" in done.stderr
