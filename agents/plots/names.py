"""Names that somebody else chose, in figures."""

import html


def plain(name: str) -> str:
    """A name as Plotly shows it letter by letter: neither markup nor a template, which its texts may hold."""
    return html.escape(name, quote=False).replace("%{", "%&#123;").replace("$", "&#36;")
