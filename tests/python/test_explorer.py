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


@pytest.fixture(scope="module")
def explorer():
    running = Explorer(PROJECTED, "--data", MEASURED)
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="module")
def explorer_by_voltage(emulator_by_voltage):
    running = Explorer(emulator_by_voltage, "--data", MEASURED)
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


def test_the_model_is_described(explorer, explorer_by_voltage):
    model = json.loads(explorer.ask("/model")[1])
    assert model["model"] == "wave_pump_fixed.h5" and str(SOURCE) not in json.dumps(model)
    drive = model["ranges"]["drive"]
    assert (drive["name"], drive["unit"]) == ("stroke", "mm")
    assert (drive["low"], drive["high"]) == pytest.approx((0.1, 0.8), rel=1e-12)
    assert model["measured"][0]["drive"] == 0.53 and len(model["measured"][0]["head_mmHg"]) > 50
    model = json.loads(explorer_by_voltage.ask("/model")[1])
    assert model["ranges"]["drive"]["unit"] == "V" and model["measured"][0]["drive"] == 40


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
    ],
)
def test_what_is_no_question_is_refused(explorer, path, text):
    response, body = explorer.ask(path)
    assert response.status == 400
    assert text in json.loads(body)["error"] and "allowed:" in json.loads(body)["error"]


def test_other_hosts_methods_and_paths_are_refused(explorer):
    port = explorer.port
    for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", f"127.0.0.1:{port}.evil.example", ""):
        response, text = explorer.ask("/model", headers={"Host": host})
        assert response.status == 403 and b"ranges" not in text, host
    two = f"GET /model HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nHost: evil.example\r\n\r\n".encode()
    assert b" 403 " in explorer.send(two, more=True).split(b"\r\n")[0]
    assert b" 403 " in explorer.send(b"GET /model HTTP/1.0\r\n\r\n", more=True).split(b"\r\n")[0]
    assert explorer.ask("/model", headers={"Host": f"localhost:{port}"})[0].status == 200

    for method in ("POST", "PUT", "DELETE", "PATCH", "OPTIONS"):
        response, text = explorer.ask("/model", method)
        assert response.status == 405 and b"ranges" not in text, method
        # A body is never read: the connection may be cut before the answer is.
        request = f"{method} /model HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 100\r\n\r\n" + "x" * 100
        answer = explorer.send(request.encode())
        assert answer == b"" or b" 405 " in answer.split(b"\r\n")[0], method
    assert explorer.ask("/model", "HEAD")[0].status == 200

    for path in ("/etc/passwd", "/../etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd", "/data/models/wave_pump_fixed.h5",
                 "/explore.js/../../x", "/%2e%2e/%2e%2e/etc/passwd", "/curve/", "/model.json", "/." , "/index.html"):  # fmt: skip
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
            inner = f"GET /model HTTP/1.1\r\n{host}\r\n"
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
    for path in ("/", "/explore.js", "/explore.css", "/model"):
        response, text = explorer.ask(path)
        assert response.status == 200 and text
        assert "default-src 'self'" in response.getheader("Content-Security-Policy")
        assert response.getheader("X-Content-Type-Options") == "nosniff"
        assert response.getheader("Access-Control-Allow-Origin") is None
    page = explorer.ask("/")[1].decode()
    assert not re.search(r"https?://", page), "works without network"
    for file, path in (("index.html", "/"), ("explore.js", "/explore.js"), ("explore.css", "/explore.css")):
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
        (row) => [...row.cells].map((cell) => Number(cell.dataset.value)))"""
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

    # 4. What is drawn, and for whom does not see it.
    assert len(browser.find_elements(By.CSS_SELECTOR, "#chart polygon.band")) == 1
    line = browser.find_element(By.CSS_SELECTOR, "#chart polyline.curve").get_attribute("points")
    assert len(line.split()) == 25
    samples = len(undula.read_measured(MEASURED))
    assert len(browser.find_elements(By.CSS_SELECTOR, "#chart circle.sample.other")) == samples
    for control in browser.find_elements(By.CSS_SELECTOR, "input"):
        name = control.get_attribute("id")
        assert browser.find_element(By.CSS_SELECTOR, f"label[for={name}]").text
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
