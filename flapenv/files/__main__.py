"""`python -m flapenv.files`: print the schemas of stroke and wing files, or write them with --out."""

import argparse
from pathlib import Path

from flapenv.files.envelope import to_text, write_text
from flapenv.files.schemas import stroke_schema, wing_schema

SCHEMAS = {"stroke.schema.json": stroke_schema, "wing.schema.json": wing_schema}
"""Names of the files, and what makes them."""


def main(arguments: list[str] | None = None) -> None:
    """Print the schemas; write them where a folder is given."""
    parser = argparse.ArgumentParser(
        prog="python -m flapenv.files",
        description="JSON Schemas (draft 2020-12) of stroke files and wing files.",
        epilog="example: python -m flapenv.files --out docs/schemas",
    )
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="write them there instead")
    folder = parser.parse_args(arguments).out
    for name, schema in SCHEMAS.items():
        text = to_text(schema())
        if folder is None:
            print(text, end="")
            continue
        folder.mkdir(parents=True, exist_ok=True)
        write_text(folder / name, text)
        print(f"wrote {folder / name}")


if __name__ == "__main__":
    main()
