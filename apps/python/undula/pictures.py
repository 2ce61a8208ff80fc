"""Pictures of periods, maps, runs, fields and fits, by matplotlib; undula.plot chooses by what it is given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from undula._rom import Curve, Period
from undula.errors import refused
from undula.fitting import Calibration
from undula.maps import FlowMap
from undula.plotting import plot_curve
from undula.results import RecordedCurve
from undula.runs import FieldFrame, Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def _new_axes(axes: Optional[Axes]) -> Axes:
    from matplotlib import pyplot

    return pyplot.figure().add_subplot() if axes is None else axes


def _finish(axes: Axes, x: str, y: str) -> None:
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(True, alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()


def plot_period(period: Period) -> Figure:
    """Flows and the holder's place over a period, and the reach of the membrane between its lowest and highest place."""
    from matplotlib import pyplot

    figure, (flows, place, reach) = pyplot.subplots(3, 1, figsize=(6.4, 8.4), layout="constrained")
    time = 1e3 * period.time_s
    flows.plot(time, period.outflow_l_per_min, label="out of the outlet")
    flows.plot(time, period.inflow_l_per_min, "--", label="into the inlet")
    flows.sharex(place)
    _finish(flows, "time (ms)", "flow (l/min)")
    place.plot(time, period.holder_mm)
    _finish(place, "time (ms)", "holder (mm)")
    reach.fill_between(period.radius_mm, period.envelope_low_mm, period.envelope_high_mm, alpha=0.2, linewidth=0, label="reach")
    for part in range(4):
        instant = part * len(time) // 4
        reach.plot(period.radius_mm, period.membrane_mm[:, instant], linewidth=1, label=f"{time[instant]:.1f} ms")
    _finish(reach, "radius (mm)", "membrane (mm)")
    figure.suptitle(f"{period.frequency_Hz:g} Hz, stroke {period.stroke_mm:.3g} mm, {period.head_mmHg:g} mmHg")
    return figure


def plot_map(flows: FlowMap, *, axes: Optional[Axes] = None) -> Axes:
    """Lines of equal flow over head and the other axis that has several values: drive, or frequency.

    Points outside of the training box are marked by crosses. Raises InputError where frequency and drive both have
    several values.
    """
    drive, name = (flows.stroke_mm, "stroke (mm)") if flows.stroke_mm is not None else (flows.voltage_V, "voltage (V)")
    assert drive is not None
    if len(flows.frequency_Hz) == 1:
        across, label, shown, inside = drive, name, flows.flow_l_per_min[0], flows.inside_training_box[0]
    elif len(drive) == 1:
        across, label = flows.frequency_Hz, "frequency (Hz)"
        shown, inside = flows.flow_l_per_min[:, 0], flows.inside_training_box[:, 0]
    else:
        seen = f"{len(flows.frequency_Hz)} frequencies and {len(drive)} values of the drive"
        raise refused("a picture of a map has two axes", seen, "one frequency, or one value of the drive", "plot_map")
    if min(shown.shape) < 2:
        raise refused("a picture of a map has two axes", f"{shown.shape[0]} x {shown.shape[1]} points", "2 x 2", "plot_map")
    axes = _new_axes(axes)
    lines = axes.contour(across, flows.head_mmHg, shown.T, levels=12)
    axes.clabel(lines)
    if not inside.all():
        x, y = np.meshgrid(across, flows.head_mmHg, indexing="ij")
        axes.plot(x[~inside], y[~inside], "x", color="grey", markersize=5, clip_on=False, label="outside of the training box")
    axes.set_title("flow (l/min)")
    _finish(axes, label, "head (mmHg)")
    return axes


def plot_run(run: Run, *, columns: Optional[Sequence[str]] = None) -> Figure:
    """Columns of the time series over time, one below the other; by default all flows."""
    from matplotlib import pyplot

    series = run.time_series
    names: List[str] = list(columns) if columns is not None else [name for name in series if "flow_l_per_min" in name]
    for name in names:
        if name not in series:
            raise refused(f'the time series has no column "{name}"', str(run.folder), ", ".join(series), "plot_run")
    if not names:
        raise refused("no column of the time series is asked for", "no flow in l/min", ", ".join(series), "plot_run")
    figure, places = pyplot.subplots(len(names), 1, sharex=True, squeeze=False, layout="constrained")
    for axes, name in zip(places[:, 0], names):
        axes.plot(series["time_s"], series[name])
        _finish(axes, "time (s)" if name == names[-1] else "", name)
    return figure


def plot_fields(frame: FieldFrame, name: str = "pressure", *, axes: Optional[Axes] = None, **look: Any) -> Axes:
    """A field on the triangles of a frame, vectors by their size. `look` goes to matplotlib's tripcolor."""
    if name not in frame.values:
        raise refused(f'the frame has no field "{name}"', ", ".join(frame.values), "one of them", "plot_fields")
    if frame.cells.shape[1] != 3:
        raise refused("a picture is of a plane", f"cells of {frame.cells.shape[1]} points", "triangles", "plot_fields")
    values: npt.NDArray[np.float64] = frame.values[name]
    shown = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
    axes = _new_axes(axes)
    drawn = axes.tripcolor(
        10 * frame.points_cm[:, 0], 10 * frame.points_cm[:, 1], frame.cells, shown, **{"shading": "gouraud", **look}
    )
    axes.set_aspect("equal")
    axes.figure.colorbar(drawn, ax=axes, label=f"{name} ({frame.units[name]})")
    axes.set_title(f"{1e3 * frame.time_s:.3f} ms")
    axes.set_xlabel("mm")
    axes.set_ylabel("mm")
    return axes


def plot_calibration(calibration: Calibration, *, axes: Optional[Axes] = None) -> Axes:
    """The fitted curves before and after, beside what was measured."""
    axes = _new_axes(axes)
    for number, curve in enumerate(calibration.report["curves"]):
        drive = f"{curve['voltage_V']:g} V" if curve.get("voltage_V") else f"stroke {curve['stroke_mm']:g} mm"
        setting = f"{curve['frequency_Hz']:g} Hz, {drive}"
        colour = f"C{number}"
        axes.plot(curve["measured_l_per_min"], curve["head_mmHg"], "o", fillstyle="none", color=colour, label=f"measured, {setting}")
        axes.plot(curve["start_l_per_min"], curve["head_mmHg"], ":", color=colour, label="before")
        axes.plot(curve["optimum_l_per_min"], curve["head_mmHg"], color=colour, label="after")
    _finish(axes, "flow (l/min)", "head (mmHg)")
    return axes


def plot(what: Any, **options: Any) -> Any:
    """A picture of anything that Undula answers, in one call.

    A Curve or RecordedCurve, or a list of them (axes); a Period (figure); a FlowMap (axes); a Run (figure); a
    FieldFrame (axes); a Calibration (axes). `options` are those of plot_curve, plot_map, plot_run, plot_fields,
    plot_calibration. Returns matplotlib's Axes or Figure. Raises InputError for anything else.
    """
    if isinstance(what, (Curve, RecordedCurve)):
        return plot_curve(what, **options)
    if isinstance(what, (list, tuple)) and what and all(isinstance(one, (Curve, RecordedCurve)) for one in what):
        axes = _new_axes(options.pop("axes", None))
        for number, one in enumerate(what):
            plot_curve(one, axes=axes, **(options if number == 0 else {**options, "measured": None}))
        return axes
    kinds: List[Tuple[type, Callable[..., Any]]] = [
        (Period, plot_period),
        (FlowMap, plot_map),
        (Run, plot_run),
        (FieldFrame, plot_fields),
        (Calibration, plot_calibration),
    ]
    for kind, function in kinds:
        if isinstance(what, kind):
            return function(what, **options)
    allowed = "a Curve, RecordedCurve (or a list of them), Period, FlowMap, Run, FieldFrame or Calibration"
    raise refused("nothing is known to draw of this", f"a {type(what).__name__}", allowed, "plot")
