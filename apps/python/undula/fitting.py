"""Many runs of a scene, by the program `undula`: calibrate, train, report, study."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from undula._rom import Emulator, ReducedModel, load
from undula.program import PathLike, ProgressCallback, run_json, setting_words
from undula.scenes import Settings, listed, option_words, petsc_words

Ranges = Mapping[str, Tuple[float, float]]


@dataclass(frozen=True)
class Calibration:
    """What `calibrate` found.

    scene is the file of the calibrated scene. report is what `undula calibrate --json` prints: the curves before and
    after ("curves"), correlations, singular values, profiles, and "statements", what the data do and do not fix.
    """

    scene: Path
    report: Dict[str, Any]

    @property
    def optimum(self) -> Dict[str, float]:
        """Fitted values by key, in the unit of the key."""
        return {one["key"]: one["optimum"] for one in self.report["keys"]}

    @property
    def standard_error(self) -> Dict[str, float]:
        """Standard errors by key, in the unit of the key: they take the scene as true."""
        return {one["key"]: one["standard_error"] for one in self.report["keys"]}

    @property
    def statements(self) -> List[str]:
        """What the data fix and what they do not, a sentence each."""
        return list(self.report["statements"])


@dataclass(frozen=True)
class Trained:
    """What `train` made: file is the model's, report what `undula train --json` prints, with the held-out runs."""

    file: Path
    report: Dict[str, Any]

    def load(self) -> Union[ReducedModel, Emulator]:
        """The model, to be asked. Raises InputError for a model of a moving pump, which `hq` asks."""
        return load(self.file)


def _range(key: str, numbers: Sequence[float]) -> str:
    return f"{key}=" + ":".join(repr(n) if isinstance(n, int) else repr(float(n)) for n in numbers)


def calibrate(
    scene: PathLike,
    data: Union[PathLike, Sequence[PathLike]],
    settings: Optional[Settings] = None,
    *,
    output: PathLike,
    free: Optional[Ranges] = None,
    tolerances: bool = False,
    profiles: Optional[Mapping[str, Tuple[float, float, int]]] = None,
    points: Optional[int] = None,
    frequency_Hz: Optional[float] = None,
    stroke_mm: Optional[float] = None,
    voltage_V: Optional[float] = None,
    force: bool = False,
    petsc: Sequence[str] = (),
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> Calibration:
    """Fits keys of a scene to measured head-flow curves, as `undula calibrate`, and writes the scene `output` (.toml).

    free: {"section.key": (low, high)} in the unit of the key. tolerances: fits every input that states one as well,
    held by it. profiles: {"section.key": (low, high, values)}, the best misfit with that key held. points: heads per
    curve. The setting of the data, Hz and mm or V, is that of their files unless stated. Raises InputError,
    NumericsError, ProgramError.
    """
    words: List[object] = ["calibrate", scene, *setting_words(settings)]
    words += option_words(
        {
            "--data": listed(data),
            "--free": [_range(key, (float(low), float(high))) for key, (low, high) in (free or {}).items()],
            "--tolerances": tolerances,
            "--profile": [_range(key, (float(a), float(b), int(n))) for key, (a, b, n) in (profiles or {}).items()],
            "--output": os.fspath(output),
            "--points": points,
            "--frequency": None if frequency_Hz is None else float(frequency_Hz),
            "--stroke": None if stroke_mm is None else float(stroke_mm),
            "--voltage": None if voltage_V is None else float(voltage_V),
            "--force": force,
        }
    )
    report = run_json([*words, *petsc_words(petsc)], progress, launcher)
    return Calibration(Path(output), report)


def train(
    scene: PathLike,
    settings: Optional[Settings] = None,
    *,
    output: PathLike,
    campaign: Optional[PathLike] = None,
    tolerance_l_per_min: Optional[float] = None,
    most_runs: Optional[int] = None,
    with_recorded: bool = False,
    fields: bool = False,
    force: bool = False,
    petsc: Sequence[str] = (),
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> Trained:
    """Runs a scene over its training box and makes a model from the runs, as `undula train`: the file `output` (.h5).

    The box and the kind of model are settings, {"training.model": "emulator", "training.head_low_mmHg": 0, ...}. Runs
    are kept in the folder `campaign` (OUTPUT.runs) as they end: a call that was interrupted or killed goes on with the
    others. fields: a projected model of a fixed domain keeps what undula.fields draws. tolerance_l_per_min: of emulators, adds runs, at most `most_runs`, until the stated error is below it.
    Raises InputError, NumericsError, ProgramError.
    """
    words: List[object] = ["train", scene, *setting_words(settings)]
    words += option_words(
        {
            "--output": os.fspath(output),
            "--campaign": campaign,
            "--tolerance": None if tolerance_l_per_min is None else float(tolerance_l_per_min),
            "--runs": most_runs,
            "--with-recorded": with_recorded,
            "--fields": fields,
            "--force": force,
        }
    )
    report = run_json([*words, *petsc_words(petsc)], progress, launcher)
    return Trained(Path(output), report)


def report(
    files: Union[PathLike, Sequence[PathLike]],
    data: PathLike,
    *,
    frequency_Hz: float,
    stroke_mm: float,
    points: Optional[int] = None,
    vary: Optional[Mapping[str, Sequence[float]]] = None,
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> Dict[str, Any]:
    """Speed against error of scenes, reduced models and recorded curves, beside a measured curve at a frequency (Hz)
    and a stroke (mm): what `undula report --json` prints, one entry of "levels" each.

    vary: {"section.key": [coarse, ..., finest]} computes scenes with these values as well. rms_to_data_l_per_min is
    the error against the data, rms_to_reference_l_per_min that against what a computation should repeat. Raises
    InputError, NumericsError, ProgramError.
    """
    words: List[object] = ["report", *listed(files)]
    words += option_words(
        {
            "--data": os.fspath(data),
            "--frequency": float(frequency_Hz),
            "--stroke": float(stroke_mm),
            "--points": points,
            "--vary": [f"{key}=" + ",".join(f"{v!r}" for v in values) for key, values in (vary or {}).items()],
        }
    )
    return run_json(words, progress, launcher)


def study(
    scene: PathLike,
    vary: Mapping[str, Sequence[float]],
    settings: Optional[Settings] = None,
    *,
    output: Optional[PathLike] = None,
    points: Optional[int] = None,
    petsc: Sequence[str] = (),
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> Dict[str, Any]:
    """Runs a scene over ranges of its keys, as `undula study`: what it prints as JSON, runs and sensitivities.

    vary: {"section.key": (low, high, count)} for a full plan, or (low, high) of every key for a space-filling one of
    `points` runs. Runs are kept in the folder `output` (NAME_study) as they end; the same call goes on with the others.
    Raises InputError, NumericsError, ProgramError.
    """
    words: List[object] = ["study", scene, *setting_words(settings)]
    ranges = []
    for key, numbers in vary.items():
        bounds = [float(n) for n in numbers[:2]]
        ranges.append(_range(key, [*bounds, *(int(n) for n in numbers[2:])]))
    words += option_words({"--vary": ranges, "--output": output, "--points": points})
    return run_json([*words, *petsc_words(petsc)], progress, launcher)
