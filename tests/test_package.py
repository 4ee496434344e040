"""The house: what importing loads, which way imports run, how long files are, and that everything is documented."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import flapenv

ROOT = Path(flapenv.__file__).parents[1]
SOURCES = sorted(
    path for folder in ("flapenv", "agents", "clients", "tests", "benchmarks") for path in (ROOT / folder).rglob("*.py")
)
LAYERS = (  # each may import itself and what stands after it
    "train",
    "clients",
    "agents",
    "flapenv.validation",
    "flapenv.envs",
    "flapenv.animation.film",
    "flapenv.animation.files",
    "flapenv.animation.sheet",
    "flapenv.animation.panels",
    "flapenv.animation.beat",
    "flapenv.adapt.__main__",
    "flapenv.adapt.report",
    "flapenv.adapt.drawing",
    "flapenv.adapt.company",
    "flapenv.adapt.tuning",
    "flapenv.adapt.references",
    "flapenv.adapt.task",
    "flapenv.adapt.rungs",
    "flapenv.adapt.ladder",
    "flapenv.adapt.conditions",
    "flapenv.adapt.cut_wing",
    "flapenv.waveform",
    "flapenv.assessment.assess",
    "flapenv.assessment.rankings",
    "flapenv.assessment.hovering",
    "flapenv.assessment.validity",
    "flapenv.objective",
    "flapenv.references",
    "flapenv.heave.drawing",
    "flapenv.heave.linear",
    "flapenv.heave.dynamics",
    "flapenv.heave.trim",
    "flapenv.heave.gusts",
    "flapenv.trade_off",
    "flapenv.problem_tables",
    "flapenv.files",
    "flapenv.wing_pool",
    "flapenv.many_optima",
    "flapenv.shape_curve",
    "flapenv.optimum",
    "flapenv.search",
    "flapenv.coordinates",
    "flapenv.problem",
    "flapenv.drawing",
    "flapenv.simulation",
    "flapenv.performance",
    "flapenv.case",
    "flapenv.model",
    "flapenv.insects",
    "flapenv.read_json",
    "flapenv.whole_file",
    "flapenv.tables",
    "flapenv.aero.blade_element",
    "flapenv.aero.history",
    "flapenv.aero.inertia",
    "flapenv.aero.axes",
    "flapenv.aero.heaving",
    "flapenv.aero.paid_power",
    "flapenv.aero.wingbeat",
    "flapenv.aero.accelerators",
    "flapenv.aero.compiled",
    "flapenv.aero.plate_averages",
    "flapenv.aero.force_laws",
    "flapenv.aero.coefficients",
    "flapenv.aero.induced",
    "flapenv.aero.motions",
    "flapenv.aero.spline_motion",
    "flapenv.aero.splines",
    "flapenv.aero.stroke",
    "flapenv.aero.wing",
    "flapenv.aero.planform",
    "flapenv.aero.quadrature",
    "flapenv.aero.threads",
    "flapenv.aero.parameters",
    "flapenv.aero.checks",
    "flapenv.aero.arrays",
)


def test_importing_flapenv_loads_neither_scipy_nor_torch_nor_matplotlib_nor_numba() -> None:
    heavy = {"scipy", "torch", "matplotlib", "numba", "stable_baselines3"}
    code = (
        "import gymnasium, sys; before = set(sys.modules); import flapenv; new = set(sys.modules) - before;"
        "print(sorted({name.split('.')[0] for name in new} & set(sys.argv[1:])))"
    )
    command = [sys.executable, "-W", "error", "-c", code, *heavy]
    found = subprocess.run(command, capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def layer(module: str) -> int | None:
    for rank, name in enumerate(LAYERS):
        if module == name or module.startswith(f"{name}."):
            return rank
    return None


@pytest.mark.parametrize(
    "path", [p for p in SOURCES if p.name != "__init__.py"], ids=lambda p: str(p.relative_to(ROOT))
)
def test_imports_run_downwards(path: Path) -> None:
    own = layer(".".join(path.relative_to(ROOT).with_suffix("").parts))
    if own is None:
        return
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        imported = node.module if isinstance(node, ast.ImportFrom) else None
        rank = layer(imported) if imported else None
        assert rank is None or rank >= own, f"{path.name} imports {imported}"


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: str(p.relative_to(ROOT)))
def test_no_file_is_longer_than_400_lines(path: Path) -> None:
    assert len(path.read_text(encoding="utf-8").splitlines()) <= 400


@pytest.mark.parametrize("name", flapenv.__all__)
def test_every_public_name_is_there_and_documented(name: str) -> None:
    value = getattr(flapenv, name)
    if inspect.isclass(value) or inspect.isfunction(value):
        assert inspect.getdoc(value)


def test_every_field_of_a_public_record_is_in_its_docstring() -> None:
    for name in flapenv.__all__:
        value = getattr(flapenv, name)
        for field in getattr(value, "__dataclass_fields__", {}):
            assert f"{field}:" in inspect.getdoc(value), f"{name}.{field}"
