"""Reports of a few strokes, and what a browser would read of them."""

import dataclasses
import io
import json
from collections.abc import Callable
from html.parser import HTMLParser
from typing import Any

import pytest

from agents.report import ReportContent
from agents.tasks.stroke_verdict import verdict_of
from flapenv import Stroke, load_insect, optimum
from flapenv.assessment import assess
from flapenv.problem import as_problem

EVIL = "</script><script>alert(1)</script>"
"""A name that would break out of a script element and of any tag."""


class Page(HTMLParser):
    """A page taken apart: tags with their attributes, tables as texts, scripts, what can be unfolded."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.tables: dict[str, list[list[str]]] = {}
        self.scripts: list[tuple[dict[str, str | None], str]] = []
        self.text = ""
        self.summaries: list[str] = []
        self.blocks: list[str] = []
        self._open = ""
        self._table: list[list[str]] | None = None
        self._cell: io.StringIO | None = None
        self._script: tuple[dict[str, str | None], list[str]] | None = None
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        attributes = dict(attrs)
        self.tags.append((tag, attributes))
        if tag in ("summary", "pre"):
            (self.summaries if tag == "summary" else self.blocks).append("")
            self._open = tag
        if tag == "table":
            self._table = self.tables.setdefault(str(attributes.get("id")), [])
        elif tag == "tr" and self._table is not None:
            self._table.append([])
        elif tag in ("td", "th"):
            self._cell = io.StringIO()
        elif tag == "script":
            self._script = (attributes, [])

    def handle_endtag(self, tag: str) -> None:
        if tag == self._open:
            self._open = ""
        if tag in ("td", "th") and self._cell is not None and self._table is not None:
            self._table[-1].append(self._cell.getvalue().strip())
            self._cell = None
        elif tag == "table":
            self._table = None
        elif tag == "script" and self._script is not None:
            self.scripts.append((self._script[0], "".join(self._script[1])))
            self._script = None

    def handle_data(self, data: str) -> None:
        if self._script is not None:
            self._script[1].append(data)
            return
        self.text += data
        if self._open:
            (self.summaries if self._open == "summary" else self.blocks)[-1] += data
        if self._cell is not None:
            self._cell.write(data)

    def data(self, key: str) -> Any:
        """The JSON of a script element by its id."""
        return next(json.loads(text) for attributes, text in self.scripts if attributes.get("id") == key)


@pytest.fixture(scope="session")
def content_of() -> Callable[..., ReportContent]:
    """Makes the content of a report on the optimal strokes of some insects, the first renamed where a name is given."""

    def make(*names: str, renamed: str = "", strokes: dict[str, Stroke] | None = None, **fields: Any) -> ReportContent:
        results = []
        for number, name in enumerate(names):
            insect = load_insect(name)
            if renamed and number == 0:
                insect = dataclasses.replace(insect, name=renamed)
            results.append(assess(insect, (strokes or {}).get(name, optimum(name).stroke)))
        given: dict[str, Any] = {
            "title": "a test",
            "about": "flapenv/Hover-v0",
            "verdict": verdict_of(results, as_problem("free-frequency")),
            "distance": "gap to the optimum",
            "facts": {"seed": "3"},
            "config": {"rows": 512},
        }
        return ReportContent(**{**given, **fields})

    return make


@pytest.fixture(scope="session")
def page_of() -> Callable[[str], Page]:
    """Takes a page apart."""
    return Page


@pytest.fixture(scope="session")
def evil() -> str:
    """See `EVIL`."""
    return EVIL
