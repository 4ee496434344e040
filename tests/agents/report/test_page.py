"""The report's HTML: what it holds, what it must not let out, and who can read it."""

import base64
import hashlib
import itertools
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from agents.report import ReportContent, write_report
from agents.report.page import report_page, script_data
from agents.tasks.stroke_verdict import verdict_of
from agents.tasks.task import Verdict
from flapenv import load_insect, optimum
from flapenv.assessment import assess
from flapenv.problem import as_problem

Make = Callable[..., ReportContent]


@pytest.fixture(scope="module")
def html(content_of: Make) -> str:
    curve = [{"wingbeats": 1e6, "mean_gap": 0.1, "worst_gap": 0.2}, {"wingbeats": 2e6, "mean_gap": 0, "worst_gap": 0.1}]
    return report_page(content_of("bumblebee", "cranefly", curve=curve, picture=b"\x89PNG", told=["told"]))


@pytest.fixture(scope="module")
def page(html: str, page_of: Callable[[str], Any]) -> Any:
    return page_of(html)


def test_it_has_every_figure_with_a_place_a_title_and_words(page: Any) -> None:
    places = {a["id"]: a for tag, a in page.tags if tag == "div" and a.get("class") == "plot"}
    per_insect = {f"{kind}-{number}" for kind in ("beat", "waveforms", "forces", "terms") for number in (0, 1)}
    assert set(places) == per_insect | {"savings", "front", "sensitivities", "learning-curve"}
    ids = [a["id"] for _, a in page.tags if a.get("id")]
    assert len(ids) == len(set(ids))
    for key, attributes in places.items():
        assert attributes["role"] == ("group" if key.startswith("beat-") else "img")  # which may hold a button
        for field in ("aria-labelledby", "aria-describedby"):
            assert attributes[field] in ids
        figure = page.data(f"{key}-data")
        assert figure["data"]
        assert figure["layout"]["height"] > 100


def test_nothing_in_it_reaches_out(html: str, page: Any) -> None:
    outside = [a for _, a in page.tags for key in ("src", "href", "action") if (a.get(key) or "data:")[:5] != "data:"]
    assert outside == []
    assert "@import" not in html
    (policy,) = [a["content"] for tag, a in page.tags if a.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none'; ")
    assert "connect-src" not in policy


def test_only_scripts_whose_hash_the_policy_names_are_there(page: Any) -> None:
    (policy,) = [a["content"] for tag, a in page.tags if a.get("http-equiv") == "Content-Security-Policy"]
    run = [text for attributes, text in page.scripts if attributes.get("type") != "application/json"]
    digests = {base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in run}
    assert digests == set(re.findall(r"'sha256-([^']+)'", policy))
    assert len(run) == 3
    assert "'unsafe-inline'" not in policy.split("style-src")[0]
    assert not [key for _, a in page.tags for key in a if key.startswith("on")]


def test_names_that_somebody_chose_stay_text(content_of: Make, page_of: Callable[[str], Any], evil: str) -> None:
    content = content_of(
        "hawkmoth",
        renamed=evil,
        title=evil,
        about=evil,
        told=[evil],
        facts={evil: evil},
        config={evil: evil},
        called=evil,
    )
    page = page_of(report_page(content))
    tame = page_of(report_page(content_of("hawkmoth", renamed="robot", told=["x"])))
    assert [tag for tag, _ in page.tags] == [tag for tag, _ in tame.tags]
    assert len(page.scripts) == len(tame.scripts)
    assert page.tables["results"][1][0] == evil
    assert evil in page.text
    assert page.data("savings-data")["data"][0]["y"] == ["&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;"]


def test_a_name_that_is_written_from_right_to_left_turns_nothing_else_around(content_of: Make) -> None:
    html = report_page(content_of("hawkmoth", renamed="\u05e2\u05e9", title="\u05e2\u05e9"))
    for element in ("<h1><bdi>", '<th scope="row"><bdi>', '<bdi class="name">'):
        assert f"{element}\u05e2\u05e9</bdi>" in html


def test_json_within_a_script_element_cannot_close_it() -> None:
    assert script_data('"</script>&<!--"') == r'"\u003c/script\u003e\u0026\u003c!--"'


def test_it_can_be_read_aloud_and_found_by_its_headings(page: Any) -> None:
    tags = [tag for tag, _ in page.tags]
    assert dict(page.tags)["html"]["lang"] == "en"
    assert tags.count("h1") == 1
    levels = [int(tag[1]) for tag in tags if re.fullmatch(r"h[1-6]", tag)]
    assert all(after - before <= 1 for before, after in itertools.pairwise(levels))
    assert all(a.get("alt") for tag, a in page.tags if tag == "img")
    assert {a.get("scope") for tag, a in page.tags if tag == "th"} == {"col", "row"}
    assert ("meta", {"name": "viewport", "content": "width=device-width, initial-scale=1"}) in page.tags


def test_a_task_without_single_strokes_shows_its_table_curve_and_picture(page_of: Callable[[str], Any]) -> None:
    verdict = Verdict(mean=None, worst=None, text="return <1>", results={})
    content = ReportContent(
        title="heave", about="", verdict=verdict, distance="LQG's lead", picture=b"png", facts={}, config={}
    )
    page = page_of(report_page(content))
    assert "return <1>" in page.text
    assert not [a for tag, a in page.tags if a.get("class") == "plot"]
    assert [a["src"] for tag, a in page.tags if tag == "img"] == ["data:image/png;base64,cG5n"]
    assert "What the wings do" not in page.text


def test_strokes_that_are_the_insects_own_are_not_said_to_save_anything(
    content_of: Make, page_of: Callable[[str], Any]
) -> None:
    page = page_of(report_page(content_of("hawkmoth", strokes={"hawkmoth": load_insect("hawkmoth").stroke})))
    places = {a["id"] for tag, a in page.tags if a.get("class") == "plot"}
    assert "savings" not in places
    assert "models" not in page.tables
    assert "saves" not in page.text


def test_an_insect_that_cannot_hover_is_told_and_drawn(content_of: Make, page_of: Callable[[str], Any]) -> None:
    problem = as_problem("fixed-frequency")
    verdict = verdict_of([assess("ladybird", optimum("ladybird", problem).stroke, problem)], problem)
    page = page_of(report_page(content_of("ladybird", verdict=verdict)))
    assert "ladybird cannot hover here" in page.text
    names = [trace.get("name") for trace in page.data("waveforms-0-data")["data"]]
    assert "most lift" in names
    assert not [a for tag, a in page.tags if a.get("id") == "front"]


def test_the_file_is_whole_utf_8_and_small_enough(content_of: Make, tmp_path: Path) -> None:
    path = write_report(tmp_path / "report.html", content_of("bumblebee"))
    text = path.read_bytes().decode("utf-8")
    assert text.startswith("<!DOCTYPE html>")
    assert text.endswith("</html>\n")
    assert "\r" not in text
    assert path.stat().st_size < 6e6
    assert list(tmp_path.iterdir()) == [path]
