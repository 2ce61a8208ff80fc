"""The explorer: its page, its numbers beside `hq --json`, and what it refuses."""

import http.client
import json
import re
import signal
import socket
import subprocess
import time
from urllib.parse import quote, urlencode

import pytest
import undula
from conftest import MEASURED, PROGRAM, PROJECTED, SOURCE, curve_json, run_undula


class Explorer:
    """A running `undula explore`."""

    def __init__(self, *words):
        self.process = subprocess.Popen([PROGRAM, "explore", *map(str, words)], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        self.port = int(re.fullmatch(r"http://127\.0\.0\.1:(\d+)/", self.url).group(1))

    def ask(self, path, method="GET", body=None, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, path, body=body, headers=headers or {})
        response = connection.getresponse()
        text = response.read()
        connection.close()
        return response, text

    def send(self, request, more=False):
        """Raw bytes, and the answer; empty where the connection is closed without one. With `more` the server is not
        told that nothing follows: one that sees the end of a connection may leave its answer out."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=20) as stream:
            try:
                stream.sendall(request)
                if not more:
                    stream.shutdown(socket.SHUT_WR)
                answer = b""
                while part := stream.recv(65536):
                    answer += part
            except (ConnectionResetError, BrokenPipeError):
                return b""
        return answer

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=20)


OTHER = SOURCE / "data/models/wave_pump_mapped_voltage.h5"


@pytest.fixture(scope="module")
def explorer(emulator_by_stroke):
    """The shipped projected model, an emulator driven alike, and one that a voltage drives."""
    running = Explorer(PROJECTED, emulator_by_stroke, OTHER, "--data", MEASURED)
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="module")
def explorer_by_voltage(emulator_by_voltage):
    running = Explorer(emulator_by_voltage, OTHER, "--data", MEASURED)
    yield running
    assert running.stop() == 0


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


@pytest.fixture(scope="module")
def browser():
    """Chromium without a window."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    for word in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1200,900"):
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    options.binary_location = "/usr/bin/chromium"
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    yield driver
    driver.quit()


def rows_of(browser):
    script = """return [...document.querySelectorAll("#numbers tbody tr")].map(
        (row) => [...row.cells].slice(0, 3).map((cell) => Number(cell.dataset.value)))"""
    return browser.execute_script(script)


def rows_when(browser, accepted):
    """The table, once it is what is waited for."""
    until = time.monotonic() + 20
    while time.monotonic() < until:
        rows = rows_of(browser)
        if rows and accepted(rows):
            return rows
        time.sleep(0.02)
    raise AssertionError(f"the table stays as it is: {rows_of(browser)[:2]}")


def printed_rows(model, drive, heads):
    points = curve_json(model, "--frequency", 120, "--voltage", drive, "--head", heads)["points"]
    return [[p["head_mmHg"], p["flow_l_per_min"], p["error_l_per_min"]] for p in points]


def test_the_page_shows_the_numbers_of_hq(browser, explorer_by_voltage, emulator_by_voltage):
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    # 1. At the point that a link states.
    browser.get(explorer_by_voltage.url + "#frequency=120&drive=43&low=20&high=68")
    first = rows_when(browser, lambda rows: len(rows) == 25)
    assert first == printed_rows(emulator_by_voltage, 43, "20:68:2")
    assert "20 mmHg" in browser.find_element(By.ID, "summary").text

    # 2. A slider moved by keys; the address keeps the state.
    slider = browser.find_element(By.ID, "drive")
    slider.send_keys(Keys.ARROW_RIGHT * 3)
    value = slider.get_attribute("value")
    assert float(value) > 43
    expected = printed_rows(emulator_by_voltage, value, "20:68:2")
    assert expected != first
    rows_when(browser, lambda rows: rows == expected)
    assert f"drive={value}" in browser.current_url
    assert browser.find_element(By.ID, "drive-value").text == f"{value} V"
    browser.refresh()
    rows_when(browser, lambda rows: rows == expected)

    # 3. Heads outside of the box are refused in words, and the page goes on.
    field = browser.find_element(By.ID, "head-high")
    field.clear()
    field.send_keys("500")
    until = time.monotonic() + 20
    while "stays in the box" not in (said := browser.find_element(By.ID, "error").text) and time.monotonic() < until:
        time.sleep(0.02)
    assert "stays in the box" in said and rows_of(browser) == []
    field.clear()
    field.send_keys("68")
    rows_when(browser, lambda rows: rows == expected)
    assert browser.find_element(By.ID, "error").text == ""

    # 4. What is drawn, and for whom does not see it. The page is done once the other model stands beside the curve.
    when(browser, WHOLE)
    when(browser, 'return document.querySelectorAll("#chart polyline").length === 2')
    assert len(browser.find_elements(By.CSS_SELECTOR, "#chart polygon.band")) == 1
    line = browser.find_element(By.CSS_SELECTOR, "#chart polyline.curve:not(.beside-1)").get_attribute("points")
    assert len(line.split()) == 25
    samples = len(undula.read_measured(MEASURED))
    assert len(browser.find_elements(By.CSS_SELECTOR, "#chart circle.sample.other")) == samples
    for control in browser.find_elements(By.CSS_SELECTOR, "input, select, button"):
        if control.is_displayed():
            assert control.accessible_name, control.get_attribute("id")
    for picture in browser.find_elements(By.CSS_SELECTOR, "svg"):
        assert not picture.is_displayed() or picture.accessible_name
    refused = [entry for entry in browser.get_log("browser") if "400" not in entry["message"]]
    assert refused == []


@pytest.mark.parametrize("width", [320, 500, 1400])
def test_the_page_fits_any_window(browser, explorer, width):
    browser.set_window_size(max(width, 500), 900)
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    )
    browser.get(explorer.url)
    rows_when(browser, lambda rows: len(rows) == 25)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def when(browser, script, *arguments):
    """What a script returns, once it is true."""
    until = time.monotonic() + 20
    while time.monotonic() < until:
        if found := browser.execute_script(script, *arguments):
            return found
        time.sleep(0.02)
    raise AssertionError(f"never true: {script}")


WHOLE = 'return document.querySelectorAll("#numbers tbody tr").length === 25 && document.querySelectorAll("#point dd").length > 5'


def line_of(browser, selector):
    return browser.find_element("css selector", selector).get_attribute("points")


def test_the_membrane_moves_as_the_period_says(browser, explorer):
    from selenium.webdriver.common.keys import Keys

    browser.get("about:blank")
    browser.get(explorer.url + "#frequency=120&drive=0.53&head=50")
    when(browser, WHOLE)
    when(browser, 'return !document.getElementById("period").hidden')
    # 1. It plays by itself, and stops.
    play = browser.find_element("id", "play")
    assert play.text == "Pause" and play.get_attribute("aria-pressed") == "true"
    before = line_of(browser, "#membrane-chart polyline.curve")
    when(browser, 'return document.querySelector("#membrane-chart polyline.curve").getAttribute("points") !== arguments[0]', before)
    play.click()
    assert play.text == "Play"
    still = line_of(browser, "#membrane-chart polyline.curve")
    time.sleep(0.3)
    assert line_of(browser, "#membrane-chart polyline.curve") == still

    # 2. The instant by keys: the line is the membrane of the model there, in the scale that the envelope tells.
    slider = browser.find_element("id", "instant")
    slider.send_keys(Keys.HOME)
    slider.send_keys(Keys.ARROW_RIGHT * 20)
    period = undula.load(PROJECTED).period(frequency_Hz=120, stroke_mm=0.53, head_mmHg=50)
    assert browser.find_element("id", "instant-value").text.startswith("%.4g ms" % (1e3 * period.time_s[20]))
    points = [tuple(map(float, pair.split(","))) for pair in line_of(browser, "#membrane-chart polyline.curve").split()]
    reach = [float(pair.split(",")[1]) for pair in line_of(browser, "#membrane-chart polygon.band").split()]
    low, high = period.membrane_mm.min(), period.membrane_mm.max()
    scale = (max(reach) - min(reach)) / (high - low)
    expected = [max(reach) - scale * (value - low) for value in period.membrane_mm[:, 20]]
    assert [y for _, y in points] == pytest.approx(expected, abs=1e-6)
    outflow = line_of(browser, "#flow-chart polyline.curve:not(.beside-1)").split()
    assert len(outflow) == len(period.time_s)
    said = browser.find_element("id", "flow-summary").text
    assert "%.4g and %.4g l/min" % (period.outflow_l_per_min.min(), period.outflow_l_per_min.max()) in said

    # 3. Numbers at the head are those of the model; what it does not know is said.
    rows = browser.execute_script('return Object.fromEntries([...document.querySelectorAll("#point dt")].map((t) => [t.textContent, t.nextSibling.dataset.value ?? t.nextSibling.textContent]))')
    curve = undula.load(PROJECTED).curve(frequency_Hz=120, stroke_mm=0.53, heads_mmHg=50)
    assert float(rows["flow (l/min)"]) == curve.flow_l_per_min[0]
    assert float(rows["hydraulic power (mW)"]) == curve.hydraulic_power_mW[0]
    assert rows["stroke of the holder (mm)"] == "0.53, imposed" and rows["efficiency (%)"] == "not known"
    assert "0.035 poise" in browser.find_element("id", "fluid").text and "no slider" in browser.find_element("id", "fluid").text
    # 4. It was shown by a few heads first.
    assert re.match(r"reduced model: 5 points after \d+ ms, 25 points after \d+ ms", browser.find_element("id", "status").text)


def test_an_emulator_says_that_it_knows_no_period(browser, explorer_by_voltage):
    browser.get("about:blank")
    browser.get(explorer_by_voltage.url + "#quantity=blood.scalar_stress_max_Pa&drive=45")
    when(browser, WHOLE)
    said = when(browser, 'const p = document.getElementById("no-period"); return !p.hidden && p.textContent')
    assert "not known" in said and not browser.find_element("id", "period").is_displayed()
    assert "does not know: greatest shear stress" in browser.find_element("id", "quantity-summary").text
    select = browser.find_element("id", "quantity")
    select.send_keys("efficiency")
    said = when(browser, 'const t = document.getElementById("quantity-summary").textContent; return t.startsWith("efficiency") && t')
    assert "quantity=holder.efficiency_percent" in browser.current_url and re.search(r"efficiency \(%\): [0-9.]+ at 0 mmHg", said)


def test_other_models_are_drawn_beside(browser, explorer, emulator_by_stroke):
    browser.get("about:blank")
    browser.get(explorer.url + "#frequency=115&drive=0.5&head=45")
    when(browser, WHOLE)
    when(browser, 'return document.querySelectorAll("#chart polyline.beside-1").length === 1')
    boxes = browser.find_elements("css selector", "#other-list input")
    assert [box.is_enabled() for box in boxes] == [True, False]
    assert "driven by a voltage" in browser.find_element("id", "why-2").text
    assert "model.h5, emulator" in browser.find_element("id", "key").text
    # Outside of its box it is not drawn, and that is said; unticked neither. The link restores it.
    boxes[0].click()
    when(browser, 'return document.querySelectorAll("#chart polyline.beside-1").length === 0')
    browser.refresh()
    when(browser, WHOLE)
    assert not browser.find_element("css selector", "#other-list input").is_selected()
    browser.get("about:blank")
    browser.get(explorer.url + "#frequency=90&drive=0.5")
    when(browser, WHOLE)
    when(browser, 'return document.getElementById("why-1").textContent.includes("outside of its box")')

    # The first model within a tolerance: which one answered stands in the table.
    browser.get("about:blank")
    browser.get(explorer.url + "#model=1&frequency=115&drive=0.53&low=30&high=60&tolerance=0.01")
    when(browser, WHOLE)
    titles = [cell.text for cell in browser.find_elements("css selector", "#numbers th")]
    assert titles[-2:] == ["answered by", "because"]
    tiers = {row.split("\t")[0] for row in browser.execute_script('return [...document.querySelectorAll("#numbers tbody tr")].map((r) => r.cells[r.cells.length - 2].textContent)')}
    assert tiers <= {"model.h5", "wave_pump_fixed.h5"} and "wave_pump_fixed.h5" in tiers


def test_numbers_picture_and_scene_are_saved(browser, explorer_by_voltage, emulator_by_voltage, tmp_path):
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)})
    browser.get("about:blank")
    browser.get(explorer_by_voltage.url + "#frequency=120&drive=40&low=20&high=68&head=44")
    when(browser, WHOLE)

    def saved(button, ending):
        browser.find_element("id", button).click()
        until = time.monotonic() + 20
        while time.monotonic() < until:
            if found := [file for file in tmp_path.glob(f"*{ending}") if file.stat().st_size > 0]:
                return found[0]
            time.sleep(0.05)
        raise AssertionError(browser.find_element("id", "saved").text)

    table = undula.read_table(saved("save-csv", ".csv"))
    points = curve_json(emulator_by_voltage, "--frequency", 120, "--voltage", 40, "--head", "20:68:2")["points"]
    assert list(table["flow_l_per_min"]) == [p["flow_l_per_min"] for p in points]
    assert list(table["holder.stroke_mm"]) == [p["holder"]["stroke_mm"] for p in points]
    from matplotlib import image

    picture = image.imread(saved("save-png", ".png"))
    assert picture.shape[:2] == (940, 1280)
    colours = {tuple(pixel) for pixel in (picture[::2, ::2, :3] * 255).astype(int).reshape(-1, 3).tolist()}
    assert (31, 95, 168) in colours and (179, 64, 30) in colours  # the line of the curve and the samples of the style sheet
    scene = saved("save-scene", ".toml")
    assert scene.name == "model_120Hz_40V_44mmHg.toml"
    assert "voltage_V = 40.0" in scene.read_text() and "head_mmHg = 44.0" in scene.read_text()
    (tmp_path / "wave_pump_profile.toml").write_bytes((SOURCE / "data/profiles/wave_pump_profile.toml").read_bytes())
    with pytest.warns(undula.RunWarning):  # the profile states another modulus than the calibrated scene
        (curve,) = undula.hq(scene)
    assert curve.voltage_V == 40
