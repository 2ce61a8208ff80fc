"""What runs leave: the folder of `undula solve`, its fields, and the records of campaigns and studies."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from undula._rom import Hdf5File, InputError
from undula.errors import refused
from undula.results import Column, PathLike, read_table


@dataclass(frozen=True)
class FieldFrame:
    """Fields at one time on a mesh: triangles or tetrahedra, points repeated where a field jumps.

    points_cm has the shape n x 3 (axisymmetric: x = r, y = z), cells m x 3 or m x 4 (numbers of points), values[name] n
    or n x 3 in units[name].
    """

    time_s: float
    points_cm: npt.NDArray[np.float64]
    cells: npt.NDArray[np.int64]
    values: Dict[str, npt.NDArray[np.float64]]
    units: Dict[str, str]


class FieldSeries:
    """Fields over time: the series that an .xdmf file names. A frame is read when it is asked for, series[i]."""

    def __init__(self, file: PathLike) -> None:
        """Raises InputError where the file is no series of Undula's."""
        self.file: Path = Path(file)
        try:
            grids = ElementTree.parse(self.file).findall("./Domain/Grid/Grid")
            self._frames = [(float(_get(_one(grid, "Time"), "Value")), grid) for grid in grids]
        except (OSError, ElementTree.ParseError, ValueError) as error:
            raise refused("the series of fields cannot be read", str(error), "an .xdmf that Undula wrote", str(file)) from None

    @property
    def times_s(self) -> npt.NDArray[np.float64]:
        """Times of the frames, s."""
        return np.array([time for time, _ in self._frames])

    def __len__(self) -> int:
        return len(self._frames)

    def __getitem__(self, place: int) -> FieldFrame:
        time, grid = self._frames[place]
        points = self._data(_one(grid, "Geometry"))
        values = {_get(item, "Name"): self._data(item) for item in grid.findall("Attribute")}
        units = {_get(item, "Name"): _get(_one(item, "Information"), "Value") for item in grid.findall("Attribute")}
        return FieldFrame(time, points, self._data(_one(grid, "Topology")), values, units)

    def __iter__(self) -> Iterator[FieldFrame]:
        return (self[i] for i in range(len(self)))

    def _data(self, element: ElementTree.Element) -> npt.NDArray[Any]:
        source = (_one(element, "DataItem").text or "").strip()
        name, _, path = source.partition(":/")
        if not path or os.path.basename(name) != name:
            raise refused("a field of the series stands elsewhere", source, "NAME.h5:/path beside it", str(self.file))
        values = Hdf5File(self.file.parent / name).read(path)
        assert not isinstance(values, str)
        return values


def _one(element: ElementTree.Element, name: str) -> ElementTree.Element:
    found = element.find(name)
    if found is None:
        raise ValueError(f"no {name} in {element.tag}")
    return found


def _get(element: ElementTree.Element, name: str) -> str:
    value = element.get(name)
    if value is None:
        raise ValueError(f"no {name} of {element.tag}")
    return value


@dataclass(frozen=True)
class Run:
    """The folder of a run. report is what `solve` printed; None where the folder was opened later."""

    folder: Path
    report: Optional[Dict[str, Any]] = field(default=None, repr=False)

    @property
    def tables(self) -> List[str]:
        """Names of the tables: "time_series", "cycle_means", "envelope", ..."""
        return sorted(file.stem for file in self.folder.glob("*.csv"))

    def table(self, name: str) -> Dict[str, Column]:
        """A table, {column: values}; units stand in the names of the columns. Raises InputError for other names."""
        if name not in self.tables:
            raise refused(f'the run has no table "{name}"', str(self.folder), ", ".join(self.tables), "table")
        return read_table(self.folder / f"{name}.csv")

    @property
    def time_series(self) -> Dict[str, Column]:
        """One row per step."""
        return self.table("time_series")

    @property
    def series(self) -> List[str]:
        """Names of the series of fields: "fluid", "solids"; none where output.fields_every is 0."""
        return sorted(file.stem for file in self.folder.glob("*.xdmf"))

    def fields(self, name: str = "fluid") -> FieldSeries:
        """A series of fields. Raises InputError for other names."""
        if name not in self.series:
            seen = ", ".join(self.series) or "none: output.fields_every is 0, the default"
            raise refused(f'the run has no fields "{name}"', seen, "a series of output.fields_every", str(self.folder))
        return FieldSeries(self.folder / f"{name}.xdmf")

    @property
    def scene_text(self) -> str:
        """The scene in force (TOML)."""
        return (self.folder / "scene_resolved.toml").read_text(encoding="utf-8")

    @property
    def seconds(self) -> Dict[str, float]:
        """Seconds per phase, of the process that ended last; empty where none has ended."""
        file = self.folder / "timing.json"
        if not file.exists():
            return {}
        phases = json.loads(file.read_text(encoding="utf-8"))["phases"]
        return {name: phase["seconds"] for name, phase in phases.items()}

    @property
    def checkpoints(self) -> List[Path]:
        """Files that a restart may go on from, oldest first."""
        files = (self.folder / "checkpoints").glob("checkpoint_*.h5")
        return sorted(files, key=lambda file: int(file.stem.rsplit("_", 1)[1]))


def read_run(folder: PathLike) -> Run:
    """Opens the folder of `undula solve`. Raises InputError where it holds no run."""
    run = Run(Path(folder))
    if not (run.folder / "scene_resolved.toml").is_file():
        raise refused("the folder holds no run", f"no scene_resolved.toml in {folder}", "a folder of undula solve", "read_run")
    return run


@dataclass(frozen=True)
class RunRecord:
    """The record of one run of a campaign (`train`, `hq --campaign`) or a study.

    numbers holds every number and array by its path in the file ("point/frequency", "cycles/mean"), units theirs,
    texts the texts ("reason", "cycles/columns"). Arrays of cycles have a row per period, a column per name.
    """

    file: Path
    numbers: Dict[str, npt.NDArray[Any]] = field(repr=False)
    units: Dict[str, str] = field(repr=False)
    texts: Dict[str, str] = field(repr=False)

    def means(self) -> Dict[str, npt.NDArray[np.float64]]:
        """Means over the periods by column, one entry per period; of a study its quantities, one entry each."""
        names, values = ("cycles/columns", "cycles/mean") if "cycles/mean" in self.numbers else ("quantities/names", "quantities/values")
        if names not in self.texts:
            return {}
        columns = self.texts[names].splitlines()
        rows = np.atleast_2d(self.numbers[values])
        return {name: rows[:, i] for i, name in enumerate(columns)}


def read_record(file: PathLike) -> RunRecord:
    """Reads the record of a run (.h5 in the folder of a campaign or a study). Raises InputError for other files."""
    contents = Hdf5File(file)
    if not contents.sealed:
        raise refused("the file carries no seal", str(file), "a record that Undula wrote", "read_record")
    read: Dict[str, Any] = {name: contents.read(name) for name in contents.names()}
    if "reason" not in read:
        raise refused("the file is no record of a run", ", ".join(read)[:80], "a file with a reason", str(file))
    texts = {name: value for name, value in read.items() if isinstance(value, str)}
    numbers = {name: value for name, value in read.items() if not isinstance(value, str)}
    return RunRecord(Path(file), numbers, {name: contents.unit(name) for name in numbers}, texts)


def read_records(folder: PathLike) -> Tuple[List[RunRecord], List[str]]:
    """All records of the folder of a campaign or a study, and what was wrong with those that cannot be read."""
    records, refused_ones = [], []
    if not Path(folder).is_dir():
        raise refused("there is no such folder", str(folder), "the folder of a campaign or a study", "read_records")
    for file in sorted(Path(folder).glob("*.h5")):
        if file.name not in ("campaign.h5", "study.h5"):
            try:
                records.append(read_record(file))
            except InputError as error:
                refused_ones.append(str(error))
    return records, refused_ones
