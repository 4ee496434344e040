"""What is refused at the boundary, and how it is said."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flapenv import Stroke, load_insect
from flapenv.aero.checks import (
    is_single,
    one_line,
    require_count,
    require_flag,
    require_name,
    require_real,
    require_scalar,
    shown,
)


@given(st.floats(allow_nan=True, allow_infinity=True))
def test_a_number_passes_exactly_where_it_is_finite_and_inside(value: float) -> None:
    if np.isfinite(value) and 0 < value <= 2:
        assert require_real("x", value, 0.0, 2.0, open_low=True) == value
    else:
        with pytest.raises(ValueError, match=r"x = .* is not allowed; allowed: finite, in \(0, 2\] m"):
            require_real("x", value, 0.0, 2.0, open_low=True, unit="m")


@pytest.mark.parametrize(
    "value", ["3", ["3"], True, [True], None, [], 1j, [1j], np.datetime64("2020"), 10**400, [[1], [1, 2]], object()]
)
def test_what_is_no_real_number_is_refused(value: object) -> None:
    with pytest.raises(TypeError, match=r"x = .* is not a real number or an array of them"):
        require_real("x", value)


def test_the_message_shows_by_how_little_a_value_is_outside() -> None:
    with pytest.raises(ValueError, match=r"x = 1\.0000001 "):
        require_real("x", 1.0000001, 0.0, 1.0)


def test_arrays_are_copied_and_cannot_be_changed_behind_the_check() -> None:
    frequencies = np.array([30.0, 31.0])
    stroke = Stroke(frequency=frequencies, flap_amplitude=1.0, pitch_amplitude=1.0)
    frequencies[0] = -5
    assert stroke.frequency[0] == 30
    with pytest.raises(ValueError, match="read-only"):
        stroke.frequency[0] = -5


def test_scalars_counts_and_flags() -> None:
    assert type(require_scalar("x", np.float32(2))) is float
    assert require_count("n", np.int64(3)) == 3
    assert require_flag("f", True)
    with pytest.raises(TypeError, match="allowed: one number"):
        require_scalar("x", [1.0, 2.0])
    for value in (True, 2.0, "2"):
        with pytest.raises(TypeError, match="whole number"):
            require_count("n", value)
    with pytest.raises(TypeError, match="allowed: True, False"):
        require_flag("f", "yes")


def test_records_are_single_when_no_part_of_them_has_axes() -> None:
    import dataclasses

    hawkmoth = load_insect("hawkmoth")
    assert is_single(hawkmoth)
    for part in ("wing", "stroke"):
        record = getattr(hawkmoth, part)
        for field in vars(record).keys() - {"planform", "pitch_axis"}:
            spread = dataclasses.replace(record, **{field: np.full(2, getattr(record, field))})
            assert not is_single(dataclasses.replace(hawkmoth, **{part: spread}))


@given(st.text())
def test_a_text_is_shown_on_one_line_in_full_where_it_is_short(text: str) -> None:
    assert one_line(text).isprintable()
    assert one_line(text) == text or not text.isprintable()
    assert shown(text).isprintable()
    assert one_line("a\nb") == "a\\nb"


def test_of_much_the_ends_are_shown() -> None:
    text = one_line(f"begin{'.' * 10**6}end")
    assert text.startswith("begin")
    assert text.endswith("end")
    assert len(text) < 1100
    assert len(shown([1] * 10**5)) < 100
    with pytest.raises(ValueError, match=r"name = 'aaa.* is unknown; allowed: b") as caught:
        require_name("name", "a" * 10**6, ["b"])
    assert len(str(caught.value)) < 200


def test_a_value_that_python_does_not_write_is_still_told() -> None:
    with pytest.raises(ValueError, match="x = a int that cannot be shown is unknown; allowed: a"):
        require_name("x", 10**5000, ["a"])
