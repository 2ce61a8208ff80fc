"""Head-flow curves of pumps from reduced models, with the error of each; scenes, computed by the program `undula`.

    import undula
    model = undula.load("data/models/wave_pump_fixed.h5")
    curve = model.curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=[40, 50, 60])
    print(curve.flow_l_per_min, curve.error_l_per_min)

Units stand in the names. Numbers are those of `undula hq --json`, to the last digit. Wrong input raises InputError
(a ValueError), failing numerics raise NumericsError; both say what, the value seen, what is allowed, and where.
What has to be known before an answer is believed is given as warnings: CurveWarning of models, RunWarning of the program.

Needs NumPy alone, neither MPI nor PETSc; pictures need matplotlib, and check, solve, hq, validate, calibrate, train,
report and study the program `undula`.
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
    __version__,
    load,
    read_measured,
)
from undula.errors import ProgramError, RunWarning
from undula.fitting import Calibration, Trained, calibrate, report, study, train
from undula.maps import FlowMap, flow_map
from undula.model_fields import PeriodFields, fields
from undula.pictures import plot, plot_calibration, plot_fields, plot_map, plot_period, plot_run
from undula.plotting import plot_curve
from undula.program import Progress, find_program
from undula.results import RecordedCurve, read_curves, read_report, read_table
from undula.runs import FieldFrame, FieldSeries, Run, RunRecord, read_record, read_records, read_run
from undula.scenes import check, hq, solve, validate

__all__ = [
    "Calibration",
    "Curve",
    "CurveWarning",
    "Emulator",
    "FieldFrame",
    "FieldSeries",
    "FlowMap",
    "Hdf5File",
    "InputError",
    "MeasuredCurve",
    "NumericsError",
    "Period",
    "PeriodFields",
    "ProgramError",
    "Progress",
    "RecordedCurve",
    "ReducedModel",
    "Run",
    "RunRecord",
    "RunWarning",
    "Trained",
    "__version__",
    "calibrate",
    "check",
    "fields",
    "find_program",
    "flow_map",
    "hq",
    "load",
    "plot",
    "plot_calibration",
    "plot_curve",
    "plot_fields",
    "plot_map",
    "plot_period",
    "plot_run",
    "read_curves",
    "read_measured",
    "read_record",
    "read_records",
    "read_report",
    "read_run",
    "read_table",
    "report",
    "solve",
    "study",
    "train",
    "validate",
]
