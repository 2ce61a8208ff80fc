"""Curves are those of the command line, to the last digit; periods and maps belong to them."""

import math

import numpy as np
import pytest
import undula
from conftest import MEASURED, PROJECTED, curve_json

# In the JSON of a point, beside columns of the same name.
NESTED = {
    "holder_stroke_mm": ("holder", "stroke_mm"),
    "actuator_power_mW": ("holder", "actuator_power_mW"),
    "electrical_power_mW": ("holder", "electrical_power_mW"),
    "efficiency_percent": ("holder", "efficiency_percent"),
    "scalar_stress_max_Pa": ("blood", "scalar_stress_max_Pa"),
    "stressed_volume_mm3": ("blood", "stressed_volume_mm3"),
}


def assert_same(curve, printed):
    """Every column of every point, bit for bit; null stands for what is not finite."""
    assert len(curve) == len(printed["points"])
    known = 0
    for name, values in curve.columns().items():
        for value, point in zip(values, printed["points"]):
            for key in NESTED.get(name, (name,)):
                point = point.get(key) if point is not None else None
            if point is None:
                assert not math.isfinite(value), name
            else:
                assert value == point, name
                known += 1
    assert known >= 4 * len(curve)
    assert curve.level == printed["level"]


@pytest.mark.parametrize(
    "frequency, stroke, heads",
    [(120, 0.53, [40, 47.25, 55, 60, 40]), (91.7, 0.31, [3, 12.5]), (120, 0.53, [-30, 200]), (200, 0.9, [50])],
)
@pytest.mark.filterwarnings("ignore::undula.CurveWarning")
def test_projected_curve_equals_the_command_line(frequency, stroke, heads):
    printed = curve_json(
        PROJECTED, "--frequency", frequency, "--stroke", stroke, "--head=" + ",".join(map(str, heads))
    )
    assert_same(undula.load(PROJECTED).curve(frequency_Hz=frequency, stroke_mm=stroke, heads_mmHg=heads), printed)


def test_emulated_curve_equals_the_command_line(emulator_by_voltage, emulator_by_stroke):
    heads = [0, 33.3, 55, 101]
    text = ",".join(map(str, heads))
    printed = curve_json(emulator_by_voltage, "--frequency", 120, "--voltage", 43.7, "--head", text)
    by_voltage = undula.load(emulator_by_voltage)
    curve = by_voltage.curve(frequency_Hz=120, voltage_V=43.7, heads_mmHg=heads)
    assert_same(curve, printed)
    assert (curve.actuator_power_mW > 0).all() and (curve.holder_stroke_mm > 0.3).all()
    assert curve.voltage_V == 43.7 and curve.stroke_mm is None
    assert by_voltage.training_box["voltage_V"] == (40, 55)

    printed = curve_json(emulator_by_stroke, "--frequency", 117, "--stroke", 0.53, "--head", "31,44.4,60")
    by_stroke = undula.load(emulator_by_stroke)
    assert_same(by_stroke.curve(frequency_Hz=117, stroke_mm=0.53, heads_mmHg=[31, 44.4, 60]), printed)


def test_stated_errors_hold_for_most_of_the_runs_that_were_held_out():
    references = undula.load(PROJECTED).references
    held = references["held_out"]
    assert held.sum() >= 8
    model = undula.load(PROJECTED)
    for f, s, h, flow in zip(
        *(references[name][held] for name in ("frequency_Hz", "stroke_mm", "head_mmHg", "flow_l_per_min"))
    ):
        curve = model.curve(frequency_Hz=f, stroke_mm=s, heads_mmHg=h)
        error = abs(curve.flow_l_per_min[0] - flow)
        assert 0 < error <= curve.error_l_per_min[0] < 0.5


def test_what_leaves_the_box_is_warned_of_and_its_error_grows():
    model = undula.load(PROJECTED)
    with pytest.warns(undula.CurveWarning, match="head 90 mmHg is outside the trained 0 to 70 mmHg"):
        curve = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[50, 90, 300])
    assert list(curve.inside_training_box) == [True, False, False]
    assert curve.error_l_per_min[1] > 2 * curve.error_l_per_min[0]
    assert np.isinf(curve.error_l_per_min[2])
    assert len(curve.remarks) == 2


def test_a_period_has_the_means_of_the_curve_and_its_envelope_holds_the_membrane():
    model = undula.load(PROJECTED)
    curve = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[50])
    period = model.period(frequency_Hz=120, stroke_mm=0.53, head_mmHg=50)
    n = len(period.time_s)
    assert period.membrane_mm.shape == (len(period.radius_mm), n)
    assert period.time_s[1] * n == pytest.approx(1 / 120, rel=1e-12)
    assert period.outflow_l_per_min.mean() == pytest.approx(curve.flow_l_per_min[0], rel=1e-12)
    assert period.inflow_l_per_min.mean() == pytest.approx(curve.inflow_l_per_min[0], rel=1e-12)
    assert np.ptp(period.outflow_l_per_min) > 1
    assert (period.envelope_high_mm == period.membrane_mm.max(axis=1)).all()
    assert (period.envelope_low_mm == period.membrane_mm.min(axis=1)).all()
    # The holder is where it is said to be, and the membrane moves as it does where it is clamped.
    assert np.allclose(period.holder_mm, 0.53 * np.sin(2 * np.pi * 120 * period.time_s), atol=1e-12)
    assert np.abs(period.membrane_mm[-1]).max() > 0.1


def test_a_map_is_made_of_curves(emulator_by_voltage):
    model = undula.load(emulator_by_voltage)
    flows = undula.flow_map(model, frequencies_Hz=120, voltages_V=[40, 50], heads_mmHg=[20, 40, 60])
    assert flows.flow_l_per_min.shape == (1, 2, 3)
    for j, voltage in enumerate([40, 50]):
        curve = model.curve(frequency_Hz=120, voltage_V=voltage, heads_mmHg=[20, 40, 60])
        assert (flows.flow_l_per_min[0, j] == curve.flow_l_per_min).all()
        assert (flows.error_l_per_min[0, j] == curve.error_l_per_min).all()
    assert (np.diff(flows.flow_l_per_min, axis=2) < 0).all() and (np.diff(flows.flow_l_per_min, axis=1) > 0).all()
    with pytest.raises(undula.InputError, match="neither of strokes_mm and voltages_V"):
        undula.flow_map(model, frequencies_Hz=120, heads_mmHg=40)


def test_a_picture_shows_the_curve_its_band_and_the_data(tmp_path):
    measured = undula.read_measured(MEASURED)
    with pytest.warns(undula.CurveWarning):
        curve = undula.load(PROJECTED).curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[80, 20, 50, 300])
    axes = undula.plot_curve(curve, measured=measured)
    line, outside, points = axes.lines
    assert (line.get_ydata() == [20, 50, 80, 300]).all()
    assert (line.get_xdata() == curve.flow_l_per_min[[1, 2, 0, 3]]).all()
    assert (outside.get_ydata() == [80, 300]).all()
    assert len(points.get_xdata()) == len(measured)
    band = np.vstack([path.vertices for path in axes.collections[0].get_paths()])
    assert band[:, 1].max() == 80  # the error at 300 mmHg is not known
    assert band[band[:, 1] == 50, 0].max() == pytest.approx(curve.flow_l_per_min[2] + curve.error_l_per_min[2])
    assert "mmHg" in axes.get_ylabel() and "l/min" in axes.get_xlabel()
    axes.figure.savefig(tmp_path / "curve.png")
