"""The documentation site holds every page and every public name; that it builds without a warning is `make docs`."""

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest
from running_pages import DOCS
from sphinx.cmd.build import main as sphinx_build

import flapenv
import flapenv.aero
import flapenv.envs

ROOT = DOCS.parent
PAGES = sorted(path for path in DOCS.rglob("*.md") if "_build" not in path.parts)
TREE = re.compile(r"^```\{toctree\}\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)


def entries(page: Path) -> list[Path]:
    """The pages that a page's tables of contents hold."""
    lines = [line for tree in TREE.findall(page.read_text(encoding="utf-8")) for line in tree.splitlines()]
    names = [re.sub(r".*<(.*)>", r"\1", line) for line in lines if line and not line.startswith(":")]
    return [(page.parent / f"{name}.md").resolve() for name in names]


@pytest.fixture(scope="module")
def conf() -> ModuleType:
    spec = importlib.util.spec_from_file_location("conf", DOCS / "conf.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_page_is_in_the_contents_once() -> None:
    held = [entry for page in PAGES for entry in entries(page)]
    assert sorted(held) == [page for page in PAGES if page != DOCS / "index.md"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(DOCS)))
def test_every_link_of_a_page_leads_somewhere_in_the_plain_repository_too(page: Path) -> None:
    for target in re.findall(r"\]\((?!http)([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target


def test_every_public_name_is_on_a_page_of_the_interface() -> None:
    text = "\n".join(page.read_text(encoding="utf-8") for page in (DOCS / "api").glob("*.md"))
    documented = {name.rsplit(".", 1)[-1] for name in re.findall(r"^\.\. auto\w+:: (\S+)", text, flags=re.MULTILINE)}
    for module in (flapenv, flapenv.aero, flapenv.envs):
        assert {name for name in module.__all__ if not name.startswith("__")} <= documented, module.__name__


def test_the_first_page_takes_its_table_from_the_readme() -> None:
    readme, index = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "docs/index.md"))
    after, before = (re.findall(rf':{mark}: "(.*)"', index)[0] for mark in ("start-after", "end-before"))
    assert readme.count(after) == 1
    table = readme.split(after)[1].split(before)[0]
    assert "gap to the optimum: mean" in table
    assert len(table.splitlines()) < 30


def test_the_reliability_page_names_tests_that_are_there() -> None:
    named = set(re.findall(r"`(test_\w+)`", (DOCS / "reliability.md").read_text(encoding="utf-8")))
    tests = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    assert len(named) > 10
    assert named <= set(re.findall(r"^def (test_\w+)", tests, flags=re.MULTILINE))


@pytest.mark.parametrize(
    ("text", "loads"),
    [
        ('<script src="https://cdn.example/plotly.js"></script>', True),
        ('<script defer="defer" src="_static/furo.js?v=1"></script>', False),
        ('<img alt="a badge" src="//example.org/badge.svg">', True),
        ('<link rel="stylesheet" href="https://fonts.example/css">', True),
        ('<link rel="canonical" href="https://example.org/page">', False),
        ('<a href="https://gymnasium.farama.org">a link is followed by hand</a>', False),
        ("@import 'https://fonts.example/css';", True),
        ("src: url(data:font/woff2;base64,AAAA)", False),
        ("src: url('http://fonts.example/a.woff2')", True),
    ],
)
def test_what_a_page_would_load_from_the_network_is_found(conf: ModuleType, text: str, loads: bool) -> None:
    assert bool(conf.LOADS.search(text)) == loads


def test_a_site_that_would_load_from_the_network_is_not_built(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / "docs"
    source.mkdir()
    (source / "conf.py").write_text((DOCS / "conf.py").read_text(encoding="utf-8").replace("html_static_path", "#"))
    (source / "index.md").write_text("# A page\n\n![a badge](https://example.org/badge.svg)\n", encoding="utf-8")
    assert sphinx_build(["-q", str(source), str(tmp_path / "html")]) != 0
    assert "index.html loads from the network" in capsys.readouterr().err
