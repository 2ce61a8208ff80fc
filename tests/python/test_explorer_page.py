"""The explorer's page in Chromium: sliders, numbers, pictures and what is saved; keys, names and contrast for who needs them."""

import re
import time

import pytest
import undula
from conftest import MEASURED, PROJECTED, SOURCE, curve_json


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


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_from_the_paper(browser, explorer, scheme):
    """Contrast by WCAG 2.1, level AA: 4.5 for text, 3 for lines that carry meaning."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    browser.get("about:blank")
    browser.get(explorer.url + "#frequency=120&drive=0.53")
    when(browser, WHOLE)

    def luminance(colour):
        channels = [int(c) / 255 for c in re.findall(r"\d+", colour)[:3]]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    def colour(selector, name):
        return browser.execute_script("return getComputedStyle(document.querySelector(arguments[0]))[arguments[1]]", selector, name)

    paper = luminance(colour("body", "backgroundColor"))
    assert (paper > 0.5) == (scheme == "light")
    wanted = [("body", "color", 4.5), ("#fluid", "color", 4.5), ("#summary", "color", 4.5), ("#point dt", "color", 4.5), ("button", "color", 4.5),
              ("#error", "color", 4.5), ("#chart text", "fill", 4.5), ("#chart polyline.curve", "stroke", 3), ("#chart circle.sample", "stroke", 3)]  # fmt: skip
    for selector, name, least in wanted:
        ink = luminance(colour(selector, name))
        contrast = (max(ink, paper) + 0.05) / (min(ink, paper) + 0.05)
        assert contrast >= least, (selector, contrast)
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def test_every_control_is_reached_by_keys(browser, explorer):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys

    browser.get("about:blank")
    browser.get(explorer.url + "#frequency=120&drive=0.53")
    when(browser, WHOLE)
    when(browser, 'return !document.getElementById("period").hidden')
    reached = []
    for _ in range(30):
        ActionChains(browser).send_keys(Keys.TAB).perform()
        reached.append(browser.execute_script("return document.activeElement.id"))
    for name in ("model-number", "frequency", "drive", "head", "head-low", "head-high", "tolerance", "save-csv", "save-png", "save-scene",
                 "copy-link", "quantity", "play", "instant"):  # fmt: skip
        assert name in reached, name
    # The space bar presses the button that plays.
    browser.find_element("id", "play").send_keys(Keys.SPACE)
    assert browser.find_element("id", "play").text == "Play"
