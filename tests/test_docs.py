"""The pages of docs/ say what the code says."""

import dataclasses
import importlib
import inspect
import re
from pathlib import Path

import pytest

import flapenv
from flapenv.aero.blade_element import TERMS
from flapenv.validation.report import page

DOCS = Path(flapenv.__file__).parents[1] / "docs"
EQUATIONS = [f"(2.{n})" for n in range(1, 17)] + ["(3.1)", "(3.2)"]
TEXT = (DOCS / "equations.md").read_text(encoding="utf-8")
NAMES = sorted(set(re.findall(r"`(flapenv\.[\w.]+)`", TEXT)))


def resolve(name: str) -> object:
    """The object that a dotted name stands for; for a field of a record, the record."""
    parts = name.split(".")
    for depth in range(len(parts), 0, -1):
        try:
            value: object = importlib.import_module(".".join(parts[:depth]))
        except ModuleNotFoundError:
            continue
        break
    for part in parts[depth:]:
        if dataclasses.is_dataclass(value) and part in {field.name for field in dataclasses.fields(value)}:
            return value
        value = getattr(value, part)
    return value


@pytest.mark.parametrize("name", NAMES)
def test_every_name_of_the_equations_page_exists_and_is_documented(name: str) -> None:
    value = resolve(name)
    assert inspect.getdoc(value)
    if dataclasses.is_dataclass(value):
        assert f"{name.rsplit('.', 1)[-1]}:" in inspect.getdoc(value) or value.__name__ == name.rsplit(".", 1)[-1]


@pytest.mark.parametrize("equation", EQUATIONS)
def test_every_equation_of_the_paper_has_its_function_which_names_it(equation: str) -> None:
    (row,) = [line for line in TEXT.splitlines() if line.startswith(f"| {equation} ")]
    names = re.findall(r"`(flapenv\.[\w.]+)`", row)
    assert names
    for name in names:
        value = resolve(name)
        module = value if inspect.ismodule(value) else inspect.getmodule(value)
        assert any(equation in inspect.getsource(where) for where in (value, module)), (
            f"{name} does not name {equation}"
        )


def test_the_validation_page_is_what_the_command_writes() -> None:
    assert (DOCS / "validation.md").read_text(encoding="utf-8") == page()


def test_every_force_term_is_on_the_page_of_axes() -> None:
    text = (DOCS / "axes.md").read_text(encoding="utf-8")
    for term in TERMS:
        assert f"| `{term}` |" in text


def test_every_picture_that_a_page_shows_is_there() -> None:
    for document in (*DOCS.glob("*.md"), DOCS.parent / "README.md"):
        for link in re.findall(r"!\[[^]]*\]\(([^)]+)\)", document.read_text(encoding="utf-8")):
            assert (document.parent / link).is_file(), f"{document.name}: {link}"
