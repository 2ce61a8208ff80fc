"""Fields of a projected model: those of the full-order run that it was trained on, drawn from the file alone."""

import numpy as np
import pytest
import undula
from conftest import PROJECTED, SOURCE

SCENE = SOURCE / "data/scenes/wave_pump_fixed.toml"
COARSE = {"mesh.gap_elements": 2, "mesh.channel_size_mm": 1.5, "mesh.growth": 1, "time.steps_per_period": 24}
# One frequency and stroke, two heads.
BOX = {
    **COARSE, "time.periods": 30, "training.frequency_low_Hz": 120, "training.frequency_high_Hz": 120,
    "training.stroke_low_mm": 0.3, "training.stroke_high_mm": 0.3, "training.head_low_mmHg": 0, "training.head_high_mmHg": 20,
    "training.training_points": 0, "training.held_out_points": 1, "training.snapshots_per_period": 24,
}  # fmt: skip


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fields")
    return undula.train(SCENE, BOX, output=folder / "model.h5", fields=True)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The full order at a corner of the box; fields of its last period."""
    settings = {**COARSE, "time.periods": 12, "output.fields_every": 4, "operating_point.stroke_mm": 0.3, "operating_point.head_mmHg": 20}
    with pytest.warns(undula.RunWarning):  # what a mesh so coarse is not good for
        return undula.solve(SCENE, settings, output=tmp_path_factory.mktemp("full") / "run")


def distance(pairs):
    """Relative, over all instants."""
    return (sum(np.sum((a - b) ** 2) for a, b in pairs) / sum(np.sum(b**2) for _, b in pairs)) ** 0.5


def test_flow_and_pressure_are_those_of_a_full_order_run(trained, run):
    fluid = undula.fields(trained.load(), frequency_Hz=120, head_mmHg=20, stroke_mm=0.3)["fluid"]
    assert len(fluid) == 24 and fluid.times_s[1] == pytest.approx(1 / 24 / 120)
    last = [frame for frame in run.fields("fluid") if frame.time_s > 11 / 120 + 1e-9]
    assert len(last) == 6
    for name, unit in (("velocity", "cm/s"), ("pressure", "dyn/cm^2")):
        pairs = []
        for frame in last:
            drawn = fluid[round(frame.time_s * 120 * 24) % 24]
            assert (drawn.points_cm == frame.points_cm).all() and (drawn.cells == frame.cells).all()
            assert drawn.units[name] == frame.units[name] == unit
            assert drawn.values[name].shape == frame.values[name].shape
            pairs.append((drawn.values[name], frame.values[name]))
        assert distance(pairs) < 0.05, name
        # Half a period off they are not: the comparison is none of means.
        assert distance([(pairs[i][0], pairs[(i + 3) % 6][1]) for i in range(6)]) > 0.3, name


def test_displacements_are_those_of_the_recorded_run(trained):
    """A run of some periods has not its mean displacement yet; the record holds the state that repeats."""
    records, _ = undula.read_records(str(trained.file) + ".runs")
    (record,) = [r for r in records if r.numbers["point/head"] > 26_000]
    assert record.units["snapshots/displacement"] == "cm"
    solids = undula.fields(trained.load(), frequency_Hz=120, head_mmHg=20, stroke_mm=0.3)["solids"]
    steps = [round(time * 120 * 24) % 24 for time in record.numbers["times"]]
    pairs = [(solids[s].values["displacement"][:, :2].ravel(), d) for s, d in zip(steps, record.numbers["snapshots/displacement"])]
    assert distance(pairs) < 0.02
    assert distance([(pairs[i][0], pairs[(i + 12) % 24][1]) for i in range(24)]) > 0.1


def test_fields_belong_to_the_period(trained):
    model = trained.load()
    period = model.period(frequency_Hz=120, head_mmHg=10, stroke_mm=0.3)
    fields = undula.fields(model, frequency_Hz=120, head_mmHg=10, stroke_mm=0.3)
    # The points of the solids reach as far as the probes along the membrane, which lie between them.
    for instant in (0, 6, 17):
        axial = 10 * fields["solids"][instant].values["displacement"][:, 1]
        probes = period.membrane_mm[:, instant]
        assert (axial.min(), axial.max()) == pytest.approx((probes.min(), probes.max()), abs=0.005 * np.ptp(probes))
    axes = undula.plot(fields["fluid"][6], name="velocity")
    assert axes.collections[0].get_array().max() == pytest.approx(np.linalg.norm(fields["fluid"][6].values["velocity"], axis=1).max())
    with pytest.raises(IndexError):
        fields["fluid"][24]


def test_a_model_with_fields_answers_as_one_without(trained, tmp_path):
    again = undula.train(SCENE, BOX, output=tmp_path / "plain.h5", campaign=str(trained.file) + ".runs")
    question = dict(frequency_Hz=120, stroke_mm=0.3, heads_mmHg=[0, 7, 20])
    assert (again.load().curve(**question).flow_l_per_min == trained.load().curve(**question).flow_l_per_min).all()
    assert again.file.stat().st_size < trained.file.stat().st_size
    with pytest.raises(undula.InputError, match="keeps no fields"):
        undula.fields(again.load(), frequency_Hz=120, head_mmHg=10, stroke_mm=0.3)
    with pytest.raises(undula.InputError) as error:
        undula.fields(undula.load(PROJECTED), frequency_Hz=120, head_mmHg=50, stroke_mm=0.53)
    assert "--fields" in error.value.allowed and error.value.where == str(PROJECTED)


def test_models_that_know_no_fields_refuse_to_keep_them(tmp_path):
    thin = SOURCE / "data/scenes/wave_pump_thin_gap.toml"
    with pytest.raises(undula.InputError, match="keeps no fields"):
        undula.train(thin, {"training.model": "emulator"}, output=tmp_path / "x.h5", fields=True)
    assert not list(tmp_path.iterdir())
