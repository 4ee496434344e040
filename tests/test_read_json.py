"""Files that others may have changed are read whole, or refused in one line that names them and the place."""

import json
import os
import time
import tracemalloc
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


def test_a_file_larger_than_any_of_ours_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b" " * 17_000_000)
    with pytest.raises(ValueError, match=r"a.json has more than 16,777,216 bytes; allowed: up to 16,777,216"):
        read_object(path)


def test_what_might_never_end_or_cannot_be_a_path_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "loop.json").symlink_to(tmp_path / "loop.json")
    for path, said in (
        ("/dev/zero", "/dev/zero is a pipe or a device; allowed: a file"),
        (tmp_path / "pipe.json", "pipe.json is a pipe or a device; allowed: a file"),
        (tmp_path, "is a folder; allowed: a file"),
        (tmp_path / "loop.json", "loop.json cannot be read .Too many levels"),
        (tmp_path / ("a" * 5000), r"/aaaa.* \.\.\. a+ cannot be read .File name too long.; allowed: a file"),
        (tmp_path / "a\0b", r"a.x00b cannot be read .embedded null byte.; allowed: a file"),
        (tmp_path / "a.json", "a.json does not exist; allowed: a file"),
    ):
        for read in (read_text, read_object):
            with pytest.raises(OSError, match=said) as caught:
                read(path)
            assert len(str(caught.value)) < 1200


def test_an_error_is_one_short_line_whatever_the_file_holds(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    odd = "a\nb\x1b[31m\u0085\u2028" * 100_000
    for value in ("NaN", '"\\ud800"', "[1, 1e999]"):
        path.write_text(f"{{{json.dumps(odd)}: {value}}}")
        with pytest.raises(ValueError, match=r"a\.json") as caught:
            read_object(path)
        assert str(caught.value).isprintable()
        assert len(str(caught.value)) < 1200
    path.write_text(f"{{{json.dumps(odd)}: 1, {json.dumps(odd)}: 2}}")
    with pytest.raises(ValueError, match="stands twice in one object") as caught:
        read_object(path)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 1200


def test_a_long_key_over_many_values_takes_no_more_room_than_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps({"k" * 10**6: [0] * 100_000}))
    tracemalloc.start()
    try:
        assert len(read_object(path)) == 1
        assert tracemalloc.get_traced_memory()[1] < 10**8  # a place for each value would be 10¹¹
    finally:
        tracemalloc.stop()


def test_a_key_that_stands_twice_among_many_is_found_at_once(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text("{" + ", ".join(f'"{key}": 0' for key in [*range(150_000), 149_999]) + "}")
    began = time.perf_counter()
    with pytest.raises(ValueError, match="the key '149999' stands twice"):
        read_object(path)
    assert time.perf_counter() - began < 20  # counting each key takes minutes


def test_errors_call_the_file_as_they_are_told(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("[]")
    with pytest.raises(ValueError, match=r"^--config a holds no object but a list; allowed: a config$"):
        read_object(tmp_path / "a.json", called="--config a", mend="a config")
