"""Who may talk to the explorer: pages that it served itself, to a browser on this machine."""

from collections.abc import Sequence

from flask import Flask, Request, Response, request
from werkzeug.exceptions import HTTPException

LARGEST_REQUEST = 2**17
"""What the page sends is small [bytes]."""
ANYTHING_ELSE = "/<path:path>"
"""Dash's rule for paths that nothing answers, under each of which it would serve the page."""
FRIENDLY_SITES = (None, "same-origin", "none")
"""Values of Sec-Fetch-Site that come from the page itself, from an address typed in, or from an older browser."""


def guard(server: Flask, script_hashes: Sequence[str]) -> None:
    """Refuse foreign requests, and send every answer with headers that keep the page to itself.

    A page of another site may send requests to 127.0.0.1, and may even name itself so (DNS rebinding). The first
    carries another Origin, the second another Host.

    Args:
        server: what answers.
        script_hashes: of the inline scripts that the page holds, as a Content-Security-Policy names them.
    """
    server.config["MAX_CONTENT_LENGTH"] = LARGEST_REQUEST
    policy = "; ".join(
        (
            "default-src 'none'",
            f"script-src 'self' {' '.join(script_hashes)}",
            "style-src 'self' 'unsafe-inline'",  # Plotly and the sliders set styles as they go
            "img-src 'self' data:",
            "font-src 'self' data:",
            "connect-src 'self'",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        )
    )

    @server.before_request
    def refuse() -> Response | None:
        reason = foreign(request)
        if reason is not None:
            return _said(f"{reason} is not allowed here", 403)
        return _said("Not Found", 404) if str(request.url_rule) == ANYTHING_ELSE else None

    @server.after_request
    def sealed(response: Response) -> Response:
        response.headers["Content-Security-Policy"] = policy
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["X-Frame-Options"] = "DENY"
        response.headers["Referrer-Policy"] = "no-referrer"
        response.headers["Cross-Origin-Resource-Policy"] = "same-origin"
        response.headers["Cross-Origin-Opener-Policy"] = "same-origin"
        return response

    @server.errorhandler(Exception)
    def failed(mistake: Exception) -> Response:
        if isinstance(mistake, HTTPException):
            return _said(str(mistake.name), mistake.code or 400)
        server.logger.debug("refused", exc_info=mistake)
        return _said("the request is not one that this page sends", 400)


def foreign(asked: Request) -> str | None:
    """What of a request does not come from a page of this server; None where all does."""
    port = asked.environ.get("SERVER_PORT", "")
    hosts = [f"{name}:{port}" for name in ("127.0.0.1", "localhost", "[::1]")]
    host = asked.headers.get("Host", "")
    if host not in hosts:
        return "this Host"
    if asked.headers.get("Sec-Fetch-Site") not in FRIENDLY_SITES and asked.method != "GET":
        return "a request from another site"
    origin = asked.headers.get("Origin")
    if origin is not None and origin != f"http://{host}":
        return "this Origin"
    if asked.method == "POST" and asked.mimetype != "application/json":
        return "this Content-Type"
    return None


def _said(text: str, code: int) -> Response:
    """One line of plain text."""
    return Response(f"{text}\n", status=code, mimetype="text/plain")
