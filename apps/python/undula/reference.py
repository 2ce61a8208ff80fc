"""The reference of the package as a page, made of its docstrings: python3 -m undula.reference > docs/python_reference.md"""

from __future__ import annotations

import inspect
import re
import textwrap
from typing import Any, Callable, Dict, List

import undula

# Sections of the page, and what stands in each: every public name once.
SECTIONS: Dict[str, List[str]] = {
    "Models": ["load", "ReducedModel", "Emulator", "Curve", "Period", "fields", "PeriodFields", "flow_map", "FlowMap"],
    "Scenes, computed by the program": ["check", "solve", "hq", "validate", "Progress", "find_program"],
    "Many runs of a scene": ["calibrate", "Calibration", "train", "Trained", "report", "study"],
    "Files": [
        "read_curves", "RecordedCurve", "read_measured", "MeasuredCurve", "read_run", "Run", "FieldSeries", "FieldFrame",
        "read_table", "read_report", "read_record", "read_records", "RunRecord", "Hdf5File",
    ],
    "Pictures": ["plot", "plot_curve", "plot_period", "plot_map", "plot_run", "plot_fields", "plot_calibration"],
    "Errors and warnings": ["InputError", "NumericsError", "ProgramError", "CurveWarning", "RunWarning"],
}  # fmt: skip


def _text(item: Any) -> str:
    """A docstring without the signature that pybind11 puts in front."""
    text = re.sub(r"^\w+\(.*\) -> [^\n]*\n\n", "", inspect.cleandoc(item.__doc__ or "")).strip()
    return "\n\n".join(textwrap.fill(" ".join(part.split()), 138) for part in text.split("\n\n"))


def _signature(name: str, function: Callable[..., Any]) -> str:
    """As Python knows it; of the extension module by the first line of its docstring."""
    first = (function.__doc__ or "").splitlines()[0]
    if re.match(rf"{re.escape(name)}\(.*\) -> ", first):
        inside = re.sub(r"\w+(?:\.\w+)+", lambda m: m.group(0).rsplit(".", 1)[1], first)
        return re.sub(r"self: \w+(, )?", "", inside)
    signature = inspect.signature(function)
    parameters = [p for p in signature.parameters.values() if p.name != "self"]
    return f"{name}{signature.replace(parameters=parameters)}".replace("'", "")


def _block(signature: str) -> str:
    """A signature as a block of code, one argument per line where it is long."""
    if len(signature) > 100:
        depth, lines, line = 0, [], ""
        for character in signature:
            depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(character, 0)
            if character == ")" and depth == 0:
                lines.append(f"    {line.strip()}")
                line = ""
            line += character
            if (character == "(" and depth == 1) or (character == "," and depth == 1):
                lines.append(line if not lines else f"    {line.strip()}")
                line = ""
        signature = "\n".join([*lines, line])
    return f"```python\n{signature}\n```"


def _members(kind: type) -> List[str]:
    """What a class of the package has of its own: a line per property, an entry per method."""
    rows: List[str] = []
    methods: List[str] = []
    for name, member in vars(kind).items():
        if name.startswith("_"):
            continue
        if isinstance(member, property):
            rows.append(f"| `{name}` | {' '.join(_text(member).split())} |")
        elif callable(member):
            methods += ["", _block(_signature(name, member)), "", _text(member)]
    fields = [name for name in getattr(kind, "__dataclass_fields__", {}) if not name.startswith("_")]
    described = [f"Fields: {', '.join(f'`{name}`' for name in fields)}."] if fields else []
    table = ["| | |", "|---|---|", *rows] if rows else []
    return [line for part in (described, table) if part for line in ["", *part]] + methods


def page() -> str:
    """The whole page. Raises KeyError where a public name stands in no section."""
    listed = [name for names in SECTIONS.values() for name in names]
    for name in set(undula.__all__) - {"__version__"} ^ set(listed):
        raise KeyError(name)
    lines = [
        "# Reference of the Python package",
        "",
        "For who looks a name up; [python.md](python.md) explains by example. Made of the docstrings:",
        "",
        "    python3 -m undula.reference > docs/python_reference.md",
    ]
    for section, names in SECTIONS.items():
        lines += ["", f"## {section}"]
        for name in names:
            item = getattr(undula, name)
            lines += ["", f"### {name}", ""]
            if isinstance(item, type):
                lines += [_text(item), *_members(item)]
            else:
                lines += [_block(_signature(name, item)), "", _text(item)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(page(), end="")
