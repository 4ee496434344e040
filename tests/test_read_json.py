"""Files that others may have changed are read whole, or refused in one line that names them and the place."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flapenv.read_json import DEEPEST, read_object, read_text

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text("aφ[]."),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text("ab", min_size=1), inner, max_size=3),
    max_leaves=10,
)


@given(content=st.dictionaries(st.text("abc", min_size=1), VALUES, max_size=4))
def test_what_json_writes_is_read_back(content: dict[str, object], tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.mktemp("read") / "a.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    assert read_object(path) == content


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_bytes(b'\xef\xbb\xbf{"a": 1}')
    assert read_object(tmp_path / "a.json") == {"a": 1}
    assert read_text(tmp_path / "a.json") == '{"a": 1}'


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is not JSON: it is empty"),
        (b" \n", "is not JSON: it is empty"),
        (b'{"a": 1', "is not JSON that can be read: Expecting"),
        (b'{"a": 1} {', "is not JSON that can be read: Extra data"),
        (b"[1]", "holds no object but a list"),
        (b"1", "holds no object but a number"),
        (b"null", "holds no object but null"),
        (b"true", "holds no object but true or false"),
        (b'"a"', "holds no object but a text"),
        (b'{"a": [{"b": NaN}]}', r"a\[0\].b = NaN is not a number; allowed: finite numbers"),
        (b'{"a": -Infinity}', "a = -Infinity is not a number"),
        (b'{"a": 1e999}', "a = Infinity is not a number"),
        (b'{"a": {"b": 1, "b": 2}}', "the key 'b' stands twice in one object"),
        (b'{"a": "\\ud800"}', r"a holds '\\ud800': surrogates not allowed"),
        (b'{"\\ud800": 1}', r"holds '\\ud800': surrogates not allowed"),
        (b"\xff\xfe{", "is not JSON: 'utf-8' codec"),
        (b'{"a": ' + b"[" * 100_000, "nested too deep"),
        (b'{"a": ' + b"[" * (DEEPEST + 1) + b"]" * (DEEPEST + 1) + b"}", "nested too deep"),
        (b'{"a": ' + b"9" * 5000 + b"}", "is not JSON that can be read"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(content: bytes, said: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=said) as caught:
        read_object(path)
    assert str(path) in str(caught.value)
    assert "allowed: " in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_file_without_an_end_is_not_read_to_the_end() -> None:
    with pytest.raises(ValueError, match="/dev/zero has more than 1,000 bytes; allowed: up to 1,000"):
        read_text("/dev/zero", largest=1000)


def test_errors_call_the_file_as_they_are_told(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("[]")
    with pytest.raises(ValueError, match=r"^--config a holds no object but a list; allowed: a config$"):
        read_object(tmp_path / "a.json", called="--config a", mend="a config")
