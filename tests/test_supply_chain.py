"""Every package that gets installed has one exact version in a file of the repository, and that one is installed."""

import itertools
import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).parents[1]
LISTS = sorted(
    [
        *ROOT.glob("constraints*.txt"),
        *(ROOT / "clients").glob("requirements-*.txt"),
        *(ROOT / ".ci").glob("requirements-*.txt"),
    ]
)
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
EXTRAS: dict[str, list[str]] = PROJECT["project"]["optional-dependencies"]
IN_DEV = "dev"
"""What `make train` and `make test` install; an extra of its own is for what has no wheels everywhere."""


def pins(path: Path) -> list[tuple[str, str]]:
    """Names, as indices write them, and versions of a list, every line of which is one."""
    lines = [line.partition("#")[0].strip() for line in path.read_text(encoding="utf-8").splitlines()]
    found = []
    for line in filter(None, lines):
        match = re.fullmatch(r"([A-Za-z0-9][A-Za-z0-9._-]*)(?:\[[a-z,]+\])?==([0-9][0-9A-Za-z.+!]*)", line)
        assert match, f"{path.name}: {line!r} is no exact version; allowed: NAME==VERSION"
        found.append((canonicalize_name(match[1]), match[2]))
    return found


def asked_for(extra: str) -> set[str]:
    """Names of all that an extra of flapenv asks for here, directly or not.

    What else lies in this environment does not count.
    """
    found: set[str] = set()
    left = [Requirement(f"flapenv[{extra}]")]
    seen: set[tuple[str, str]] = set()
    while left:
        asked = left.pop()
        name = canonicalize_name(asked.name)
        for one in ("", *asked.extras):
            if (name, one) in seen:
                continue
            seen.add((name, one))
            try:
                needs = [Requirement(text) for text in metadata.requires(name) or ()]
            except metadata.PackageNotFoundError:
                raise AssertionError(
                    f"{name} is asked for but not installed; mend: remove .venv and make it anew"
                ) from None
            left += [need for need in needs if need.marker is None or need.marker.evaluate({"extra": one})]
        found.add(name)
    return found - {"flapenv"}


@pytest.mark.parametrize("path", LISTS, ids=lambda path: path.name)
def test_every_line_is_an_exact_version_and_every_name_stands_once(path: Path) -> None:
    names = [name for name, _ in pins(path)]
    assert names
    assert len(set(names)) == len(names), [name for name in names if names.count(name) > 1]


def test_all_lists_are_there() -> None:
    names = {path.name for path in LISTS}
    assert {"constraints.txt", "constraints-floor.txt", "requirements-audit.txt", "requirements-zoo.txt"} <= names


def test_what_is_installed_is_what_the_constraints_name() -> None:
    wanted = dict(pins(ROOT / "constraints.txt"))
    names = asked_for(IN_DEV)
    assert len(names) > 90
    assert not (missing := names - set(wanted)), f"constraints.txt does not name {', '.join(sorted(missing))}"
    other = {
        name: (found, wanted[name])
        for name in names
        if (found := Version(metadata.version(name)).public) != wanted[name]
    }
    assert not other, f"installed, named in constraints.txt: {other}; mend: remove .venv and make it anew"


def test_the_constraints_name_nothing_that_nobody_asks_for() -> None:
    direct = {canonicalize_name(Requirement(text).name) for texts in EXTRAS.values() for text in texts}
    builders = {canonicalize_name(Requirement(text).name) for text in PROJECT["build-system"]["requires"]}
    named = {name for name, _ in pins(ROOT / "constraints.txt")}
    assert named <= asked_for(IN_DEV) | direct | builders


def test_the_constraints_name_every_direct_dependency_and_what_builds_the_package() -> None:
    named = dict(pins(ROOT / "constraints.txt"))
    texts = [
        *PROJECT["project"]["dependencies"],
        *PROJECT["build-system"]["requires"],
        *itertools.chain(*EXTRAS.values()),
    ]
    for asked in map(Requirement, texts):
        name = canonicalize_name(asked.name)
        if name != "flapenv":
            assert name in named, f"constraints.txt does not name {name}"
            assert asked.specifier.contains(named[name]), f"{asked} does not allow {named[name]}"


@pytest.mark.parametrize(
    ("line", "is_exact"),
    [("a==1.0", True), ("a-b[c]==1.0.post1", True), ("a>=1", False), ("a==1.*", False), ("a", False), ("-r b", False)],
)
def test_a_line_that_is_no_exact_version_is_found(line: str, is_exact: bool, tmp_path: Path) -> None:
    path = tmp_path / "some.txt"
    path.write_text(f"# versions\n{line}  # why\n\n", encoding="utf-8")
    if is_exact:
        assert len(pins(path)) == 1
    else:
        with pytest.raises(AssertionError, match="is no exact version"):
            pins(path)


def test_pip_is_held_to_the_constraints_where_it_installs_and_where_it_builds() -> None:
    rules = (ROOT / "Makefile").read_text(encoding="utf-8")
    for line in re.findall(r"-m pip install .*", rules):
        assert "--constraint constraints" in line or "--requirement" in line, line
    assert re.search(r"^export PIP_CONSTRAINT := \$\(CURDIR\)/\.ci/requirements-build\.txt$", rules, flags=re.MULTILINE)
    builders = pins(ROOT / ".ci" / "requirements-build.txt")
    assert {name for name, _ in builders} == {Requirement(text).name for text in PROJECT["build-system"]["requires"]}
    assert set(builders) <= set(pins(ROOT / "constraints.txt"))
