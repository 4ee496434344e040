"""The tables of assessed strokes: every cell is the number that its column names."""

import dataclasses

from agents.evaluation.assessment_table import assessment_table, outside_sentences, ranking_sentence, ranking_table
from flapenv import INSECTS, HoverProblem, load_insect, optimum
from flapenv.assessment import StrokeAssessment, assess

COLUMNS = (
    ("weight_support", 4),
    ("weight_uncertainty", 3),
    ("specific_power", 2),
    ("power_uncertainty", 1),
    ("optimum_specific_power", 2),
    ("lower_bound", 2),
    ("gap_percent", 2),
    ("cfd_specific_power", 0),
    ("own_stroke_specific_power", 1),
    ("own_stroke_weight_support", 3),
    ("saving_percent", 0),
    ("saving_uncertainty_percent", 0),
    ("saving_to_cfd_percent", 0),
)
"""Keys of results.json in the order of the columns, and digits after the point."""


def wrong_strokes() -> list[StrokeAssessment]:
    """Of all insects, near the optimum but off in everything that has a column."""
    found = []
    for number, name in enumerate(INSECTS):
        best = optimum(name).stroke
        frequency = (1.02 + 0.01 * number) * best.frequency
        found.append(assess(name, dataclasses.replace(best, flap_shape=0.7, frequency=frequency)))
    return found


def cells(text: str, name: str) -> list[str]:
    (line,) = [line for line in text.splitlines() if line.split()[:1] == [name]]
    return line.split()[1:]


def test_every_cell_is_what_results_json_holds_rounded() -> None:
    results = wrong_strokes()
    text = assessment_table(results, "tried")
    for result in results:
        entry = result.to_dict()
        assert len({entry[key] for key, _ in COLUMNS}) == len(COLUMNS)  # no two columns could be mistaken
        assert cells(text, result.insect.name) == [f"{entry[key]:.{digits}f}" for key, digits in COLUMNS]
    gaps = [100 * result.gap for result in results]
    assert f"mean {sum(gaps) / 8:.3f} %, worst {max(gaps):.3f} %" in text
    assert "16 % in weight support and 11 % in power" in text  # docs/validation.md: 15.8 and 10.9


def test_the_table_of_models_says_what_each_saves() -> None:
    results = wrong_strokes()
    text = ranking_table(results)
    header = text.splitlines()[0].replace("saved [%] in", "").replace("this model", "this-model")
    models = header.replace("positive power", "positive-power").split()
    assert models == [
        "this-model",
        "extended-lifting-line",
        "polhamus",
        "robofly",
        "berman-wang",
        "positive-power",
    ]
    for result in results:
        saved = {ranking.model.replace(" ", "-"): f"{100 * ranking.saving:.1f}" for ranking in result.rankings}
        expected = [f"{100 * result.saving:.1f}", *(saved.get(model, "-") for model in models[1:])]
        assert cells(text, result.insect.name) == expected


def test_where_the_ranking_turns_round_is_said_and_the_own_stroke_is_not_ranked() -> None:
    learned = [assess(name, optimum(name).stroke) for name in ("hawkmoth", "honeybee")]
    assert ranking_sentence(learned) == (
        "learned needs less than the own stroke in 7 of 8 cases of other models; not with positive power: hawkmoth"
    )
    bee = load_insect("honeybee").stroke
    own = [assess("honeybee"), assess("honeybee", dataclasses.replace(bee, pitch_phase=bee.pitch_phase + 1e-6))]
    assert ranking_sentence(own) == ""


def test_an_insect_that_cannot_hover_is_named_with_the_most_it_could_lift() -> None:
    light = HoverProblem(box={"frequency_ratio": (0.3, 0.45)})
    result = assess("ladybird", problem=light)
    text = assessment_table([result])
    assert f"more than {result.best.max_weight_support:.3f} of its weight; learned {result.weight_support:.3f}" in text
    assert abs(result.best.max_weight_support - result.weight_support) > 0.01
    assert "gap to the optimum" not in text


def test_what_lies_outside_is_told_once_with_those_it_holds_for() -> None:
    results = [assess(name, optimum(name).stroke) for name in ("fruitfly", "hawkmoth", "honeybee")]
    lines = outside_sentences(results).splitlines()
    assert "  φmax = 90, beyond 45 to 88.5°: all" in lines
    assert "  f = 20.91 to 260.5, beyond 26.3 to 254 Hz: fruitfly, hawkmoth" in lines
    assert not any(line.startswith("outside of the problem's box") for line in lines)
    assert "outside of the problem's box" in outside_sentences([assess("fruitfly")])


def test_a_wing_without_cfd_says_none_where_cfd_would_stand() -> None:
    robot = dataclasses.replace(load_insect("dronefly"), name="robot", cfd=None)
    row = cells(assessment_table([assess(robot)]), "robot")
    assert [row[7], *row[-3:]] == ["none", "-", "-", "none"]  # its own stroke saves nothing of itself
    row = cells(assessment_table([assess(robot, optimum("dronefly").stroke)]), "robot")
    saved = assess("dronefly", optimum("dronefly").stroke).saving
    assert row[-2] == f"{100 * 0.1444 * (1 - saved):.0f}"  # the rms of the eight at equal weight
