"""Result files: curves (JSON of `undula hq`) and tables (CSV of a run folder). HDF5 files: undula.Hdf5File."""

from __future__ import annotations

import csv
import json
import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Union

import numpy as np
import numpy.typing as npt

from undula.errors import refused

PathLike = Union[str, "os.PathLike[str]"]
Column = Union[npt.NDArray[np.float64], List[str]]


@dataclass(frozen=True)
class RecordedCurve:
    """A curve as `undula hq --json` printed it: of a model or of a scene, whatever level computed it.

    columns holds every number of the points by its name in the file ("flow_l_per_min", "holder.stroke_mm"), one
    entry per head; nan where the file has null. Names carry the unit. texts holds what is said of every point:
    "reason", why it is not periodic; "tier" and "why", which of several levels answered.
    """

    level: str
    source: str  # the scene's name or the model's file
    frequency_Hz: float
    stroke_mm: Optional[float]
    voltage_V: Optional[float]
    columns: Dict[str, npt.NDArray[np.float64]]
    texts: Dict[str, List[str]] = field(default_factory=dict)

    @property
    def head_mmHg(self) -> npt.NDArray[np.float64]:
        """Heads, mmHg."""
        return self.columns["head_mmHg"]

    @property
    def flow_l_per_min(self) -> npt.NDArray[np.float64]:
        """Mean flows, l/min; nan where the numerics failed."""
        return self.columns["flow_l_per_min"]

    @property
    def error_l_per_min(self) -> npt.NDArray[np.float64]:
        """Stated errors, l/min; nan where none is known."""
        return self.columns["error_l_per_min"]

    @property
    def inside_training_box(self) -> npt.NDArray[np.bool_]:
        """Whether a point lies in the training box; True for levels that have none."""
        inside = self.columns.get("inside_training_box")
        return np.full(len(self.head_mmHg), True) if inside is None else np.equal(inside, 1)


def _read_text(file: PathLike) -> str:
    try:
        with open(file, encoding="utf-8") as stream:
            return stream.read()
    except (OSError, UnicodeDecodeError) as error:
        raise refused("the file cannot be read", str(error), "a text file that Undula wrote", str(file)) from None


def _numbers(point: Dict[str, Any], prefix: str = "") -> Dict[str, float]:
    """Numbers, nulls and truth values of a point by name; the parts of its objects as "object.name"."""
    found: Dict[str, float] = {}
    for name, value in point.items():
        if isinstance(value, dict):
            found.update(_numbers(value, f"{prefix}{name}."))
        elif value is None:
            found[prefix + name] = float("nan")
        elif isinstance(value, (bool, int, float)):
            found[prefix + name] = float(value)
    return found


def _curve(record: Dict[str, Any]) -> RecordedCurve:
    points = [_numbers(point) for point in record["points"]]
    names = list(dict.fromkeys(name for point in points for name in point))
    columns = {name: np.array([point.get(name, float("nan")) for point in points]) for name in names}
    for name in ("head_mmHg", "flow_l_per_min", "error_l_per_min"):
        columns[name]  # KeyError: no curve
    texts = {
        name: [str(point.get(name, "")) for point in record["points"]]
        for name in ("reason", "tier", "why")
        if any(name in point for point in record["points"])
    }
    return RecordedCurve(
        record["level"],
        record["model"] if "model" in record else record["scene"],
        float(record["frequency_Hz"]),
        record.get("stroke_mm"),
        record.get("voltage_V"),
        columns,
        texts,
    )


def curves_of(record: Dict[str, Any]) -> List[RecordedCurve]:
    """Curves of what `undula hq --json` printed, read already."""
    return [_curve(one) for one in record.get("curves", [record])]


def read_curves(file: PathLike) -> List[RecordedCurve]:
    """Reads what `undula hq ... --json` printed: one curve, or one per voltage.

    Raises InputError for another file.
    """
    allowed = "what `undula hq ... --json` prints"
    try:
        return curves_of(json.loads(_read_text(file)))
    except json.JSONDecodeError as error:
        raise refused("the file is no JSON", str(error), allowed, str(file)) from None
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise refused("the file holds no curve", f"{type(error).__name__}: {error}", allowed, str(file)) from None


def read_table(file: PathLike) -> Dict[str, Column]:
    """Reads a table that Undula wrote (time_series.csv, cycle_means.csv, envelope.csv, ...): {column: values}.

    Columns of numbers are float arrays, others lists of text. Raises InputError, with the line, where a row has
    not as many fields as the header.
    """
    lines = _read_text(file).splitlines()
    start = next((i for i, line in enumerate(lines) if line.strip() and not line.startswith("#")), None)
    if start is None:
        raise refused("the table is empty", f"{len(lines)} lines, no header", "a table with a header", str(file))
    rows = list(csv.reader(lines[start:]))
    header = rows[0]
    for number, row in enumerate(rows[1:], start + 2):
        if len(row) != len(header):
            raise refused(
                "a row of the table is not whole", f"{len(row)} fields", f"{len(header)}, as in the header", f"{file}:{number}"
            )
    table: Dict[str, Column] = {}
    for place, name in enumerate(header):
        fields = [row[place] for row in rows[1:]]
        try:
            table[name] = np.array([float(field) if field else float("nan") for field in fields])
        except ValueError:
            table[name] = fields
    return table


def read_report(file: PathLike) -> Dict[str, Any]:
    """Reads what a command printed by --json, or a study's study.json: names carry the units, null is None.

    Raises InputError for another file.
    """
    allowed = "what a command of undula prints by --json"
    try:
        report = json.loads(_read_text(file))
    except json.JSONDecodeError as error:
        raise refused("the file is no JSON", str(error), allowed, str(file)) from None
    if not isinstance(report, dict):
        raise refused("the file holds no report", type(report).__name__, allowed, str(file))
    return report
