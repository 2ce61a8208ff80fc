"""The program `undula` as a child process: the package itself stays free of MPI and PETSc."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import warnings
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import IO, Any, Callable, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np

from undula._rom import InputError, NumericsError, __version__
from undula.errors import ProgramError, RunWarning, refused

PathLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Progress:
    """How far a computation is: `done` of `total` steps, runs or curves of what `label` names."""

    label: str
    done: int
    total: int
    seconds_left: Optional[float]  # at the pace so far; None where nothing is known


ProgressCallback = Callable[[Progress], None]


def find_program() -> str:
    """The program that computes scenes: what the environment variable UNDULA names; else the one that was built or
    installed with this package; else the first one in the PATH, which has to be of the package's version. Raises
    InputError where there is none."""
    named = os.environ.get("UNDULA")
    package = Path(__file__).resolve().parent
    places = [package.parents[1] / "undula"]  # BUILD/python/undula
    if len(package.parents) > 3:
        places.append(package.parents[3] / "bin/undula")  # PREFIX/lib/pythonX.Y/site-packages/undula
    candidates = [Path(named)] if named else places
    for candidate in candidates:
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return str(candidate)
    found = None if named else shutil.which("undula")
    if found is None:
        looked = named if named else ", ".join(map(str, candidates)) + ", PATH"
        raise refused(
            "the program undula is not found",
            f"none at {looked}",
            "the program of the same version, in the PATH or named by the environment variable UNDULA",
            "environment",
        )
    _require_version(found)
    return found


@lru_cache(maxsize=None)
def _require_version(program: str) -> None:
    said = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False).stdout
    version = re.search(r"\d+\.\d+\.\d+", said)
    if version is None or version.group(0) != __version__:
        seen = said.strip().splitlines()[0] if said.strip() else "no version"
        allowed = f"version {__version__}, as this package; or the environment variable UNDULA, which is taken as it is"
        raise refused("the program undula in the PATH is of another version", seen, allowed, program)


def setting_words(settings: Optional[Mapping[str, Any]]) -> List[str]:
    """--set words of {"section.key": value}. Texts, numbers, truth values, and lists of them."""

    def text(key: str, value: Any) -> str:
        if isinstance(value, (np.generic, np.ndarray)):
            value = value.tolist()
        if isinstance(value, os.PathLike):
            value = os.fspath(value)
        if isinstance(value, tuple):
            value = list(value)
        try:
            return json.dumps(value, ensure_ascii=False)
        except (TypeError, ValueError):
            raise refused(
                f'the setting "{key}" has no value that a scene takes',
                f"{value!r}, a {type(value).__name__}",
                "a number, a text, True or False, or a list of them",
                "settings",
            ) from None

    words: List[str] = []
    for key, value in (settings or {}).items():
        words += ["--set", f"{key}={text(key, value)}"]
    return words


def run_json(
    words: Sequence[object], progress: Optional[ProgressCallback] = None, launcher: Sequence[str] = ()
) -> Dict[str, Any]:
    """What `undula WORDS --json` prints. Its warnings are given as RunWarning.

    `progress` is called at most five times a second; `launcher` stands in front of the program, ["mpirun", "-np", "2"].
    Raises InputError, NumericsError, ProgramError. KeyboardInterrupt, and whatever `progress` raises, are passed on as
    SIGINT: the program ends its step, keeps its state, and the exception goes on once it has; a second
    KeyboardInterrupt ends it at once.
    """
    before = [str(word) for word in words]
    # What follows "--" goes to PETSc.
    place = before.index("--") if "--" in before else len(before)
    command = [*launcher, find_program(), *before[:place], "--json", *before[place:]]
    log = _Log(progress)
    with tempfile.TemporaryFile("w+", encoding="utf-8") as printed:
        exit_code = _run(command, printed, log)
        printed.seek(0)
        text = printed.read()
    for sentence in log.warnings:
        warnings.warn(sentence, RunWarning, stacklevel=3)
    if exit_code == 0:
        try:
            answer: Dict[str, Any] = json.loads(text)
        except json.JSONDecodeError as error:
            raise ProgramError(f"{command[len(launcher)]} printed no JSON: {error}\n{text[:500]}") from None
        return answer
    raise _failure(exit_code, log, words)


class _Log:
    """stderr of the program, line by line."""

    def __init__(self, progress: Optional[ProgressCallback]) -> None:
        self._progress = progress
        self.warnings: List[str] = []
        self.lines: List[str] = []  # all that is no progress
        self._warns = False

    def take(self, line: str) -> None:
        line = line.rstrip("\n")
        if line.startswith('{"progress":'):
            record = json.loads(line)
            if self._progress is not None:
                self._progress(Progress(record["progress"], record["done"], record["total"], record["seconds_left"]))
            return
        self.lines.append(line)
        if re.match(r"(trace|debug|info|warning|error|critical|undula): ", line):
            self._warns = line.startswith("warning: ")
            if self._warns:
                self.warnings.append(line[len("warning: ") :])
        elif self._warns and line.startswith("  "):
            self.warnings[-1] += "\n" + line

    def message(self) -> Optional[str]:
        """The last message "undula: ..." with its parts; None where there is none."""
        starts = [i for i, line in enumerate(self.lines) if line.startswith("undula: ")]
        if not starts:
            return None
        lines = [self.lines[starts[-1]][len("undula: ") :]]
        for line in self.lines[starts[-1] + 1 :]:
            if not line.startswith("  "):
                break
            lines.append(line)
        return "\n".join(lines)


def _run(command: Sequence[str], printed: IO[str], log: _Log) -> int:
    environment = {**os.environ, "UNDULA_PROGRESS": "json"}
    try:
        # A session of its own: Ctrl-C in a terminal reaches this process alone, which passes it on once.
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=printed,
            stderr=subprocess.PIPE,
            env=environment,
            text=True,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )
    except OSError as error:
        raise refused("the program cannot be started", str(error), "a program that runs", command[0]) from None
    assert process.stderr is not None
    with process.stderr:
        try:
            for line in process.stderr:
                log.take(line)
            return process.wait()
        except BaseException as reason:
            _stop(process, process.stderr, log)
            said = log.message()
            if isinstance(reason, KeyboardInterrupt) and said is not None:
                raise KeyboardInterrupt(said) from None
            raise


def _stop(process: "subprocess.Popen[str]", stream: IO[str], log: _Log) -> None:
    """SIGINT, and what the program says until it has ended. Twice interrupted, it ends at once."""
    quiet = _Log(None)
    quiet.lines = log.lines
    try:
        process.send_signal(signal.SIGINT)
        for line in stream:
            quiet.take(line)
        process.wait()
    except BaseException:
        process.send_signal(signal.SIGINT)  # by its second one, the program ends without keeping anything
        try:
            process.wait(timeout=10)
        except BaseException:
            process.kill()
            process.wait()
        raise


def _failure(exit_code: int, log: _Log, words: Sequence[object]) -> Exception:
    message = log.message()
    if message is not None and "\n  seen: " in message and exit_code == 2:
        return InputError(message)
    if message is not None and "\n  at: " in message and exit_code == 1:
        return NumericsError(message)
    if exit_code == 2 and message is None:  # the command line itself
        said = " ".join(line for line in log.lines if not line.startswith(("Run with", "info: ", "warning: ")))
        return refused(
            "the program does not take these words",
            f"{' '.join(map(str, words))}: {said}",
            f"what `undula {words[0]} --help` names",
            "the arguments of the call",
        )
    ended = f"by signal {-exit_code}" if exit_code < 0 else f"with exit code {exit_code}"
    return ProgramError(message or f"undula {words[0]} ended {ended}\n" + "\n".join(log.lines[-10:]))
