"""Help for who writes scenes: the JSON schema that editors go by, and scenes to begin with."""

import json
import re
import tomllib

import jsonschema
import pytest
from conftest import SOURCE, run_undula

SCENES = sorted((SOURCE / "data/scenes").glob("*.toml"))
BAD_SCENES = sorted((SOURCE / "tests/data/bad/scenes").glob("*.toml"))

# Messages of the parser on what one key says by itself. The others need several keys, files, or geometry.
OF_ONE_KEY = re.compile(
    "is out of range|has a value of the wrong type|has an unknown value|^unknown key \"|^unknown section|is missing"
    "|does not carry the unit|does not apply to this scene|does not offer yet|takes no tolerance|is empty"
    "|begins with a dot|is too long|has a control character|has a character that names must not have"
    "|has a point of the wrong form|has a point that is too far away|is a section, not a value"
    "|stands outside of a named section|cannot stand for an entry|makes no sense in a scene of a pump"
    "|the tolerance of key .* makes no sense|has no value|has a name that is empty"
)


@pytest.fixture(scope="module")
def validator():
    schema = json.loads(run_undula("schema")[0])
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def problems(validator, text):
    return [f"{'.'.join(map(str, e.absolute_path))}: {e.message}" for e in validator.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("file", SCENES, ids=lambda file: file.stem)
def test_every_shipped_scene_fits_the_schema(validator, file):
    assert problems(validator, file.read_text()) == []


@pytest.mark.parametrize("file", BAD_SCENES, ids=lambda file: file.stem)
def test_what_the_parser_refuses_of_a_key_the_schema_refuses(validator, file):
    message = run_undula("check", file, exit_code=2)[1].removeprefix("undula: ").splitlines()
    message = next(line for line in message if not line.startswith(("warning", "info"))).removeprefix("undula: ")
    try:
        found = problems(validator, file.read_text())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError):
        return  # editors see that without a schema
    if OF_ONE_KEY.search(message) and "nan" not in file.read_text():  # JSON knows no nan
        assert found, message


def test_the_parser_refuses_a_good_part_of_the_bad_scenes_by_keys(validator):
    """Else the test above says nothing."""
    refused = 0
    for file in BAD_SCENES:
        try:
            refused += bool(problems(validator, file.read_text()))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError):
            pass
    assert refused > 40


def test_every_range_is_that_of_the_parser(validator):
    """Both sides of the bounds of every third number, in a scene of thin gaps."""
    scene = SOURCE / "data/scenes/wave_pump_thin_gap.toml"
    text = scene.read_text()
    tables = validator.schema["properties"]
    tried = 0
    for section in ("fluid", "membrane", "operating_point", "mesh", "thin_gap", "actuator"):
        for name, key in list(tables[section]["properties"].items())[::3]:
            if key.get("type") not in (["number", "object"], "integer"):
                continue
            for bound, beyond in (("minimum", -1), ("exclusiveMinimum", 0), ("maximum", 1), ("exclusiveMaximum", 0)):
                if bound not in key:
                    continue
                value = key[bound] + beyond * max(1, abs(key[bound]) * 1e-3)
                shown = json.dumps(int(value) if key["type"] == "integer" else float(value))
                log = run_undula("check", scene, "--set", f"{section}.{name}={shown}", exit_code=2)[1]
                assert "is out of range" in log, (section, name, shown)
                changed = tomllib.loads(text)
                changed.setdefault(section, {})[name] = json.loads(shown)
                assert not validator.is_valid(changed), (section, name, shown)
                tried += 1
    assert tried >= 20


def test_schema_has_help_for_every_key_of_the_reference(validator):
    reference = run_undula("check", "--reference")[0]
    section, compared = "", 0
    for line in reference.splitlines():
        if match := re.match(r"## \[(.*)\]|## Outside", line):
            section = match.group(1) or ""
        elif match := re.match(r"\| `(\w+)`", line):
            table = validator.schema["properties"]
            if section.endswith(".NAME"):
                (table,) = table[section.removesuffix(".NAME")]["patternProperties"].values()
                table = table["properties"]
            elif section:
                table = table[section]["properties"]
            assert len(table[match.group(1)]["description"]) > 10
            compared += 1
    assert compared > 150


@pytest.mark.parametrize("kind", ["wave-pump", "peristaltic-pump", "general"])
@pytest.mark.parametrize("more", [[], ["--all"]])
def test_a_new_scene_is_valid_and_explained(validator, tmp_path, kind, more):
    printed = run_undula("new", kind, "mine.toml", *more, folder=tmp_path)[0].splitlines()
    assert printed == ["mine.toml", "mine_profile.toml"][: len(printed)] and len(printed) == (kind == "wave-pump") + 1
    assert "scene mine is valid" in run_undula("check", "mine.toml", folder=tmp_path)[0]
    text = (tmp_path / "mine.toml").read_text()
    assert problems(validator, text) == []
    # The same values as the scene that it comes from.
    origin = {"wave-pump": "wave_pump_thin_gap", "peristaltic-pump": "peristaltic_pump", "general": "flap_in_channel"}[kind]
    new, old = tomllib.loads(text), tomllib.loads((SOURCE / f"data/scenes/{origin}.toml").read_text())
    if kind == "wave-pump":
        assert new["geometry"].pop("profile") == "mine_profile.toml" and old["geometry"].pop("profile")
        published = SOURCE / "data/profiles/wave_pump_profile.toml"
        assert (tmp_path / "mine_profile.toml").read_bytes() == published.read_bytes()
    new = {section: keys for section, keys in new.items() if keys}  # those with defaults alone are empty
    assert new.pop("name") == "mine" and old.pop("name") and new == old
    # Every key is explained; --all shows the others with their defaults, which are no change.
    assert all(len(line) < 120 for line in text.splitlines())
    lines = text.splitlines()
    for i, line in enumerate(lines):
        if re.match(r"(# )?\w+ = ", line) and "constants" not in "".join(lines[max(0, i - 5) : i]):
            assert lines[i - 1].startswith("# ")
    commented = [line for line in lines if re.match(r"# \w+ = ", line)]
    assert bool(commented) == bool(more)


def test_commented_defaults_of_a_new_scene_are_the_defaults(tmp_path):
    run_undula("new", "wave-pump", "mine.toml", "--all", folder=tmp_path)
    text = (tmp_path / "mine.toml").read_text()
    plain = json.loads(run_undula("check", "mine.toml", "--json", folder=tmp_path)[0])
    uncommented = re.sub(r"(?m)^# (\w+ = )", r"\1", text)
    assert uncommented != text
    # What is derived where it is left out counts as left out: 0 asks for it.
    (tmp_path / "mine.toml").write_text(uncommented)
    full = json.loads(run_undula("check", "mine.toml", "--json", folder=tmp_path)[0])
    assert full["resolved"] == plain["resolved"] and full["hash"] == plain["hash"]


def test_new_replaces_nothing(tmp_path):
    (tmp_path / "a.toml").write_text("mine")
    log = run_undula("new", "general", "a.toml", folder=tmp_path, exit_code=2)[1]
    assert all(part in log for part in ("seen:", "allowed:", "where:", "a.toml"))
    (tmp_path / "b_profile.toml").write_text("mine")
    run_undula("new", "wave-pump", "b.toml", folder=tmp_path, exit_code=2)
    assert not (tmp_path / "b.toml").exists()
    (tmp_path / "c.toml").symlink_to("nowhere")
    run_undula("new", "general", "c.toml", folder=tmp_path, exit_code=2)
    assert not (tmp_path / "nowhere").exists()
    assert (tmp_path / "a.toml").read_text() == (tmp_path / "b_profile.toml").read_text() == "mine"
    for name in ("no_ending", ".toml", "none/there.toml"):
        run_undula("new", "general", name, folder=tmp_path, exit_code=2)
    run_undula("new", "peristaltic", "d.toml", folder=tmp_path, exit_code=2)
    run_undula("new", "general", folder=tmp_path)
    assert (tmp_path / "general.toml").exists()
