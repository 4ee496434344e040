"""Sphinx settings of the documentation site: `make docs` builds it, without the network, warnings being errors."""

import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.transforms.post_transforms import SphinxPostTransform

import flapenv

DOCS = Path(__file__).parent
OWN = r"(flapenv|agents)\."
"""What the site's own cross-references begin with; all else is another project's, and looked up nowhere."""
LOADS = re.compile(
    r"""<(?:script|img|iframe|source|video)\b[^>]*\ssrc="(?:https?:)?//[^"]*"    # by a tag
      | <link\b(?![^>]*rel="(?:canonical|license)")[^>]*\shref="(?:https?:)?//[^"]*"
      | (?:url\(|@import)\s*["']?(?:https?:)?//[^"')\s]*                        # by a style sheet
    """,
    re.VERBOSE,
)
"""What makes a browser ask the network for something when it opens a page or a style sheet."""

project = "flapenv"
author = "The flapenv authors"
project_copyright = author
release = version = flapenv.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build"]
highlight_language = "text"
default_role = "py:obj"  # a name in backticks is a link where the site has it
nitpick_ignore_regex = [(r"py:obj", ".*"), (r"py:.*", rf"(?!{OWN}).*")]

myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence"]

autoclass_content = "both"
autodoc_member_order = "bysource"
napoleon_numpy_docstring = False
napoleon_use_ivar = True
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88

html_theme = "furo"
html_title = "flapenv"
html_copy_source = False
html_show_sourcelink = False
html_static_path = ["_static"]
html_css_files = ["site.css"]


class RepositoryFolders(SphinxPostTransform):
    """A link to a folder of the repository, which only its own viewer can open, becomes the folder's name."""

    default_priority = 5  # before MyST looks for a page of that name

    def run(self, **_: Any) -> None:
        """Replace every such link of the page."""
        for link in list(self.document.findall(addnodes.pending_xref)):
            page = Path(self.env.doc2path(self.env.docname))
            target = link.get("reftarget") or ""
            if target.startswith(".") and (page.parent / target).is_dir():
                link.replace_self(nodes.literal(text=link.astext()))


def point_to_page(app: Sphinx, what: str, name: str, thing: object, options: Any, lines: list[str]) -> None:
    """Of an environment, whose docstring is its page in Markdown, leave the first line and the way to that page."""
    if what == "class" and "## Description" in lines:
        page = name.rsplit(".", 1)[-1].removesuffix("Env").lower()
        lines[1:] = ["", f"Everything about it: :doc:`/environments/{page}-v0`."]


def keep_formulas(app: Sphinx, what: str, name: str, thing: object, options: Any, lines: list[str]) -> None:
    """Let |φ̇| and P* in docstrings stand for themselves; to Sphinx they would be markup. Types have no such signs."""
    for number, line in enumerate(lines):
        if not line.startswith((":type", ":vartype", ":rtype")):
            lines[number] = re.sub(r"(`[^`]*`)|(?<!\\)([|*])", lambda sign: sign[1] or f"\\{sign[2]}", line)


def require_offline(app: Sphinx, mistake: Exception | None) -> None:
    """Refuse a site that would load anything from the network.

    Raises:
        SphinxError: naming the file and what it loads.
    """
    for path in [] if mistake else [*Path(app.outdir).rglob("*.html"), *Path(app.outdir).rglob("*.css")]:
        loaded = LOADS.search(path.read_text(encoding="utf-8"))
        if loaded:
            raise SphinxError(f"{path} loads from the network: {loaded[0]}")


def setup(app: Sphinx) -> None:
    """Add what the repository's pages need."""
    app.add_post_transform(RepositoryFolders)
    app.connect("autodoc-process-docstring", point_to_page, priority=400)  # before Google's sections are read
    app.connect("autodoc-process-docstring", keep_formulas, priority=600)  # after
    app.connect("build-finished", require_offline)
