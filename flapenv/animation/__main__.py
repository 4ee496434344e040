"""`python -m flapenv.animation`: a GIF or MP4 of an insect's wingbeat."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from flapenv.animation.film import FRAMES, animate
from flapenv.animation.sheet import WIDTH
from flapenv.insects import INSECTS, load_insect
from flapenv.optimum import optimum
from flapenv.problem import PROBLEMS


def main(words: Sequence[str] | None = None) -> None:
    """Write the moving picture that the arguments ask for.

    Args:
        words: of the command line; those the program was started with where None.
    """
    parser = argparse.ArgumentParser(
        prog="python -m flapenv.animation",
        description="Write one wingbeat as a moving picture: the wing section with the force on it, both wings from "
        "above, and traces of the angles, of lift and of power. Needs the extra 'report'.",
        epilog="example: python -m flapenv.animation hawkmoth --stroke both --out hawkmoth.mp4",
    )
    parser.add_argument("insect", nargs="?", default="hawkmoth", metavar="INSECT", help=f"one of {', '.join(INSECTS)}")
    parser.add_argument(
        "--stroke",
        choices=("own", "optimal", "both"),
        default="own",
        help="the insect's own, the one of least power, or the first above the second (default: %(default)s)",
    )
    parser.add_argument(
        "--problem",
        choices=PROBLEMS,
        default=next(iter(PROBLEMS)),
        help="whose optimum is meant, and whose model is used (default: %(default)s)",
    )
    parser.add_argument("--out", type=Path, default=Path("wingbeat.gif"), metavar="FILE", help="ends in .gif or .mp4")
    parser.add_argument("--frames", type=int, default=FRAMES, help="of the wingbeat (default: %(default)s)")
    parser.add_argument("--width", type=int, default=WIDTH, metavar="PIXELS", help="default: %(default)s")
    asked = parser.parse_args(words)
    try:
        insect = load_insect(asked.insect)
        strokes = [insect.stroke] if asked.stroke != "optimal" else []
        if asked.stroke != "own":
            strokes.append(optimum(insect, asked.problem).stroke)
        options: dict[str, Any] = {"model": PROBLEMS[asked.problem].model, "frames": asked.frames, "width": asked.width}
        file = animate(strokes[0], insect, asked.out, compare=strokes[1] if strokes[1:] else None, **options)
    except (ValueError, OSError, ImportError) as error:
        parser.error(str(error))
    print(f"wrote {file} ({file.stat().st_size / 1e3:.0f} kB)")


if __name__ == "__main__":
    main()
