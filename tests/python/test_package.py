"""The package needs neither MPI nor PETSc, its stubs fit, its examples and the page's run."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import undula
from conftest import MEASURED, PROGRAM, PROJECTED, SOURCE

FOREIGN = re.compile(r"lib(mpi|open-rte|open-pal|petsc|slepc|cgal)[^/]*\.so", re.IGNORECASE)


def test_neither_mpi_nor_petsc_is_loaded():
    script = f"""
import undula
model = undula.load({str(PROJECTED)!r})
model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[40, 50])
print(open("/proc/self/maps").read())
"""
    maps = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert "undula/_rom" in maps and "libhdf5" in maps
    assert not FOREIGN.search(maps)
    program = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
    assert FOREIGN.search(program), "the pattern finds nothing where both are"


def test_an_installed_package_is_whole(tmp_path):
    subprocess.run(
        ["cmake", "--install", os.environ["UNDULA_BUILD"], "--component", "python", "--prefix", tmp_path],
        check=True, capture_output=True,
    )  # fmt: skip
    (packages,) = tmp_path.glob("lib/python3*/site-packages")
    assert {path.name for path in Path(undula.__file__).parent.iterdir() if path.is_file()} == {
        path.name for path in (packages / "undula").iterdir()
    }
    script = f"import undula; print(undula.__file__, undula.load({str(PROJECTED)!r}).modes['velocity'])"
    done = subprocess.run(
        [sys.executable, "-c", script], env={"PYTHONPATH": str(packages)}, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == [str(packages / "undula/__init__.py"), "50"]


def test_the_version_is_that_of_the_program():
    said = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
    assert re.search(r"\b" + re.escape(undula.__version__) + r"\b", said.splitlines()[0])


def test_stubs_fit_the_module_and_the_package_its_types(tmp_path):
    # What pybind11 makes of classes: a metaclass of its own, and an __init__ where none can be called.
    allowed = tmp_path / "allowed"
    allowed.write_text(r"undula\._rom\.(Curve|Emulator|Hdf5File|MeasuredCurve|Period|ReducedModel)(\.__init__)?")
    stubs = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "undula._rom", "--allowlist", allowed], capture_output=True, text=True
    )
    assert stubs.returncode == 0, stubs.stdout + stubs.stderr
    package = Path(undula.__file__).parent
    types = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", "/dev/null", str(package)],
        capture_output=True, text=True,
    )  # fmt: skip
    assert types.returncode == 0, types.stdout + types.stderr


def test_arguments_of_the_stubs_are_those_of_the_module():
    def arguments(function):
        return [a.arg for a in function.args.args + function.args.kwonlyargs if a.arg != "self"]

    tree = ast.parse((Path(undula.__file__).parent / "_rom.pyi").read_text())
    compared = 0
    for item in tree.body:
        functions = [item] if isinstance(item, ast.FunctionDef) else getattr(item, "body", [])
        owner = undula if isinstance(item, ast.FunctionDef) else getattr(undula, getattr(item, "name", ""), None)
        for function in functions:
            if not isinstance(function, ast.FunctionDef) or function.decorator_list or function.name.startswith("__"):
                continue
            signature = getattr(owner, function.name).__doc__.splitlines()[0]
            inside = signature[signature.index("(") + 1 : signature.rindex(") ->")]
            assert re.findall(r"(?:^|, )(\w+): ", re.sub(r"^self: [\w.]+(, )?", "", inside)) == arguments(function)
            compared += 1
    assert compared >= 10


def test_everything_public_has_a_docstring_and_arrays_name_their_unit():
    for name in undula.__all__:
        item = getattr(undula, name)
        if name == "__version__":
            continue
        assert item.__doc__, name
        for attribute, value in vars(item).items() if isinstance(item, type) else ():
            if not attribute.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{attribute}"
    for name in undula.Curve.__dict__:
        if name.endswith(("_mmHg", "_l_per_min", "_mW", "_mm", "_V", "_Hz")):
            unit = name.rsplit("_", 1)[1].replace("min", "l/min")
            assert unit in getattr(undula.Curve, name).__doc__, name


def test_the_reference_is_that_of_the_docstrings():
    from undula import reference

    assert (SOURCE / "docs/python_reference.md").read_text() == reference.page()


def run_example(name, *words, folder):
    script = SOURCE / "apps/python/examples" / name
    done = subprocess.run(
        [sys.executable, script, *map(str, words)], capture_output=True, text=True, cwd=folder, timeout=200
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_example_hq_curve(tmp_path, emulator_by_voltage):
    printed = run_example("hq_curve.py", emulator_by_voltage, MEASURED, "hq.png", folder=tmp_path)
    rms = float(re.search(r"rms ([0-9.]+) l/min", printed).group(1))
    assert rms < 0.2  # the scene is calibrated to these data
    assert (tmp_path / "hq.png").stat().st_size > 10_000


def test_example_calibrate(tmp_path):
    scene, other = SOURCE / "data/scenes/wave_pump_bench.toml", SOURCE / "data/measured/corwave_120hz_0.63mm.csv"
    printed = run_example("calibrate.py", scene, MEASURED, other, "fitted.toml", "actuator.force_N_per_V=0.3:0.55", folder=tmp_path)
    force = float(re.search(r"force_N_per_V = ([0-9.]+)", printed).group(1))
    assert 0.4 < force < 0.48  # 0.42 of both curves with all inputs free: docs/drive.md
    rows = {line.split()[0]: list(map(float, line.split()[1:])) for line in printed.splitlines() if line.startswith(("fitted", "predicted"))}
    for before, after, scatter in rows.values():
        assert after < 0.3 * before and after < 2 * scatter
    assert (tmp_path / "fitted.toml").exists() and (tmp_path / "fitted.png").stat().st_size > 10_000


def test_example_speed_error(tmp_path):
    scene = SOURCE / "data/scenes/wave_pump_thin_gap.toml"
    printed = run_example("speed_error.py", MEASURED, "speed.png", scene, "thin_gap.cells=32,64,128", PROJECTED, folder=tmp_path)
    rows = {line[:56].strip(): line[56:].split() for line in printed.splitlines()[1:]}
    errors = [float(rows[f"thin gap, wave_pump_thin_gap.toml, thin_gap.cells={n}"][2]) for n in (32, 64)]
    assert errors[0] > errors[1] > 0 and len(rows) == 5
    seconds = [float(row[0]) for row in rows.values()]
    assert seconds[-1] < min(seconds[:-1])  # the reduced model is the fastest
    assert (tmp_path / "speed.png").stat().st_size > 10_000


def windkessel():
    sys.path.insert(0, str(SOURCE / "apps/python/examples"))
    try:
        import windkessel as module
    finally:
        sys.path.pop(0)
    return module


def test_example_windkessel(tmp_path, emulator_by_voltage):
    printed = run_example("windkessel.py", emulator_by_voltage, 120, 50, "beat.png", folder=tmp_path)
    rows = {line[:15].strip(): list(map(float, line[15:].split())) for line in printed.splitlines()[1:4]}
    pressure, low, high, flow, flow_low, flow_high = rows["as stated"]
    assert low < pressure < high and flow_low < flow < flow_high
    # Over a beat that repeats, what the pump gives is what the resistance takes.
    module = windkessel()
    assert flow * module.ML_PER_S_PER_L_PER_MIN == pytest.approx(
        pressure / module.RESISTANCE_MMHG_S_PER_ML, rel=2e-3
    )
    assert abs(float(re.search(r"gain (\S+) ml", printed).group(1))) < 0.05
    assert rows["plus its error"][3] > flow > rows["minus its error"][3]
    assert flow_high - flow_low > 1  # the ventricle is felt
    assert (tmp_path / "beat.png").stat().st_size > 10_000


def test_the_windkessel_of_a_linear_pump_is_the_exact_one():
    module = windkessel()
    slope, offset = 2.0, 180.0  # ml/s per mmHg, ml/s

    def pump(head):
        return offset - slope * head

    time, pressure = module.march(pump, lambda t: 0.0, beats=3, start_mmHg=20.0)
    rate = (slope + 1 / module.RESISTANCE_MMHG_S_PER_ML) / module.COMPLIANCE_ML_PER_MMHG
    rest = offset / (slope + 1 / module.RESISTANCE_MMHG_S_PER_ML)
    assert np.allclose(pressure, rest + (20 - rest) * np.exp(-rate * time), atol=1e-7)


def test_what_the_page_says_runs(tmp_path, monkeypatch, emulator_by_voltage):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").symlink_to(SOURCE / "data")
    (tmp_path / "pump.h5").symlink_to(emulator_by_voltage)
    page = (SOURCE / "docs/python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert len(blocks) >= 4
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    assert (tmp_path / "hq.png").stat().st_size > 10_000
