"""Flow over frequency, drive and head."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from undula._rom import Emulator, ReducedModel
from undula.errors import refused


@dataclass(frozen=True)
class FlowMap:
    """Mean flows over a grid of operating points.

    The axes are frequency_Hz (n_f), stroke_mm or voltage_V (n_d; the other one is None) and head_mmHg (n_h);
    flow_l_per_min, error_l_per_min and inside_training_box have the shape n_f x n_d x n_h.
    """

    frequency_Hz: npt.NDArray[np.float64]
    stroke_mm: Optional[npt.NDArray[np.float64]]
    voltage_V: Optional[npt.NDArray[np.float64]]
    head_mmHg: npt.NDArray[np.float64]
    flow_l_per_min: npt.NDArray[np.float64]
    error_l_per_min: npt.NDArray[np.float64]
    inside_training_box: npt.NDArray[np.bool_]


def flow_map(
    model: Union[ReducedModel, Emulator],
    *,
    frequencies_Hz: npt.ArrayLike,
    heads_mmHg: npt.ArrayLike,
    strokes_mm: Optional[npt.ArrayLike] = None,
    voltages_V: Optional[npt.ArrayLike] = None,
) -> FlowMap:
    """Asks `model` for a curve at every frequency (Hz) and stroke (mm) or voltage (V).

    Raises and warns as model.curve.
    """
    if (strokes_mm is None) == (voltages_V is None):
        seen = f"{'neither' if strokes_mm is None else 'both'} of strokes_mm and voltages_V"
        raise refused("the drive of a map is not stated", seen, "one of them", "flow_map")
    frequencies = np.atleast_1d(np.asarray(frequencies_Hz, dtype=float))
    heads = np.atleast_1d(np.asarray(heads_mmHg, dtype=float))
    by_stroke = strokes_mm is not None
    drives = np.atleast_1d(np.asarray(strokes_mm if by_stroke else voltages_V, dtype=float))
    shape = (frequencies.size, drives.size, heads.size)
    flow, error, inside = np.empty(shape), np.empty(shape), np.empty(shape, dtype=bool)
    for i, frequency in enumerate(frequencies):
        for j, drive in enumerate(drives):
            curve = model.curve(
                frequency_Hz=frequency,
                heads_mmHg=heads,
                stroke_mm=drive if by_stroke else None,
                voltage_V=None if by_stroke else drive,
            )
            flow[i, j] = curve.flow_l_per_min
            error[i, j] = curve.error_l_per_min
            inside[i, j] = curve.inside_training_box
    return FlowMap(
        frequencies, drives if by_stroke else None, None if by_stroke else drives, heads, flow, error, inside
    )
