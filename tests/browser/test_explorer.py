"""The explorer in a browser: its numbers are `flapenv.evaluate`'s within a tenth of a second, and the wing beats."""

import contextlib
import dataclasses
import json
import logging
import math
import threading
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

import flapenv
from agents.commands.explore import answering, listen
from agents.explorer.app import make_app
from flapenv.files import read_strokes

pytestmark = pytest.mark.browser

AT_ONCE = 0.1
"""How soon a moved slider must change the numbers [s]."""
WATCH = """() => {
    window.waits = [];
    let since = null;
    for (const kind of ["keydown", "pointermove"])
        document.getElementById("controls").addEventListener(kind, (event) => {
            if (kind === "keydown" || event.buttons) since ??= performance.now();
        }, true);
    new MutationObserver(() => {
        if (since !== null) window.waits.push((performance.now() - since) / 1000);
        since = null;
    }).observe(document.getElementById("numbers"),
               { subtree: true, childList: true, characterData: true, attributes: true });
}"""
"""Measures from a key or a move of the pointer to the change of the numbers, in the page itself."""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """A running explorer."""
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    with contextlib.closing(listen(0)) as listening:
        server = answering(make_app().server, listening)
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{listening.getsockname()[1]}/"
        server.shutdown()
        thread.join()
        server.server_close()


@pytest.fixture
def opened(watched: Any, address: str) -> Iterator[Page]:
    """The page at both widths; it must not complain nor ask any other server for anything, whatever a test does."""
    page: Page = watched.page
    page.goto(address)
    page.wait_for_selector("#number-gap")
    page.wait_for_selector("#figure-terms .main-svg")
    yield page
    assert watched.complaints == []
    foreign = [one.url for one in watched.requests if not one.url.startswith((address, "data:", "blob:"))]
    assert foreign == []


def exact(page: Page) -> dict[str, Any]:
    return json.loads(page.locator("#exact").text_content() or "")


def changes(page: Page, act: Any) -> dict[str, Any]:
    """The numbers after an act that changes them."""
    before = page.locator("#exact").text_content()
    act()
    expect(page.locator("#exact")).not_to_have_text(str(before))
    page.wait_for_timeout(300)  # the last of several answers
    return exact(page)


def agrees_with_evaluate(shown: dict[str, Any]) -> None:
    found = flapenv.evaluate(shown["insect"], flapenv.Stroke(**shown["stroke"]))
    assert shown["weight_support"] == found.weight_support
    assert shown["specific_power"] == found.specific_power


def shown_number(page: Page, name: str) -> str:
    return page.locator(f"#number-{name}").inner_text()


def test_the_page_shows_the_first_insect_and_fits(opened: Page) -> None:
    shown = exact(opened)
    agrees_with_evaluate(shown)
    own = flapenv.evaluate("fruitfly")
    assert shown["specific_power"] == pytest.approx(own.specific_power, rel=1e-9)
    assert shown_number(opened, "specific_power") == f"{own.specific_power:#.5g}"
    assert opened.locator(".figure .main-svg").first.is_visible()
    width = opened.viewport_size["width"] if opened.viewport_size else 0
    assert opened.evaluate("document.documentElement.scrollWidth") <= width
    heights = opened.evaluate("[...document.querySelectorAll('.js-plotly-plot')].map(one => one.clientHeight)")
    assert len(heights) == 4
    assert min(heights) > 300


def test_every_control_has_a_name_that_can_be_read_aloud(opened: Page) -> None:
    for name in ("frequency f [Hz]", "amplitude φmax [°]", "angle of attack α_mid [°]", "phase δ, 90° symmetric [°]"):
        expect(opened.get_by_role("slider", name=name)).to_have_count(1)
        expect(opened.get_by_role("spinbutton", name=name)).to_have_count(1)
    unnamed = opened.evaluate("[...document.querySelectorAll('button')].filter(b => !b.textContent && !b.ariaLabel)")
    assert unnamed == []


def test_a_key_on_a_slider_changes_the_numbers_at_once(opened: Page) -> None:
    opened.evaluate(WATCH)
    for name in ("frequency", "flap_amplitude", "alpha_mid"):
        thumb = opened.locator(f"#{name} [role=slider]")
        thumb.focus()
        for _ in range(5):
            count = opened.evaluate("window.waits.length")
            thumb.press("ArrowLeft")
            for _ in range(20):  # until its answer is there, so that it is not taken for that of the next key
                opened.wait_for_timeout(100)
                if opened.evaluate("window.waits.length") > count:
                    break
    waits = opened.evaluate("window.waits")
    assert len(waits) == 15
    print(f"numbers follow a key after {1000 * median(waits):.0f} ms (median), {1000 * max(waits):.0f} ms (worst)")
    assert median(waits) < AT_ONCE
    shown = exact(opened)
    agrees_with_evaluate(shown)
    own = flapenv.load_insect("fruitfly").stroke
    assert shown["stroke"]["frequency"] == pytest.approx(own.frequency - 5)


def test_a_dragged_slider_takes_the_numbers_along(opened: Page) -> None:
    opened.evaluate(WATCH)
    thumb = opened.locator("#frequency [role=slider]")
    thumb.scroll_into_view_if_needed()
    box = thumb.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    opened.mouse.move(x, y)
    opened.mouse.down()
    seen = set()
    for step in range(1, 21):
        opened.mouse.move(x + 3 * step, y)
        opened.wait_for_timeout(50)
        seen.add(shown_number(opened, "specific_power"))
    opened.mouse.up()
    opened.wait_for_timeout(500)
    assert len(seen) > 5
    waits = opened.evaluate("window.waits")
    print(f"numbers follow a drag after {1000 * median(waits):.0f} ms (median), {1000 * max(waits):.0f} ms (worst)")
    assert median(waits) < AT_ONCE
    shown = exact(opened)
    agrees_with_evaluate(shown)
    field = opened.locator("#frequency-field").input_value()
    assert shown["stroke"]["frequency"] == pytest.approx(float(field))
    assert shown["stroke"]["frequency"] > flapenv.load_insect("fruitfly").stroke.frequency


def test_field_thumb_and_numbers_agree_whatever_is_typed(opened: Page) -> None:
    field, thumb = opened.locator("#alpha_mid-field"), opened.locator("#alpha_mid [role=slider]")
    for typed, key, wanted in (
        ("33.3", "Enter", "33.3"),
        ("900", "Tab", "89"),
        ("900", "Enter", "89"),  # once more, when the slider stands there already
        ("", "Enter", "89"),
        ("-5", "Tab", "1"),
        ("40.123456", "Enter", "40.123456"),
    ):
        field.fill(typed)
        field.press(key)
        expect(thumb).to_have_attribute("aria-valuenow", wanted)
        expect(field).to_have_value(wanted)
        opened.wait_for_timeout(300)
        shown = exact(opened)
        assert 90 - math.degrees(shown["stroke"]["pitch_amplitude"]) == pytest.approx(float(wanted))
        agrees_with_evaluate(shown)


def test_a_field_shows_all_digits_of_what_is_used(opened: Page) -> None:
    stroke = changes(opened, lambda: opened.click("#load-learned"))["stroke"]
    fields = opened.locator(".slider input")
    assert fields.count() == 6
    assert float(opened.locator("#frequency-field").input_value()) == stroke["frequency"]
    angle = math.radians(float(opened.locator("#flap_amplitude-field").input_value()))
    assert angle == stroke["flap_amplitude"]
    assert fields.evaluate_all("all => all.every(one => one.scrollWidth <= one.clientWidth)")


def test_the_figures_follow_more_than_the_first_move(opened: Page) -> None:
    drawn = opened.locator("#figure-forces .legendtext").first
    for frequency in (200, 220, 300):
        field = opened.locator("#frequency-field")
        field.fill(str(frequency))
        field.press("Enter")
        stroke = dataclasses.replace(flapenv.load_insect("fruitfly").stroke, frequency=float(frequency))
        lift = flapenv.evaluate("fruitfly", stroke).weight_support
        expect(drawn).to_contain_text(f"yours: mean lift {lift:.3f} weights")


def test_what_is_left_over_is_dimmed_while_a_wing_is_not_allowed(opened: Page) -> None:
    left = opened.get_by_text("what follows is of the last stroke that was allowed")
    none = opened.get_by_text("there is nothing to download")
    opened.click("#insect")
    opened.get_by_text("your own wing").last.click()
    expect(opened.locator("#note")).to_contain_text("its own stroke is made up")
    opened.wait_for_selector("#number-gap")
    for one in (left, none):
        expect(one).not_to_be_visible()
    opened.fill("#mean_chord", "0.02")
    expect(opened.locator("#note [role=alert]")).to_contain_text("mean chord c̄")
    for one in (left, none):
        expect(one).to_be_visible()
    expect(opened.locator("#numbers")).to_contain_text("no numbers")
    for faint in ("#remarks", "#figures .figure >> nth=0"):
        expect(opened.locator(faint)).to_have_css("opacity", "0.25")
    opened.fill("#mean_chord", "4")
    opened.wait_for_selector("#number-gap")
    expect(left).not_to_be_visible()
    expect(opened.locator("#remarks")).to_have_css("opacity", "1")


def test_paper_tells_insect_problem_and_stroke_with_figures_of_its_width(opened: Page) -> None:
    printed = opened.locator(".printed")
    expect(printed).not_to_be_visible()
    before = opened.evaluate("document.querySelector('.main-svg').clientWidth")
    opened.emulate_media(media="print")
    opened.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    expect(printed).to_be_visible()
    for told in ("fruitfly: 0.72 mg", "problem A", "frequency f = 254 Hz", "α_mid = 46°", "phase δ = 90°"):
        expect(printed).to_contain_text(told)
    drawn = opened.locator(".figure .js-plotly-plot > .plot-container .main-svg")
    expect(drawn.first).to_have_css("width", "680px")
    opened.evaluate("window.dispatchEvent(new Event('resize'))")  # as a browser may tell of the paper's width later
    opened.wait_for_timeout(1000)
    assert set(drawn.evaluate_all("all => all.map(one => one.clientWidth)")) == {680}
    opened.emulate_media(media="screen")
    opened.evaluate("window.dispatchEvent(new Event('afterprint'))")
    expect(drawn.first).to_have_css("width", f"{before}px")


def test_buttons_load_the_optimal_the_learned_and_the_own_stroke(opened: Page) -> None:
    best = flapenv.optimum("fruitfly")
    shown = changes(opened, lambda: opened.click("#load-optimal"))
    assert shown["specific_power"] == pytest.approx(best.specific_power, rel=1e-6)
    assert shown_number(opened, "gap") == "0.0000"
    learned = changes(opened, lambda: opened.click("#load-learned"))
    assert 0 < learned["gap"] < 0.01
    own = changes(opened, lambda: opened.click("#load-own"))
    assert own["specific_power"] == pytest.approx(flapenv.evaluate("fruitfly").specific_power, rel=1e-6)


def test_the_wing_beats_until_it_is_paused(opened: Page) -> None:
    figure = opened.locator("#figure-beat .js-plotly-plot")
    figure.scroll_into_view_if_needed()
    button = opened.get_by_label("pause the wingbeat")
    expect(button).to_be_visible()
    frames = set()
    for _ in range(10):
        frames.add(figure.get_attribute("data-frame"))
        opened.wait_for_timeout(120)
    assert len(frames) > 4
    button.click()
    expect(opened.get_by_label("play the wingbeat")).to_be_visible()
    still = figure.get_attribute("data-frame")
    opened.wait_for_timeout(400)
    assert figure.get_attribute("data-frame") == still


def test_the_wing_stands_still_for_who_asks_for_less_motion(browser: Browser, address: str) -> None:
    page = browser.new_page(reduced_motion="reduce")
    page.goto(address)
    figure = page.locator("#figure-beat .js-plotly-plot")
    expect(page.get_by_label("play the wingbeat")).to_be_visible()
    page.wait_for_timeout(400)
    assert figure.get_attribute("data-frame") == "0"
    page.get_by_label("play the wingbeat").click()
    expect(figure).not_to_have_attribute("data-frame", "0")
    page.close()


def test_the_downloaded_file_gives_the_same_stroke(opened: Page, tmp_path: Path) -> None:
    shown = changes(opened, lambda: opened.click("#load-learned"))
    with opened.expect_download() as download:
        opened.click("#export")
    assert download.value.suggested_filename == "fruitfly-stroke.json"
    download.value.save_as(tmp_path / "stroke.json")
    (read,) = read_strokes(tmp_path / "stroke.json")
    assert read.insect.name == "fruitfly"
    assert {name: getattr(read.stroke, name) for name in shown["stroke"]} == shown["stroke"]


def test_a_wing_of_ones_own_is_typed_and_its_name_is_text(opened: Page) -> None:
    opened.click("#insect")
    opened.get_by_text("your own wing").last.click()
    opened.wait_for_selector("#wing-name", state="visible")
    opened.fill("#wing-name", "<img src=x onerror=alert(1)>")
    opened.locator("#wing-name").press("Enter")
    expect(opened.locator("#note")).to_contain_text("<img src=x onerror=alert(1)>: 100 mg")
    shown = changes(opened, lambda: opened.fill("#mass", "80"))
    assert shown["insect"] == "<img src=x onerror=alert(1)>"
    assert shown["weight_support"] > 0
    assert opened.locator("img[src=x]").count() == 0
