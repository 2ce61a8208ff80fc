"""The explorer's server: its numbers beside `hq --json`, and what it refuses."""

import json
import re
import time
from urllib.parse import quote, urlencode

import pytest
import undula
from conftest import OTHER, PROJECTED, SOURCE, curve_json, run_undula


def question(frequency, drive, heads):
    return "/curve?" + urlencode({"frequency": frequency, "drive": drive, "heads": heads})


def without_times(curve):
    for key in ("seconds", "preparation_seconds", "model", "remarks"):
        curve.pop(key, None)
    for point in curve["points"]:
        point.pop("seconds")
    return curve


def test_numbers_are_those_of_hq(explorer, explorer_by_voltage, emulator_by_voltage):
    response, text = explorer.ask(question(97.3, 0.41, "3:61:7.5"))
    assert response.status == 200 and response.getheader("Content-Type") == "application/json"
    printed = curve_json(PROJECTED, "--frequency", 97.3, "--stroke", 0.41, "--head", "3:61:7.5")
    assert len(printed["points"]) == 8
    assert without_times(json.loads(text)) == without_times(printed)
    text = explorer_by_voltage.ask(question(120, 47.9, "0,33.3,110"))[1]
    printed = curve_json(emulator_by_voltage, "--frequency", 120, "--voltage", 47.9, "--head", "0,33.3,110")
    assert without_times(json.loads(text)) == without_times(printed)


def test_other_models_answer_by_their_number(explorer, emulator_by_stroke):
    text = explorer.ask(question(115, 0.5, "30,60") + "&model=1")[1]
    printed = curve_json(emulator_by_stroke, "--frequency", 115, "--stroke", 0.5, "--head", "30,60")
    assert without_times(json.loads(text)) == without_times(printed)
    text = explorer.ask(question(120, 44, "50") + "&model=2")[1]
    printed = curve_json(OTHER, "--frequency", 120, "--voltage", 44, "--head", "50")
    assert without_times(json.loads(text)) == without_times(printed)


def test_the_first_model_within_a_tolerance_answers(explorer, emulator_by_stroke):
    """As `hq --tolerance --then`, but for what models are called."""
    stated = curve_json(emulator_by_stroke, "--frequency", 115, "--stroke", 0.53, "--head", "33,50,58")["points"]
    tolerance = sorted(p["error_l_per_min"] for p in stated)[1]
    text = explorer.ask(question(115, 0.53, "33,50,58") + f"&model=1&tolerance={tolerance}")[1]
    points = json.loads(text)["points"]
    words = ["--frequency", 115, "--stroke", 0.53, "--head", "33,50,58", "--tolerance", tolerance, "--then", PROJECTED]
    printed = curve_json(emulator_by_stroke, *words)["points"]
    assert [p["flow_l_per_min"] for p in points] == [p["flow_l_per_min"] for p in printed]
    assert {p["tier"] for p in points} == {"model.h5", "wave_pump_fixed.h5"} and all(p["why"] for p in points)
    assert [p["tier"] == "model.h5" for p in points] == [p["tier"] == "emulator" for p in printed]


def test_the_models_are_described(explorer, explorer_by_voltage):
    all_of_it = json.loads(explorer.ask("/models")[1])
    model, emulator, other = all_of_it["models"]
    assert model["model"] == "wave_pump_fixed.h5" and str(SOURCE) not in json.dumps(all_of_it)
    drive = model["ranges"]["drive"]
    assert (drive["name"], drive["unit"]) == ("stroke", "mm")
    assert (drive["low"], drive["high"]) == pytest.approx((0.1, 0.8), rel=1e-12)
    assert model["fluid"] == {"density_g_per_cm3": 1.0, "viscosity_poise": 0.035} and model["no_period"] == ""
    assert "not known" in emulator["no_period"] and other["ranges"]["drive"]["unit"] == "V"
    measured = all_of_it["measured"][0]
    assert (measured["stroke"], measured["voltage"]) == (0.53, 40) and len(measured["head_mmHg"]) > 50


def test_a_period_is_that_of_the_model(explorer):
    text = explorer.ask("/period?frequency=120&drive=0.53&head=50")[1]
    answer, period = json.loads(text), undula.load(PROJECTED).period(frequency_Hz=120, stroke_mm=0.53, head_mmHg=50)
    for name in ("time_s", "outflow_l_per_min", "inflow_l_per_min", "holder_mm", "radius_mm"):
        assert answer[name] == getattr(period, name).tolist(), name
    assert answer["membrane_mm"] == period.membrane_mm.tolist() and answer["periodic"] is True
    point = json.loads(explorer.ask(question(120, 0.53, "50"))[1])["points"][0]
    flows = answer["outflow_l_per_min"]
    assert sum(flows) / len(flows) == pytest.approx(point["flow_l_per_min"], rel=1e-12)


def test_the_scene_of_a_model_is_moved_to_the_point(explorer, tmp_path):
    response, text = explorer.ask("/scene?frequency=97.5&drive=0.41&head=33")
    assert response.status == 200 and "toml" in response.getheader("Content-Type")
    (tmp_path / "moved.toml").write_bytes(text)
    profile = SOURCE / "data/profiles/wave_pump_profile.toml"
    (tmp_path / profile.name).write_bytes(profile.read_bytes())
    moved = undula.check(tmp_path / "moved.toml")["resolved"]
    told = undula.load(PROJECTED).provenance["scene"]
    lost = {line for line in told.splitlines() if line not in moved.splitlines() and "profile =" not in line}
    assert lost == {"frequency_Hz = 120.0", "stroke_mm = 0.53", "head_mmHg = 50.0"}
    assert {"frequency_Hz = 97.5", "stroke_mm = 0.41", "head_mmHg = 33.0"} <= set(moved.splitlines())
    text = explorer.ask("/scene?model=2&frequency=120&drive=44&head=50")[1].decode()
    assert 'drive = "voltage"' in text and re.search(r"^voltage_V = 44.0$", text, re.MULTILINE)


@pytest.mark.parametrize(
    "path, text",
    [
        ("/curve", "one frequency"),
        (question("fast", 0.5, "50"), "no number"),
        (question("nan", 0.5, "50"), "no number"),
        (question(120, 0.5, ""), "one heads"),
        (question(120, 0.5, "0:70:0.1"), "too many heads"),
        (question(120, 0.5, "0:70:0.000001"), "more than 10000 heads"),
        (question(120, 0.5, "1,2,x"), "not a number"),
        (question(120, 0.5, "9" * 300), "at most 200 characters"),
        (question(500, 0.5, "50"), "stays in the box"),
        (question(120, 5, "50"), "stays in the box"),
        (question(120, 0.5, "500"), "stays in the box"),
        (question(120, 0.5, "50") + "&frequency=100", "one frequency"),
        (question(120, 0.5, "50") + "&model=3", "no such model"),
        (question(120, 0.5, "50") + "&model=-1", "no number of a model"),
        (question(120, 0.5, "50") + "&model=", "one model"),
        (question(120, 0.5, "50") + "&tolerance=0", "tolerance"),
        (question(120, 0.5, "50") + "&tolerance=nan", "no number"),
        ("/period", "one frequency"),
        ("/period?frequency=120&drive=0.5&head=500", "stays in the box"),
        ("/period?model=1&frequency=115&drive=0.5&head=50", "not known"),
        ("/scene?frequency=120&drive=5&head=50", "stays in the box"),
    ],
)
def test_what_is_no_question_is_refused(explorer, path, text):
    response, body = explorer.ask(path)
    assert response.status == 400
    assert text in json.loads(body)["error"] and "allowed:" in json.loads(body)["error"]


def test_other_hosts_methods_and_paths_are_refused(explorer):
    port = explorer.port
    for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", f"127.0.0.1:{port}.evil.example", ""):
        response, text = explorer.ask("/models", headers={"Host": host})
        assert response.status == 403 and b"ranges" not in text, host
    two = f"GET /models HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nHost: evil.example\r\n\r\n".encode()
    assert b" 403 " in explorer.send(two, more=True).split(b"\r\n")[0]
    assert b" 403 " in explorer.send(b"GET /models HTTP/1.0\r\n\r\n", more=True).split(b"\r\n")[0]
    assert explorer.ask("/models", headers={"Host": f"localhost:{port}"})[0].status == 200

    for method in ("POST", "PUT", "DELETE", "PATCH", "OPTIONS"):
        response, text = explorer.ask("/models", method)
        assert response.status == 405 and b"ranges" not in text, method
        # A body is never read: the connection may be cut before the answer is.
        request = f"{method} /models HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 100\r\n\r\n" + "x" * 100
        answer = explorer.send(request.encode())
        assert answer == b"" or b" 405 " in answer.split(b"\r\n")[0], method
    assert explorer.ask("/models", "HEAD")[0].status == 200

    for path in ("/etc/passwd", "/../etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd", "/data/models/wave_pump_fixed.h5",
                 "/explore.js/../../x", "/%2e%2e/%2e%2e/etc/passwd", "/curve/", "/models/", "/model", "/." , "/index.html"):  # fmt: skip
        response, text = explorer.ask(path)
        assert response.status == 404 and b"root:" not in text, path


def test_a_thousand_malformed_requests_do_no_harm(explorer):
    import random

    chance = random.Random(20)
    port = explorer.port
    host = f"Host: 127.0.0.1:{port}\r\n"
    for i in range(1000):
        kind = i % 5
        if kind == 0:  # a path of any characters
            path = "/" + "".join(quote(chr(chance.randrange(1, 256))) for _ in range(chance.randrange(1, 60)))
            request = f"GET {path} HTTP/1.1\r\n{host}\r\n".encode()
        elif kind == 1:  # no request at all
            request = bytes(chance.randrange(256) for _ in range(chance.randrange(1, 200)))
        elif kind == 2:  # too long
            request = (f"GET /{'a' * chance.randrange(9000, 20000)} HTTP/1.1\r\n{host}\r\n").encode()
        elif kind == 3:  # a body that hides another request
            inner = f"GET /models HTTP/1.1\r\n{host}\r\n"
            request = f"POST /curve HTTP/1.1\r\n{host}Content-Length: {chance.choice([3, 10**9, len(inner)])}\r\n\r\n{inner}".encode()
        else:  # a question with something wrong
            query = "&".join(f"{chance.choice(['frequency', 'drive', 'heads', '%00'])}={chance.choice(['', '1e999', '-1', '%ff', '0:1:-1', '{}'])}" for _ in range(4))
            request = f"GET /curve?{query} HTTP/1.1\r\n{host}\r\n".encode()
        answer = explorer.send(request)
        assert b" 200 " not in answer.split(b"\r\n")[0] and b"ranges" not in answer, request
    assert explorer.process.poll() is None
    assert explorer.ask(question(120, 0.53, "50"))[0].status == 200


def test_it_listens_on_this_machine_alone(explorer):
    listening = [line.split() for line in open("/proc/net/tcp").read().splitlines()[1:]]
    addresses = {line[1] for line in listening if line[3] == "0A" and int(line[1].split(":")[1], 16) == explorer.port}
    assert addresses == {f"0100007F:{explorer.port:04X}"}
    assert explorer.port not in {int(line.split()[1].split(":")[1], 16) for line in open("/proc/net/tcp6").read().splitlines()[1:]}


def test_answers_say_how_browsers_have_to_treat_them(explorer):
    for path in ("/", "/explore.js", "/explore.css", "/models"):
        response, text = explorer.ask(path)
        assert response.status == 200 and text
        assert "default-src 'self'" in response.getheader("Content-Security-Policy")
        assert response.getheader("X-Content-Type-Options") == "nosniff"
        assert response.getheader("Access-Control-Allow-Origin") is None
    page = explorer.ask("/")[1].decode()
    assert not re.search(r"https?://", page), "works without network"
    for file, path in (("index.html", "/"), *((name, f"/{name}") for name in ("explore.js", "charts.js", "period.js", "exports.js", "explore.css"))):
        assert explorer.ask(path)[1] == (SOURCE / "apps/explorer/page" / file).read_bytes()


def test_an_emulator_answers_at_once(explorer_by_voltage):
    times = []
    for i in range(50):
        begin = time.monotonic()
        assert explorer_by_voltage.ask(question(120, 40 + i / 10, "0:110:5"))[0].status == 200
        times.append(time.monotonic() - begin)
    assert sorted(times)[25] < 0.05


def test_wrong_calls_are_refused(explorer, tmp_path):
    assert "too long to be explored" in run_undula("explore", SOURCE / "data/scenes/wave_pump_fixed.toml", exit_code=2)[1]
    assert "no such file" in run_undula("explore", tmp_path / "none.h5", exit_code=2)[1]
    assert "no such file" in run_undula("explore", PROJECTED, tmp_path / "none.h5", exit_code=2)[1]
    assert "models is required" in run_undula("explore", exit_code=2)[1]
    assert "where:" in run_undula("explore", PROJECTED, "--data", tmp_path / "none.csv", exit_code=2)[1]
    log = run_undula("explore", PROJECTED, "--port", explorer.port, exit_code=2)[1]
    assert "port cannot be served" in log and str(explorer.port) in log
