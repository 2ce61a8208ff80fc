"""Fields of a reduced model: sums of the modes that its file keeps."""

from __future__ import annotations

from typing import Dict, Iterator, Tuple

import numpy as np
import numpy.typing as npt

from undula._rom import Hdf5File, ReducedModel
from undula.errors import refused
from undula.runs import FieldFrame

_VERSION = 1  # of the group "fields"
_Floats = npt.NDArray[np.float64]


class PeriodFields:
    """Frames of one part of the pump, "fluid" or "solids", over one period; a frame is summed when it is asked for.

    Indexed by instant, fields[i], as a series of a run: velocity (cm/s) and pressure (dyn/cm^2) of the fluid, displacement
    (cm) of the solids. The mesh is that of rest, on which the model computes.
    """

    def __init__(
        self,
        times_s: _Floats,
        points_cm: _Floats,
        cells: npt.NDArray[np.int64],
        modes: Dict[str, Tuple[_Floats, _Floats, str]],
    ) -> None:
        self.times_s: _Floats = times_s
        self._points, self._cells, self._modes = points_cm, cells, modes

    def __len__(self) -> int:
        return len(self.times_s)

    def __getitem__(self, place: int) -> FieldFrame:
        if not -len(self) <= place < len(self):
            raise IndexError(place)
        values, units = {}, {}
        for name, (modes, amplitudes, unit) in self._modes.items():
            field = modes @ amplitudes[:, place]
            # Vectors get a third component 0, as in the files of runs.
            values[name] = np.column_stack([field, np.zeros(len(field))]) if field.ndim == 2 else field
            units[name] = unit
        return FieldFrame(float(self.times_s[place]), self._points, self._cells, values, units)

    def __iter__(self) -> Iterator[FieldFrame]:
        return (self[i] for i in range(len(self)))


def fields(model: ReducedModel, *, frequency_Hz: float, head_mmHg: float, stroke_mm: float) -> Dict[str, PeriodFields]:
    """Velocity, pressure and displacement of a projected model over one period at a frequency (Hz), head (mmHg) and stroke
    (mm): {"fluid": frames, "solids": frames}, to be drawn by plot.

    The file of the model has to hold its modes (`undula train --fields`, or train(..., fields=True)). Raises InputError
    where it does not, and as model.period; warns as it does.
    """
    file = Hdf5File(model.file)
    if "fields/fluid/velocity" not in file.names():
        allowed = "a projected model of a fixed domain that undula train --fields made"
        raise refused("the model keeps no fields", "no mesh and no modes in its file", allowed, model.file)
    version = file.attribute("fields", "format_version")
    if version != _VERSION:
        raise refused("the fields of the model are of another format version", str(version), str(_VERSION), model.file)
    read = {name: file.read(name) for name in file.names() if name.startswith("fields/")}
    amplitudes = model.mode_amplitudes(frequency_Hz=frequency_Hz, head_mmHg=head_mmHg, stroke_mm=stroke_mm)

    def array(name: str) -> npt.NDArray[np.float64]:
        values = read.get(f"fields/{name}")
        if not isinstance(values, np.ndarray):
            raise refused(f"the fields of the model are not whole: {name}", "nothing", "numbers", model.file)
        return np.asarray(values, dtype=np.float64)

    velocity, pressure = array("fluid/velocity"), array("fluid/pressure")
    # The holder moves all solids; the modes are relative to it.
    displacement = np.concatenate([array("solids/displacement"), array("solids/holder")[..., np.newaxis]], axis=2)
    with_holder = np.vstack([amplitudes["displacement"], amplitudes["holder_cm"]])
    for name, modes, rows in (
        ("velocity", velocity, amplitudes["velocity"]),
        ("pressure", pressure, amplitudes["pressure"]),
        ("displacement", displacement, with_holder),
    ):
        if modes.shape[-1] != len(rows):
            raise refused(
                f"the modes of {name} are not those of the model", f"{modes.shape[-1]}", f"{len(rows)}", model.file
            )

    def part(name: str, modes: Dict[str, Tuple[_Floats, _Floats, str]]) -> PeriodFields:
        flat = array(f"{name}/points")
        points = np.column_stack([flat, np.zeros(len(flat))])
        return PeriodFields(amplitudes["time_s"], points, array(f"{name}/cells").astype(np.int64), modes)

    return {
        "fluid": part(
            "fluid",
            {
                "velocity": (velocity, amplitudes["velocity"], "cm/s"),
                "pressure": (pressure, amplitudes["pressure"], "dyn/cm^2"),
            },
        ),
        "solids": part("solids", {"displacement": (displacement, with_holder, "cm")}),
    }
