"""Scenes, computed by the program `undula`: check, solve, hq, validate."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from undula.program import PathLike, ProgressCallback, run_json, setting_words
from undula.results import RecordedCurve, curves_of
from undula.runs import Run

Settings = Mapping[str, Any]


def number_list(numbers: npt.ArrayLike) -> str:
    """Numbers as a word of the command line, every digit."""
    return ",".join(repr(float(number)) for number in np.atleast_1d(np.asarray(numbers, dtype=float)))


def option_words(options: Mapping[str, object]) -> List[str]:
    """Words of the options that are stated: True is a flag, a list repeats its option, None and False leave it out."""
    words: List[str] = []
    for name, value in options.items():
        if value is True:
            words.append(name)
        elif isinstance(value, (list, tuple)):
            for one in value:
                words += [f"{name}={one}"]
        elif value is not None and value is not False:
            words.append(f"{name}={value!r}" if isinstance(value, float) else f"{name}={value}")
    return words


def listed(files: Union[PathLike, Sequence[PathLike]]) -> List[str]:
    """One file or several, as texts."""
    return [os.fspath(f) for f in ([files] if isinstance(files, (str, os.PathLike)) else files)]


def petsc_words(petsc: Sequence[str]) -> List[str]:
    return ["--", *petsc] if petsc else []


def check(scene: PathLike, settings: Optional[Settings] = None) -> Dict[str, Any]:
    """Checks a scene, meshes and cuts it, and solves nothing: what `undula check --json` prints.

    `settings` overrides keys of the scene, {"section.key": value}, in the units of the keys. The answer holds meshes
    with their quality, unknowns, steps, notes, and "resolved", the scene in force. Raises InputError for what a scene
    must not be, with the place.
    """
    return run_json(["check", scene, *setting_words(settings)])


def solve(
    scene: PathLike,
    settings: Optional[Settings] = None,
    *,
    output: Optional[PathLike] = None,
    restart: bool = False,
    force: bool = False,
    petsc: Sequence[str] = (),
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> Run:
    """Computes a scene step by step, as `undula solve`: the folder with all results, open for reading.

    The folder is `output`, or NAME_run. It is refused where it holds a run, unless `restart` goes on from its newest
    checkpoint or `force` replaces it. `launcher`, ["mpirun", "-np", "2"], computes on several processes; `petsc` are
    options for PETSc. `progress` gets a Progress per step, at most five times a second. Ctrl-C ends the step and keeps
    a checkpoint, which the message of the KeyboardInterrupt names; the same call with restart=True goes on bit for bit.
    Raises InputError, NumericsError (the last good state is kept), ProgramError.
    """
    words = ["solve", scene, *setting_words(settings)]
    words += option_words({"--output": output, "--restart": restart, "--force": force})
    report = run_json([*words, *petsc_words(petsc)], progress, launcher)
    return Run(Path(report["output"]), report)


def hq(
    source: PathLike,
    heads_mmHg: Optional[npt.ArrayLike] = None,
    settings: Optional[Settings] = None,
    *,
    frequency_Hz: Optional[float] = None,
    stroke_mm: Optional[float] = None,
    voltage_V: Optional[npt.ArrayLike] = None,
    band: bool = False,
    given: Union[PathLike, Sequence[PathLike]] = (),
    tolerance_l_per_min: Optional[float] = None,
    then: Union[PathLike, Sequence[PathLike]] = (),
    campaign: Optional[PathLike] = None,
    petsc: Sequence[str] = (),
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> List[RecordedCurve]:
    """Head-flow curves of a scene (.toml) or a model of any kind, as `undula hq`: one, or one per voltage.

    Heads are in mmHg. Frequency (Hz), stroke (mm) and voltage (V; a number or a list) are those of the scene unless
    stated. `band` adds the band of the scene's tolerances, which measured curves `given` narrow; it is then
    error_l_per_min. With `tolerance_l_per_min` every head is answered by the first of `source` and `then` whose error
    is within it; texts["tier"] says which. Scenes among `then` keep their runs in the folder `campaign`. Curves of
    models alone are had faster by load(file).curve(...). Raises InputError, NumericsError, ProgramError.
    """
    words: List[object] = ["hq", source, *setting_words(settings)]
    words += option_words(
        {
            "--head": None if heads_mmHg is None else number_list(heads_mmHg),
            "--frequency": None if frequency_Hz is None else float(frequency_Hz),
            "--stroke": None if stroke_mm is None else float(stroke_mm),
            "--voltage": None if voltage_V is None else number_list(voltage_V),
            "--band": band,
            "--given": listed(given),
            "--tolerance": None if tolerance_l_per_min is None else float(tolerance_l_per_min),
            "--then": listed(then),
            "--campaign": campaign,
        }
    )
    return curves_of(run_json([*words, *petsc_words(petsc)], progress, launcher))


def validate(
    source: PathLike,
    data: PathLike,
    settings: Optional[Settings] = None,
    *,
    heads_mmHg: Optional[npt.ArrayLike] = None,
    points: Optional[int] = None,
    frequency_Hz: Optional[float] = None,
    stroke_mm: Optional[float] = None,
    voltage_V: Optional[float] = None,
    petsc: Sequence[str] = (),
    launcher: Sequence[str] = (),
    progress: Optional[ProgressCallback] = None,
) -> Dict[str, Any]:
    """The distance of a scene or a model from a measured curve: what `undula validate --json` prints.

    At `heads_mmHg`, or at `points` heads spread over the measured range. norm_to_fit_l_per_min is the 2-norm of
    computed minus measured flows, the measured ones from a parabola through the samples. Raises as hq.
    """
    words: List[object] = ["validate", source, f"--data={os.fspath(data)}", *setting_words(settings)]
    words += option_words(
        {
            "--head": None if heads_mmHg is None else number_list(heads_mmHg),
            "--points": points,
            "--frequency": None if frequency_Hz is None else float(frequency_Hz),
            "--stroke": None if stroke_mm is None else float(stroke_mm),
            "--voltage": None if voltage_V is None else float(voltage_V),
        }
    )
    return run_json([*words, *petsc_words(petsc)], progress, launcher)
