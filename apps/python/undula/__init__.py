"""Head-flow curves of pumps from reduced models, with the error of each.

    import undula
    model = undula.load("data/models/wave_pump_fixed.h5")
    curve = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[40, 50, 60])
    print(curve.flow_l_per_min, curve.error_l_per_min)

Units stand in the names. Numbers are those of `undula hq --json`, to the last digit. Wrong input raises InputError
(a ValueError), failing numerics raise NumericsError; both say what, the value seen, what is allowed, and where.
What has to be known before a curve is believed is given as warnings of the category CurveWarning.

Needs NumPy alone, neither MPI nor PETSc; plot_curve needs matplotlib.
"""

from undula._rom import (
    Curve,
    CurveWarning,
    Emulator,
    Hdf5File,
    InputError,
    MeasuredCurve,
    NumericsError,
    Period,
    ReducedModel,
    load,
    read_measured,
)
from undula.maps import FlowMap, flow_map
from undula.plotting import plot_curve
from undula.results import RecordedCurve, read_curves, read_table

__all__ = [
    "Curve",
    "CurveWarning",
    "Emulator",
    "FlowMap",
    "Hdf5File",
    "InputError",
    "MeasuredCurve",
    "NumericsError",
    "Period",
    "RecordedCurve",
    "ReducedModel",
    "flow_map",
    "load",
    "plot_curve",
    "read_curves",
    "read_measured",
    "read_table",
]
