"""Every file that Undula writes is read."""

import json

import numpy as np
import pytest
import undula
from conftest import MEASURED, PROJECTED, SOURCE, run_undula


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of a short run of thin gaps."""
    folder = tmp_path_factory.mktemp("run")
    run_undula(
        "solve", SOURCE / "data/scenes/wave_pump_thin_gap.toml", "--output", folder / "run",
        "--set", "time.periods=2", "--set", "output.fields_every=50",
    )  # fmt: skip
    return folder / "run"


def test_every_table_of_a_run_is_read(run):
    tables = sorted(run.glob("*.csv"))
    assert {"time_series.csv", "membrane.csv", "cycle_means.csv", "envelope.csv"} <= {t.name for t in tables}
    for file in tables:
        table = undula.read_table(file)
        rows = [line for line in file.read_text().splitlines() if line and not line.startswith("#")]
        assert list(table) == rows[0].split(",")
        for place, values in enumerate(table.values()):
            assert len(values) == len(rows) - 1
            assert float(values[-1]) == float(rows[-1].split(",")[place])
    series = undula.read_table(run / "time_series.csv")
    means = undula.read_table(run / "cycle_means.csv")
    steps = len(series["outflow_l_per_min"]) // 2
    assert series["outflow_l_per_min"][-steps:].mean() == pytest.approx(means["mean_outflow_l_per_min"][-1], rel=1e-9)


def test_every_hdf5_file_of_a_run_is_read(run):
    files = sorted(run.rglob("*.h5"))
    assert files
    for file in files:
        contents = undula.Hdf5File(file)
        assert contents.sealed
        assert contents.names()
        for name in contents.names():
            value = contents.read(name)
            assert isinstance(value, (np.ndarray, str)), name


def test_hdf5_numbers_keep_shape_and_unit():
    contents = undula.Hdf5File(PROJECTED)
    modes = undula.load(PROJECTED).modes
    total = sum(modes.values())
    assert contents.read("operators/mass").shape == (total, total)
    assert contents.unit("operators/mass") == "g"
    assert contents.read("references/held_out").dtype == np.int64
    assert (contents.read("training_box/head") == [0, 70]).all()
    assert contents.read("steps_per_period").shape == ()
    with pytest.raises(undula.InputError, match="no dataset"):
        contents.read("operators/none")
    with pytest.raises(undula.InputError, match="neither numbers nor a text"):
        contents.read("operators")


def test_recorded_curves_of_models_and_scenes_are_read(tmp_path, emulator_by_voltage):
    words = ["hq", emulator_by_voltage, "--frequency", 120, "--voltage", "42,48", "--head", "20,40,300", "--json"]
    text = run_undula(*words)[0]
    (tmp_path / "curves.json").write_text(text)
    curves = undula.read_curves(tmp_path / "curves.json")
    assert [curve.voltage_V for curve in curves] == [42, 48]
    for curve, record in zip(curves, json.loads(text)["curves"]):
        assert list(curve.flow_l_per_min) == [point["flow_l_per_min"] for point in record["points"]]
        assert list(curve.columns["holder.stroke_mm"]) == [p["holder"]["stroke_mm"] for p in record["points"]]
        assert np.isnan(curve.error_l_per_min[2]) and list(curve.inside_training_box) == [True, True, False]
        assert undula.plot_curve(curve).lines

    scene = ["hq", SOURCE / "data/scenes/wave_pump_thin_gap.toml", "--head", "50", "--json"]
    (tmp_path / "scene.json").write_text(run_undula(*scene)[0])
    (curve,) = undula.read_curves(tmp_path / "scene.json")
    assert curve.level == "thin gap" and curve.stroke_mm == 0.53 and curve.inside_training_box.all()


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"points": [1]}', "null", '{"points": [], "level": "x"}'])
def test_what_is_no_curve_is_refused(tmp_path, text):
    (tmp_path / "no.json").write_text(text)
    with pytest.raises(undula.InputError, match="allowed: what `undula hq"):
        undula.read_curves(tmp_path / "no.json")


def test_tables_that_are_cut_off_are_refused(tmp_path):
    (tmp_path / "cut.csv").write_text("# comment\na,b\n1,2\n3\n")
    with pytest.raises(undula.InputError, match="cut.csv:4"):
        undula.read_table(tmp_path / "cut.csv")
    (tmp_path / "empty.csv").write_text("# comment\n")
    with pytest.raises(undula.InputError, match="no header"):
        undula.read_table(tmp_path / "empty.csv")
    with pytest.raises(undula.InputError, match="cannot be read"):
        undula.read_table(tmp_path / "none.csv")


def test_measured_points_are_those_of_the_file():
    curve = undula.read_measured(MEASURED)
    lines = [l for l in MEASURED.read_text().splitlines() if l and not l.startswith("#")][1:]
    samples = sorted(tuple(map(float, line.split(","))) for line in lines)
    assert list(zip(curve.head_mmHg, curve.flow_l_per_min)) == samples
    assert (curve.frequency_Hz, curve.stroke_mm, curve.voltage_V) == (120, 0.53, 40)
    coefficients = np.polyfit(curve.head_mmHg, curve.flow_l_per_min, 2)
    assert np.allclose(curve.fit([45, 55]), np.polyval(coefficients, [45, 55]), rtol=1e-9)
    with pytest.raises(undula.InputError, match="outside the measured curve"):
        curve.fit(100)
