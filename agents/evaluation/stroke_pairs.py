"""Which stroke belongs to which insect, of those that were published and of those in files."""

from collections.abc import Sequence
from pathlib import Path

from flapenv.aero.stroke import Stroke
from flapenv.files import read_strokes
from flapenv.files.strokes import ENDINGS
from flapenv.insects import INSECTS, Insect, load_insect

PUBLISHED = "published"
"""The name of the eight insects' own strokes, Table 1."""
Pairs = list[tuple[Insect, Stroke]]


def is_strokes(name: str) -> bool:
    """Whether a subject is called as strokes are: an insect, `PUBLISHED`, or a stroke file by its ending."""
    return name in (*INSECTS, PUBLISHED) or Path(name).suffix.lower() in ENDINGS


def stroke_pairs(name: str, insects: Sequence[str], wings: Sequence[Insect]) -> Pairs:
    """Insects and strokes of a subject.

    Args:
        name: an insect's, `PUBLISHED`, or a path.
        insects: names of those that are asked for; empty for all.
        wings: insects of one's own that are asked for in their place.

    Raises:
        ValueError: where it is open which stroke is whose, or an insect has several.
        OSError: for files that cannot be read.
    """
    pairs = _of_insects(name, insects, wings) if name in (*INSECTS, PUBLISHED) else _of_file(name, insects, wings)
    names = [insect.name for insect, _ in pairs]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"{name} has several strokes of {', '.join(twice)}; allowed: one an insect")
    return pairs


def _of_insects(name: str, insects: Sequence[str], wings: Sequence[Insect]) -> Pairs:
    """The insects' own strokes."""
    if wings:
        raise ValueError(f"--wing does not go with {name}, whose strokes belong to the insects; allowed: --insects")
    names = insects or (INSECTS if name == PUBLISHED else [name])
    if name != PUBLISHED and list(names) != [name]:
        raise ValueError(f"--insects {' '.join(names)} does not go with {name}; allowed: {PUBLISHED} --insects ...")
    return [(insect, insect.stroke) for insect in map(load_insect, names)]


def _of_file(name: str, insects: Sequence[str], wings: Sequence[Insect]) -> Pairs:
    """The strokes of a file, those that are asked for; a single stroke of nobody is given to each of them."""
    found = read_strokes(name)
    given = list(wings) or [load_insect(one) for one in insects]
    nobodys = [one.stroke for one in found if one.insect is None]
    if len(nobodys) == len(found) == 1 and given:
        return [(insect, nobodys[0]) for insect in given]
    if nobodys:
        raise ValueError(
            f"{name} does not say whose {len(nobodys)} of {len(found)} strokes are; allowed: an insect with every "
            "stroke, or one stroke alone with --insects NAME or --wing FILE"
        )
    return _chosen(name, [(one.insect, one.stroke) for one in found], given)


def _chosen(name: str, pairs: Pairs, given: Sequence[Insect]) -> Pairs:
    """The strokes of those given, by name, or all where nobody is."""
    if not given:
        return pairs
    strokes = {insect.name: stroke for insect, stroke in pairs}
    missing = [insect.name for insect in given if insect.name not in strokes]
    if missing:
        raise ValueError(f"{name} has no stroke of {', '.join(missing)}; allowed: {', '.join(strokes)}")
    return [(insect, strokes[insect.name]) for insect in given]
