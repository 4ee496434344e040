"""What the page says of a stroke, each number and figure where it belongs."""

import json
from typing import Any

import plotly.graph_objects as go
import pytest

import flapenv
from agents.explorer.controls import OWN_WING, read_stroke
from agents.plots.beat import beat
from agents.plots.cycle import forces, terms, waveforms
from flapenv.assessment import assess, rankings

NAMES = ("frequency", "flap_amplitude", "flap_shape", "pitch_shape", "alpha_mid", "pitch_phase")


def drawn(page: Any, beside: str = "optimal") -> dict[str, Any]:
    """Remarks and figures of what the sliders say."""
    calm = [page.values["case"], beside, *(page.values[name] for name in NAMES)]
    answer: dict[str, Any] = page.ask("remarks.children", changed="calm.data", calm=calm)
    return answer


def remarks(page: Any) -> str:
    return page.words(drawn(page)["remarks"]["children"])


def tiles(page: Any) -> dict[str, str]:
    """Texts of the tiles of what the sliders say, with their units."""
    found = {}
    for tile in page.numbers()[0]["props"]["children"]:
        label, *rest = tile["props"]["children"]
        found[page.words(label)] = page.words(rest)
    return found


def load_own(page: Any, **values: Any) -> None:
    """Choose an insect, and its own stroke with it."""
    page.values |= {name: one["value"] for name, one in page.choose(**values).items() if name in NAMES}


def moved(page: Any, insect: str = "hawkmoth") -> flapenv.Stroke:
    return read_stroke([page.values[name] for name in NAMES], flapenv.load_insect(insect))


@pytest.mark.parametrize("beside", ["own", "optimal"])
def test_every_figure_is_of_the_sliders_stroke_and_the_one_beside_it(page: Any, beside: str) -> None:
    page.choose(insect="hawkmoth")
    insect, problem, yours = flapenv.load_insect("hawkmoth"), flapenv.PROBLEMS["free-frequency"], moved(page)
    other = insect.stroke if beside == "own" else flapenv.optimum(insect, problem).stroke
    strokes, model = {"yours": yours, beside: other}, problem.model
    wanted: dict[str, go.Figure] = {
        "beat": beat(insect, strokes, model),
        "forces": forces(insect, strokes, model),
        "waveforms": waveforms(insect, strokes, model),
        "terms": terms(insect, yours, model),
    }
    answer = drawn(page, beside)
    for name, figure in wanted.items():
        assert answer[f"figure-{name}"]["figure"]["data"] == json.loads(figure.to_json())["data"], name
        assert answer[f"figure-{name}"]["style"] == {"height": f"{figure.layout.height}px"}


def test_tiles_are_named_for_what_they_hold(page: Any) -> None:
    page.choose(insect="hawkmoth")
    judged = assess("hawkmoth", moved(page))
    assert judged.gap is not None
    assert judged.saving is not None
    assert judged.saving != pytest.approx(judged.gap)
    assert tiles(page) == {
        "weight support Λ": f"{judged.weight_support:#.5g} ",
        "power P*": f"{judged.specific_power:#.5g} W/kg",
        "gap to the optimum": f"{100 * judged.gap:#.5g} %",
        "saving against own stroke": f"{100 * judged.saving:#.5g} %",
    }


def test_the_note_tells_optimum_bound_cfd_and_model_apart(page: Any) -> None:
    told, judged = page.words(page.choose(insect="hawkmoth")["note"]["children"]), assess("hawkmoth")
    best = judged.best
    assert f"optimum of the box: {best.specific_power:.4g} W/kg, proven bound {best.lower_bound:.4g} W/kg" in told
    model = f"this model {judged.own_specific_power:.4g} W/kg"
    assert f"CFD of its own stroke: {judged.cfd_power:.4g} W/kg, {model}" in told


def test_nothing_is_saved_of_the_own_stroke_itself(page: Any) -> None:
    load_own(page, insect="fruitfly")
    shown = page.numbers()
    assert tiles(page)["saving against own stroke"] == "–"
    assert page.exact(shown)["saving"] is None
    told = remarks(page)
    assert "it does not hover" in told
    assert "saving compares" not in told
    assert "less power" not in told


@pytest.mark.parametrize("alpha", [15.0, 70.0])
def test_the_models_in_which_a_stroke_saves_nothing_are_named(page: Any, alpha: float) -> None:
    load_own(page, insect="hawkmoth")
    page.values["alpha_mid"] = alpha
    model = flapenv.PROBLEMS["free-frequency"].model
    savings = {one.model: one.saving for one in rankings(flapenv.load_insect("hawkmoth"), moved(page), model)}
    less = [name for name, saving in savings.items() if saving is not None and saving > 0]
    told = remarks(page)
    assert f"less power than its own stroke, both carrying the weight, in {len(less)} of {len(savings)} other" in told
    lost = [name for name in savings if name not in less]
    assert told.endswith(f"not in {', '.join(lost)}" if lost else "other models")


def test_what_is_outside_is_told_by_what_it_is_outside_of(page: Any) -> None:
    load_own(page, insect="fruitfly")
    told = remarks(page)
    assert "outside of the angles that the model is made for: α at mid-stroke = 46°, beyond 25 to 45°" in told
    assert "outside of the CFD cases" not in told
    page.values["flap_amplitude"] = 90
    assert "outside of the CFD cases: φmax = 90°, beyond 45 to 88.5°" in remarks(page)


def test_where_nothing_hovers_the_optimum_is_called_most_lift(page: Any) -> None:
    load_own(page, insect=OWN_WING, mass=2000)
    answer = page.choose()
    assert answer["load-optimal"]["children"] == "most lift"
    assert {"value": "optimal", "label": "most lift"} in answer["beside"]["options"]
    assert "of it, which “most lift” loads" in page.words(answer["note"]["children"])
    assert tiles(page)["gap to the optimum"] == "–"
    assert "most lift" in json.dumps(drawn(page)["figure-forces"]["figure"])
    answer = page.choose(mass=100)
    assert answer["load-optimal"]["children"] == "the optimum"


@pytest.mark.parametrize("problem", ["free-frequency", "fixed-frequency", "profile-drag"])
def test_what_the_learned_stroke_was_trained_for_is_told_where_it_is_another_problem(page: Any, problem: str) -> None:
    told = page.words(page.choose(insect="fruitfly", problem=problem)["note"]["children"])
    assert ("trained in problem A" in told) == (problem != "free-frequency")


def test_a_typed_wing_tells_that_its_own_stroke_is_made_up_and_which(page: Any) -> None:
    told = page.words(page.choose(insect=OWN_WING)["note"]["children"])
    assert "its own stroke is made up: frequency f = 100 Hz, amplitude φmax = 60°" in told
    assert "α_mid = 35°" in told
    assert "made up" not in page.words(page.choose(insect="fruitfly")["note"]["children"])


@pytest.mark.parametrize(("field", "value"), [("mass", 80), ("wing_length", 12), ("mean_chord", 3.5), ("r1_hat", 0.5)])
def test_a_wing_with_one_other_number_is_another_wing(page: Any, field: str, value: float) -> None:
    page.choose(insect=OWN_WING)
    before = page.exact(page.numbers(frequency=100.0))
    page.choose(**{field: value})
    assert page.exact(page.numbers())["weight_support"] != before["weight_support"]


@pytest.mark.parametrize(
    ("field", "value", "wanted"),
    [
        ("mean_chord", 0.02, "wing length R over mean chord c̄ = 650 is not allowed; allowed: 1 to 20"),
        ("mass", 1e6, "mass of the body = 1e+06 mg on two wings of 52 mm² each is a wing loading of"),
    ],
)
def test_sizes_that_do_not_go_together_are_told_in_the_pages_words(
    page: Any, field: str, value: float, wanted: str
) -> None:
    answer = page.ask("case.data", insect=OWN_WING, **{field: value})
    assert page.words(answer["note"]["children"]).startswith(wanted)
