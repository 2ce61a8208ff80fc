"""Pictures of curves, by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Optional, Union

import numpy as np

from undula._rom import Curve, MeasuredCurve
from undula.results import RecordedCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _setting(curve: Union[Curve, RecordedCurve, MeasuredCurve]) -> str:
    parts = [] if curve.frequency_Hz is None else [f"{curve.frequency_Hz:g} Hz"]
    if curve.voltage_V is not None:
        parts.append(f"{curve.voltage_V:g} V")
    elif curve.stroke_mm is not None:
        parts.append(f"stroke {curve.stroke_mm:g} mm")
    return ", ".join(parts)


def plot_curve(
    curve: Union[Curve, RecordedCurve],
    *,
    measured: Union[MeasuredCurve, Iterable[MeasuredCurve], None] = None,
    label: Optional[str] = None,
    axes: Optional[Axes] = None,
    **line: Any,
) -> Axes:
    """Draws head over flow, with the band of the stated error, and measured points beside it.

    A new figure unless `axes` are given, which are returned. Where the error is unknown (inf or nan) there is no
    band. Points outside of the training box are marked by crosses. `line` goes to matplotlib's plot.
    """
    from matplotlib import pyplot

    if axes is None:
        axes = pyplot.figure().add_subplot()
    order = np.argsort(curve.head_mmHg, kind="stable")
    head, flow = curve.head_mmHg[order], curve.flow_l_per_min[order]
    error, inside = curve.error_l_per_min[order], curve.inside_training_box[order]
    (drawn,) = axes.plot(flow, head, label=label or f"{curve.level}, {_setting(curve)}", **line)
    colour = drawn.get_color()
    known = np.isfinite(error) & np.isfinite(flow)
    if known.any():
        axes.fill_betweenx(
            head, flow - error, flow + error, where=known, color=colour, alpha=0.2, linewidth=0, label="stated error"
        )
    if not inside.all():
        axes.plot(flow[~inside], head[~inside], "x", color=colour, label="outside of the training box")
    if measured is not None:
        for points in [measured] if isinstance(measured, MeasuredCurve) else measured:
            setting = _setting(points)
            axes.plot(
                points.flow_l_per_min,
                points.head_mmHg,
                "o",
                markersize=3,
                fillstyle="none",
                label="measured" + (f", {setting}" if setting else ""),
            )
    axes.set_xlabel("flow (l/min)")
    axes.set_ylabel("head (mmHg)")
    axes.grid(True, alpha=0.3)
    axes.legend()
    return axes
