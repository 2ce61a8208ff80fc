"""Completion in bash and zsh offers what the program's own help names."""

import re
import subprocess

import pytest
from conftest import run_undula

COMMANDS = re.findall(r"^  (\w+) +\S", run_undula("--help")[0].split("Subcommands:")[1], re.MULTILINE)


def options_of(command):
    """Options by the help of a command."""
    text = run_undula(command, "--help")[0]
    return set(re.findall(r"(?:^  |,)(--?[A-Za-z][\w-]*)", text.split("Options:")[1].split("\n\n")[0], re.MULTILINE))


@pytest.fixture(scope="module")
def scripts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("completion")
    for shell in ("bash", "zsh"):
        (folder / shell).write_text(run_undula("completion", shell)[0])
    return folder


def in_bash(scripts, *words):
    """What bash offers for the last word."""
    script = (
        f'source "{scripts}/bash"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _undula; printf "%s\\n" "${{COMPREPLY[@]}}"'
    )
    done = subprocess.run(
        ["bash", "--norc", "-uc", script, "bash", "undula", *words], capture_output=True, text=True, check=True
    )
    assert done.stderr == ""
    return set(done.stdout.split())


def test_bash_offers_every_command_and_option(scripts):
    assert len(COMMANDS) >= 10
    assert in_bash(scripts, "") == set(COMMANDS)
    assert in_bash(scripts, "ca") == {"calibrate"}
    for command in COMMANDS:
        assert in_bash(scripts, command, "-") == options_of(command), command
    assert "--version" in in_bash(scripts, "--")


def test_bash_knows_what_follows_an_option(scripts):
    assert in_bash(scripts, "check", "a.toml", "--set", "operating_point.str") == {
        "operating_point.stroke_mm=",
        "operating_point.stroke_scale=",
    }
    assert in_bash(scripts, "hq", "--data", "-") == set()  # a file: the shell's own completion
    assert in_bash(scripts, "new", "") == {"wave-pump", "peristaltic-pump", "general"}
    assert in_bash(scripts, "completion", "z") == {"zsh"}


def test_zsh_offers_every_command_and_option(scripts):
    # _arguments of the shell is replaced by one that says what it was asked for.
    script = """
_arguments() { print -rl -- "$@"; [[ "$1" == -C ]] && state=argument; return 0 }
_describe() { print -rl -- "${(@P)4}" }
compdef() { : }
source "$1"
words=("$2")
_undula
"""
    for command in COMMANDS:
        done = subprocess.run(
            ["zsh", "-f", "-c", script, "zsh", scripts / "zsh", command], capture_output=True, text=True, check=True
        )
        assert done.stderr == ""
        specifications = done.stdout.split("*::argument:->argument\n")[1].splitlines()
        offered = {match.group(1) for line in specifications if (match := re.match(r"\*?(--?[A-Za-z][\w-]*)\[", line))}
        assert offered == options_of(command), command
    text = (scripts / "zsh").read_text()
    for command in COMMANDS:
        assert f"'{command}:" in text


def test_zsh_itself_takes_the_script(scripts):
    """In a real shell behind a terminal of its own: TAB after `undula calib`, and after an option."""
    script = f"""
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PS1=; autoload -Uz compinit && compinit -D -u; source {scripts}/zsh; print READ''Y"
zpty -r -m shell line '*READY*' || exit 1
zpty -w -n shell $'undula calib\\t'
zpty -r -m shell line '*undula calibrate*' || exit 1
zpty -w -n shell $'--tolera\\t'
zpty -r -m shell line '*--tolerances*' || exit 1
print DONE
zpty -d shell
"""
    done = subprocess.run(["zsh", "-f", "-c", script], capture_output=True, text=True, timeout=60)
    assert "DONE" in done.stdout, done.stdout + done.stderr
