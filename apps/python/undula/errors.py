"""What goes wrong, in parts. InputError and NumericsError come from the module that computes."""

from __future__ import annotations

import re
from typing import Optional

from undula._rom import InputError, NumericsError


class ProgramError(RuntimeError):
    """The program `undula` ended without an answer, and neither input nor numerics are the reason: it was stopped from
    outside, the disk is full, or it is none of this package's version. The message is what it said."""


class RunWarning(UserWarning):
    """What the program `undula` warned of while it computed: what has to be known before an answer is believed."""


_NEXT = r"\n  (?:seen|allowed|where|at|try): "


def _part(message: str, name: str) -> Optional[str]:
    """The part of a message that `name` stands before; the first one for "what"."""
    if name == "what":
        return re.split(_NEXT, message)[0]
    found = re.search(rf"\n  {name}: +(.*?)(?={_NEXT}|\Z)", message, re.DOTALL)
    return None if found is None else found.group(1)


def _getter(name: str) -> property:
    def get(error: BaseException) -> Optional[str]:
        return _part(str(error), name)

    get.__doc__ = f'The part "{name}" of the message; None where it has no such part.'
    return property(get)


# Parts of the messages as attributes of the module's own classes.
for _name in ("what", "seen", "allowed", "where"):
    setattr(InputError, _name, _getter(_name))
for _name, _attribute in (("what", "what"), ("at", "at"), ("try", "to_try")):
    setattr(NumericsError, _attribute, _getter(_name))


def refused(what: str, seen: str, allowed: str, where: str) -> InputError:
    """An InputError with its four parts."""
    return InputError(f"{what}\n  seen:    {seen}\n  allowed: {allowed}\n  where:   {where}")
