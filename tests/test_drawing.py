"""Pictures of wingbeats."""

import dataclasses
import io

import numpy as np
import pytest
from matplotlib.cbook import is_math_text

from flapenv import Insect, evaluate, optimum, simulate
from flapenv.drawing import draw_wingbeat, stroke_text, verbatim, wingbeat_image


def test_the_sheet_shows_sections_angles_lift_and_power_with_their_means(insect: Insect) -> None:
    figure = draw_wingbeat(insect, insect.stroke)
    assert [axes.get_ylabel() for axes in figure.axes] == ["", "angle [°]", "lift / weight", "power / mass [W/kg]"]
    assert insect.name in figure.get_suptitle()
    means = [axes.get_legend().get_texts()[0].get_text() for axes in figure.axes[2:]]
    own = evaluate(insect)
    assert means == [f"mean {own.weight_support:.3f}", f"mean {own.specific_power:.2f}"]
    history = simulate(insect, strips=4, steps=720, spacing="gauss")
    weight = insect.mass * 9.81
    for axes, expected in zip(figure.axes[2:], (history.lift / weight, history.power / insect.mass), strict=True):
        np.testing.assert_allclose(axes.lines[0].get_ydata(), expected)


@pytest.mark.parametrize("name", [r"$\frac{$", "$x_1$ <b>", "$", r"a\$b$c"])
def test_a_name_is_no_formula(name: str, hawkmoth: Insect) -> None:
    figure = draw_wingbeat(dataclasses.replace(hawkmoth, name=name), hawkmoth.stroke)
    assert verbatim(name) in figure.get_suptitle()
    assert not is_math_text(figure.get_suptitle())
    figure.savefig(io.BytesIO())


def test_the_history_behind_the_picture_has_the_means_of_the_fast_path(hawkmoth: Insect) -> None:
    best = optimum(hawkmoth).stroke
    history = simulate(hawkmoth, best, strips=4, steps=720, spacing="gauss")
    ours = evaluate(hawkmoth, best)
    assert history.mean_lift == pytest.approx(ours.lift, rel=1e-3)
    assert history.mean_power() == pytest.approx(ours.power, rel=1e-3)


def test_the_image_is_an_array_of_colours_and_differs_between_strokes(hawkmoth: Insect) -> None:
    own, best = wingbeat_image(hawkmoth, hawkmoth.stroke), wingbeat_image(hawkmoth, optimum(hawkmoth).stroke)
    assert own.dtype == np.uint8
    assert own.shape == best.shape == (640, 960, 3)
    assert np.any(own != best)


def test_strokes_are_written_in_degrees(hawkmoth: Insect) -> None:
    text = stroke_text(hawkmoth.stroke)
    assert text == "f = 26.3 Hz   φmax = 60.5°   Cφ = 0   Cθ = 5   θmax = 58.0°   δ = 90.0°"


def test_without_matplotlib_the_extra_to_install_is_named(hawkmoth: Insect, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(ImportError, match=r"pip install 'flapenv\[report\]'"):
        draw_wingbeat(hawkmoth, hawkmoth.stroke)
