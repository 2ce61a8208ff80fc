"""Scenes by the program: answers are those of the command line, interrupts keep checkpoints, failures carry their parts."""

import json
import os
import re
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import undula
from conftest import MEASURED, PROJECTED, SOURCE, curve_json, run_undula

THIN = SOURCE / "data/scenes/wave_pump_thin_gap.toml"
BAD_SCENES = sorted((SOURCE / "tests/data/bad/scenes").glob("*.toml"))


def without_seconds(report):
    """Times of computing differ from run to run."""
    if isinstance(report, dict):
        return {k: without_seconds(v) for k, v in report.items() if k not in ("seconds", "phases", "seconds_per_point", "preparation_seconds")}
    return [without_seconds(one) for one in report] if isinstance(report, list) else report


def own_children():
    return Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()


def test_check_is_that_of_the_command_line_and_takes_settings_of_all_kinds():
    assert undula.check(THIN) == json.loads(run_undula("check", THIN, "--json")[0])
    found = undula.check(THIN, {"time.periods": np.int64(7), "fluid.viscosity_poise": np.float64(0.041), "thin_gap.friction": "oscillatory"})
    assert 'friction = "oscillatory"' in found["resolved"] and "periods = 7" in found["resolved"] and "0.041" in found["resolved"]
    flap = SOURCE / "data/scenes/flap_in_channel.toml"
    lists = undula.check(flap, {"domain.body_force_dyn_per_cm3": (0, "2*t")})
    assert 'body_force_dyn_per_cm3 = ["0.0", "2*t"]' in lists["resolved"]
    with pytest.raises(undula.InputError) as error:
        undula.check(THIN, {"time.periods": {1, 2}})
    assert error.value.where == "settings" and "set" in error.value.seen


@pytest.mark.parametrize("file", BAD_SCENES[::12], ids=lambda file: file.stem)
def test_what_a_scene_must_not_be_is_told_in_four_parts(file):
    with pytest.raises(undula.InputError) as error:
        undula.check(file)
    told = run_undula("check", file, exit_code=2)[1]
    assert f"undula: {error.value}\n" in told
    for part in ("what", "seen", "allowed", "where"):
        assert getattr(error.value, part), part
    assert error.value.what == told[told.index("undula: ") + 8 :].splitlines()[0]


def test_a_run_is_computed_with_progress_and_read(tmp_path):
    seen = []
    settings = {"time.periods": 3, "output.fields_every": 108}
    run = undula.solve(THIN, settings, output=tmp_path / "run", progress=seen.append)
    assert seen and all(p.label == "solve" and p.total == 216 for p in seen)
    assert [p.done for p in seen] == sorted(p.done for p in seen) and seen[-1].done == 216 and seen[-1].seconds_left is None
    assert run.report["last_step"] == 216 and len(run.time_series["time_s"]) == 216
    assert run.tables == ["cycle_means", "envelope", "membrane", "time_series"]
    assert run.report["periods"][2]["outflow_l_per_min"] == pytest.approx(run.table("cycle_means")["mean_outflow_l_per_min"][2], rel=1e-9)
    assert [file.name for file in run.checkpoints] == ["checkpoint_144.h5", "checkpoint_216.h5"]
    assert run.seconds["solve"] == run.report["phases"]["solve"]["seconds"] and "periods = 3" in run.scene_text

    # Fields are those of the files, on the mesh of the series.
    again = undula.read_run(tmp_path / "run")
    assert again.report is None and again.series == ["fluid", "solids"]
    fluid = again.fields("fluid")
    assert len(fluid) == 2 and fluid.times_s == pytest.approx([108 / 72 / 120, 216 / 72 / 120])
    frame = fluid[1]
    stored = undula.Hdf5File(tmp_path / "run/fluid_216.h5")
    assert (frame.values["velocity"] == stored.read("fields/velocity")).all() and frame.units["velocity"] == "cm/s"
    assert frame.cells.max() < len(frame.points_cm) == len(frame.values["pressure"])
    area = frame.points_cm[frame.cells][:, :, :2]
    doubled = np.cross(area[:, 1] - area[:, 0], area[:, 2] - area[:, 0])
    assert (np.abs(doubled) > 0).all()
    with pytest.raises(undula.InputError, match='no table "nothing"'):
        again.table("nothing")
    with pytest.raises(undula.InputError, match='no fields "nothing"'):
        again.fields("nothing")
    with pytest.raises(undula.InputError, match="the folder holds no run"):
        undula.read_run(tmp_path)
    (tmp_path / "run/fluid.xdmf").write_text("<Xdmf><Domain>")
    with pytest.raises(undula.InputError, match="series of fields cannot be read"):
        again.fields("fluid")

    # The folder is not replaced unless that is asked for.
    with pytest.raises(undula.InputError) as error:
        undula.solve(THIN, settings, output=tmp_path / "run")
    assert "run" in error.value.where and error.value.allowed
    undula.solve(THIN, {"time.periods": 1}, output=tmp_path / "run", force=True)


def interrupt_when(reached):
    """Progress that sends the signal of Ctrl-C to this process once."""
    sent = []

    def look(progress):
        if reached(progress) and not sent:
            sent.append(progress.done)
            os.kill(os.getpid(), signal.SIGINT)

    return look


def test_an_interrupted_run_keeps_a_checkpoint_and_goes_on_bit_for_bit(tmp_path):
    settings = {"time.periods": 30, "output.checkpoint_every": 0}
    undula.solve(THIN, settings, output=tmp_path / "whole")
    before = own_children()
    with pytest.raises(KeyboardInterrupt) as stopped:
        undula.solve(THIN, settings, output=tmp_path / "run", progress=interrupt_when(lambda p: p.done > 100))
    kept = re.search(r"kept in: (\S+)", str(stopped.value))
    assert "stopped by SIGINT after step" in str(stopped.value) and kept and Path(kept.group(1)).is_file()
    assert own_children() == before
    steps = len(undula.read_run(tmp_path / "run").time_series["time_s"])
    assert 100 < steps < 2160
    run = undula.solve(THIN, settings, output=tmp_path / "run", restart=True)
    assert run.report["first_step"] == steps and run.report["last_step"] == 2160
    assert (tmp_path / "run/time_series.csv").read_bytes() == (tmp_path / "whole/time_series.csv").read_bytes()


def test_an_exception_of_the_callback_stops_the_program(tmp_path):
    class Enough(Exception):
        pass

    def tell(progress):
        raise Enough

    before = own_children()
    with pytest.raises(Enough):
        undula.solve(THIN, {"time.periods": 1000}, output=tmp_path / "run", progress=tell)
    assert own_children() == before
    assert len(undula.read_run(tmp_path / "run").checkpoints) >= 1


def program(folder, text, monkeypatch, shell="/bin/bash"):
    """A program of another kind in the place of undula."""
    file = folder / "undula"
    file.write_text(f"#!{shell}\n{text}")
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("UNDULA", str(file))
    return file


def test_a_second_interrupt_ends_a_program_that_does_not_stop(tmp_path, monkeypatch):
    text = """import signal, sys, time
signal.signal(signal.SIGINT, lambda *_: signal.signal(signal.SIGINT, signal.SIG_DFL))
print('{"progress":"x","done":1,"total":2,"seconds_left":null}', file=sys.stderr, flush=True)
time.sleep(60)
"""
    program(tmp_path, text, monkeypatch, shell=sys.executable)

    def twice():
        for _ in range(2):
            time.sleep(0.5)
            os.kill(os.getpid(), signal.SIGINT)

    before, begin = own_children(), time.monotonic()
    threading.Thread(target=twice).start()
    with pytest.raises(KeyboardInterrupt):
        undula.check("x.toml")
    assert time.monotonic() - begin < 8 and own_children() == before


def test_ctrl_c_of_a_terminal_reaches_the_program_once(tmp_path, monkeypatch):
    """A terminal sends the signal to the whole group; the second one would end the program without a checkpoint."""
    text = """import signal, sys, time
seen = []
signal.signal(signal.SIGINT, lambda *_: seen.append(1))
print('{"progress":"x","done":1,"total":2,"seconds_left":null}', file=sys.stderr, flush=True)
for _ in range(20):
    time.sleep(0.05)
sys.exit(f"undula: stopped by {len(seen)} signals")
"""
    program(tmp_path, text, monkeypatch, shell=sys.executable)
    caller = """import undula
try:
    undula.solve("x.toml", progress=lambda p: print(p.done, flush=True))
except KeyboardInterrupt as stopped:
    print(stopped)
"""
    process = subprocess.Popen([sys.executable, "-c", caller], stdout=subprocess.PIPE, text=True, start_new_session=True)
    assert process.stdout.readline() == "1\n"
    os.killpg(process.pid, signal.SIGINT)
    assert process.communicate(timeout=60)[0] == "stopped by 1 signals\n"


def test_how_a_program_ends_decides_the_exception(tmp_path, monkeypatch):
    program(tmp_path, r"printf 'info: on the way\nundula: it diverged\n  at:  step 3\n  try: shorter steps\n    or more\n' >&2; exit 1", monkeypatch)
    with pytest.raises(undula.NumericsError) as error:
        undula.check("x.toml")
    assert (error.value.what, error.value.at, error.value.to_try) == ("it diverged", "step 3", "shorter steps\n    or more")

    program(tmp_path, r"printf 'undula: stopped by SIGTERM after step 3 of 9\n  kept in: here\n' >&2; exit 1", monkeypatch)
    with pytest.raises(undula.ProgramError, match="stopped by SIGTERM after step 3 of 9\n  kept in: here"):
        undula.check("x.toml")
    program(tmp_path, "kill -9 $$", monkeypatch)
    with pytest.raises(undula.ProgramError, match="undula check ended by signal 9"):
        undula.check("x.toml")
    program(tmp_path, "echo no JSON", monkeypatch)
    with pytest.raises(undula.ProgramError, match="printed no JSON"):
        undula.check("x.toml")

    monkeypatch.setenv("UNDULA", str(tmp_path / "none"))
    with pytest.raises(undula.InputError) as error:
        undula.check("x.toml")
    assert error.value.what == "the program undula is not found" and str(tmp_path / "none") in error.value.seen
    monkeypatch.delenv("UNDULA")
    assert Path(undula.find_program()) == Path(os.environ["UNDULA_BUILD"]) / "undula"  # the one built with the package


def test_a_program_in_the_path_has_to_be_of_the_version_of_the_package(tmp_path, monkeypatch):
    import undula.program

    other = tmp_path / "undula"
    other.write_text("#!/bin/bash\necho undula 9.9.9\n")
    other.chmod(0o755)
    monkeypatch.delenv("UNDULA")
    monkeypatch.setattr(undula.program, "__file__", str(tmp_path / "a/b/c/d/program.py"))  # no program beside it
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    with pytest.raises(undula.InputError) as error:
        undula.find_program()
    assert error.value.seen == "undula 9.9.9" and undula.__version__ in error.value.allowed and error.value.where == str(other)
    other.write_text(f"#!/bin/bash\necho undula {undula.__version__}\n")
    undula.program._require_version.cache_clear()
    assert undula.find_program() == str(other)
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))
    with pytest.raises(undula.InputError, match="is not found"):
        undula.find_program()


def test_words_that_the_program_does_not_take_are_told_in_four_parts():
    with pytest.raises(undula.InputError) as error:
        undula.hq(PROJECTED, [40], frequency_Hz=120)
    assert "--stroke is required" in error.value.seen and error.value.allowed == "what `undula hq --help` names"


def test_warnings_of_the_program_are_warnings():
    with pytest.warns(undula.RunWarning, match="young"):
        undula.hq(THIN, 50, {"membrane.young_dyn_per_cm2": 1.9e7})


def test_curves_of_scenes_and_models_are_those_of_the_command_line():
    heads = [40, 47.25, 60]
    printed = curve_json(THIN, "--head", "40,47.25,60", "--stroke", 0.51)
    (curve,) = undula.hq(THIN, heads, stroke_mm=0.51)
    assert curve.level == "thin gap" and curve.stroke_mm == 0.51 and list(curve.head_mmHg) == heads
    assert list(curve.flow_l_per_min) == [p["flow_l_per_min"] for p in printed["points"]]
    assert list(curve.columns["holder.stroke_mm"]) == [p["holder"]["stroke_mm"] for p in printed["points"]]
    bench = SOURCE / "data/scenes/wave_pump_bench_calibrated.toml"
    with pytest.warns(undula.RunWarning, match="states materials.membrane.young"):
        curves = undula.hq(bench, [50], voltage_V=[40, 45])
    assert [c.voltage_V for c in curves] == [40, 45] and curves[0].flow_l_per_min < curves[1].flow_l_per_min
    (model,) = undula.hq(PROJECTED, heads, frequency_Hz=120, stroke_mm=0.53)
    asked = undula.load(PROJECTED).curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=heads)
    assert (model.flow_l_per_min == asked.flow_l_per_min).all() and (model.error_l_per_min == asked.error_l_per_min).all()
    with pytest.warns(undula.RunWarning):
        (band,) = undula.hq(bench, [50, 60], band=True)
    assert (band.error_l_per_min > 1).all()


def test_which_tier_answered_is_told(emulator_by_voltage):
    scene = SOURCE / "data/scenes/wave_pump_bench_calibrated.toml"
    with pytest.warns(undula.RunWarning):  # 115 mmHg lies outside of the emulator's box
        (curve,) = undula.hq(emulator_by_voltage, [60, 150], frequency_Hz=120, voltage_V=45, tolerance_l_per_min=1.0, then=scene)
    assert curve.texts["tier"][0] != curve.texts["tier"][1] and "scene" not in curve.texts["tier"][0]
    assert all(curve.texts["why"])
    asked = undula.load(emulator_by_voltage).curve(frequency_Hz=120, voltage_V=45, heads_mmHg=60)
    assert curve.flow_l_per_min[0] == asked.flow_l_per_min[0]


def test_a_scene_is_judged_and_fitted_as_by_the_command_line(tmp_path):
    found = undula.validate(THIN, MEASURED, points=3)
    assert found == json.loads(run_undula("validate", THIN, "--data", MEASURED, "--points", 3, "--json")[0])

    words = ["calibrate", THIN, "--data", MEASURED, "--free", "geometry.clearance_scale=0.9:1.1", "--points", 3, "--json"]
    printed = json.loads(run_undula(*words, "--output", tmp_path / "a.toml")[0])
    seen = []
    fit = undula.calibrate(THIN, MEASURED, free={"geometry.clearance_scale": (0.9, 1.1)}, points=3, output=tmp_path / "b.toml", progress=seen.append)
    assert without_seconds({**fit.report, "scene": "a"}) == without_seconds(printed)
    assert fit.optimum == {"geometry.clearance_scale": printed["keys"][0]["optimum"]}
    assert fit.standard_error["geometry.clearance_scale"] > 0 and fit.statements == printed["statements"]
    written = [(tmp_path / name).read_text().splitlines() for name in ("a.toml", "b.toml")]
    assert [line for line in written[0] if "name =" not in line] == [line for line in written[1] if "name =" not in line]
    assert seen and seen[-1].label.startswith("calibrate") and seen[-1].done == fit.report["curves_computed"]
    assert undula.plot(fit).lines
    with pytest.raises(undula.InputError, match="would replace a file"):
        undula.calibrate(THIN, MEASURED, free={"geometry.clearance_scale": (0.9, 1.1)}, output=tmp_path / "b.toml")
    with pytest.raises(undula.InputError, match="nothing is free"):
        undula.calibrate(THIN, MEASURED, output=tmp_path / "c.toml")


BOX = {
    "training.model": "emulator", "training.training_points": 20, "training.held_out_points": 1,
    "training.frequency_low_Hz": 120, "training.frequency_high_Hz": 120, "training.stroke_low_mm": 0.5, "training.stroke_high_mm": 0.6,
    "training.head_low_mmHg": 40, "training.head_high_mmHg": 60,
}  # fmt: skip


def test_a_model_is_trained_interrupted_and_finished(tmp_path):
    with pytest.raises(KeyboardInterrupt, match="runs stored in"):
        undula.train(THIN, BOX, output=tmp_path / "model.h5", progress=interrupt_when(lambda p: p.done < p.total))
    records, _ = undula.read_records(tmp_path / "model.h5.runs")
    assert 1 <= len(records) < 25 and not (tmp_path / "model.h5").exists()
    trained = undula.train(THIN, BOX, output=tmp_path / "model.h5")
    assert trained.file == tmp_path / "model.h5" and len(trained.report["runs"]) == 25
    records, unreadable = undula.read_records(tmp_path / "model.h5.runs")
    assert len(records) == 25 and unreadable == []
    model = trained.load()
    flows = sorted(model.runs["flow_l_per_min"])
    assert flows == pytest.approx(sorted(r.means()["outflow_l_per_min"][-1] for r in records), rel=1e-12)
    assert {r.units["point/head"] for r in records} == {"dyn/cm^2"}
    (tmp_path / "model.h5.runs/x.h5").write_bytes(b"nothing")
    assert len(undula.read_records(tmp_path / "model.h5.runs")[1]) == 1


def test_studies_and_reports_are_those_of_the_command_line(tmp_path):
    words = ["study", THIN, "--vary", "geometry.clearance_scale=0.95:1.05:2", "--output", tmp_path / "a", "--json"]
    printed = json.loads(run_undula(*words)[0])
    found = undula.study(THIN, {"geometry.clearance_scale": (0.95, 1.05, 2)}, output=tmp_path / "b")
    assert without_seconds({**found, "folder": ""}) == without_seconds({**printed, "folder": ""})
    assert undula.read_report(tmp_path / "b/study.json")["runs"] == found["runs"]
    records, _ = undula.read_records(tmp_path / "b")
    assert [r.means()["flow_l_per_min"][0] for r in records] == [run["quantities"]["flow_l_per_min"] for run in found["runs"]]

    words = ["report", THIN, PROJECTED, "--data", MEASURED, "--frequency", 120, "--stroke", 0.53, "--points", 2, "--vary", "thin_gap.cells=32,64"]
    printed = json.loads(run_undula(*words, "--json")[0])
    found = undula.report([THIN, PROJECTED], MEASURED, frequency_Hz=120, stroke_mm=0.53, points=2, vary={"thin_gap.cells": [32, 64]})
    assert without_seconds(found) == without_seconds(printed) and len(found["levels"]) == 4
    (tmp_path / "list.json").write_text("[1]")
    with pytest.raises(undula.InputError, match="holds no report"):
        undula.read_report(tmp_path / "list.json")


def test_several_processes_compute_one_run(tmp_path):
    launcher = ["mpirun", "--oversubscribe", "-np", "2"]
    if os.geteuid() == 0:
        launcher.insert(1, "--allow-run-as-root")
    run = undula.solve(THIN, {"time.periods": 1}, output=tmp_path / "run", launcher=launcher)
    assert run.report["ranks"] == 2


def test_anything_is_drawn_in_one_call(tmp_path):
    model = undula.load(PROJECTED)
    curve = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[40, 60])
    other = model.curve(frequency_Hz=120, stroke_mm=0.3, heads_mmHg=[40, 60])
    assert len(undula.plot([curve, other]).lines) == 2

    period = model.period(frequency_Hz=120, stroke_mm=0.53, head_mmHg=50)
    flows, place, reach = undula.plot(period).axes
    assert (flows.lines[0].get_ydata() == period.outflow_l_per_min).all() and (place.lines[0].get_ydata() == period.holder_mm).all()
    drawn = reach.collections[0].get_paths()[0].vertices[:, 1]
    assert drawn.max() == period.envelope_high_mm.max() and drawn.min() == period.envelope_low_mm.min()

    strokes, heads = [0.3, 0.4, 0.5], [20, 40, 60]
    flows = undula.flow_map(model, frequencies_Hz=120, strokes_mm=strokes, heads_mmHg=heads)
    axes = undula.plot(flows)
    assert "mmHg" in axes.get_ylabel() and axes.get_xlim() == (0.3, 0.5) and axes.get_ylim() == (20, 60)
    both = undula.flow_map(model, frequencies_Hz=[100, 120], strokes_mm=strokes, heads_mmHg=heads)
    with pytest.raises(undula.InputError, match="two axes"):
        undula.plot(both)

    run = undula.solve(THIN, {"time.periods": 1, "output.fields_every": 72}, output=tmp_path / "run")
    figure = undula.plot(run, columns=["outflow_l_per_min", "speed_max_cm_per_s"])
    assert [axes.get_ylabel() for axes in figure.axes] == ["outflow_l_per_min", "speed_max_cm_per_s"]
    assert (figure.axes[0].lines[0].get_ydata() == run.time_series["outflow_l_per_min"]).all()
    frame = run.fields("fluid")[0]
    axes = undula.plot(frame, name="velocity")
    shown = axes.collections[0].get_array()
    assert shown.max() == pytest.approx(np.linalg.norm(frame.values["velocity"], axis=1).max(), rel=1e-12)
    for thing in (frame, run):
        with pytest.raises(undula.InputError):
            undula.plot(thing, **({"name": "none"} if thing is frame else {"columns": ["none"]}))
    with pytest.raises(undula.InputError, match="a str"):
        undula.plot("curve")
