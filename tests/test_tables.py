"""Plain-text tables."""

from flapenv.tables import text_table


def test_columns_are_aligned_below_a_ruled_header() -> None:
    assert text_table([("name", "W/kg"), ("a", "1.5"), ("hawkmoth", "22.85")]).splitlines() == [
        "name       W/kg",
        "---------------",
        "a           1.5",
        "hawkmoth  22.85",
    ]
