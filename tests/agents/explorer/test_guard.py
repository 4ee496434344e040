"""Who is refused by the explorer, and what it sends with every answer."""

from typing import Any

import pytest

FOREIGN_HOSTS = ("evil.example", "evil.example:8050", "127.0.0.1:8051", "127.0.0.1", "192.168.0.2:8050", "")
UNKNOWN = '{"output": "nothing.children", "inputs": []}'
POLICY = (
    "default-src 'none'; script-src 'self' {}; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "font-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
SEALS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
FOREIGN_BODIES = ("", "{", "[]", "1", "null", "{}", UNKNOWN, '{"output": 5}', "[" * 5000)


@pytest.mark.parametrize("host", FOREIGN_HOSTS)
def test_a_page_under_another_name_is_refused(page: Any, base: str, host: str) -> None:
    answer = page.client.get("/", base_url=base, headers={"Host": host})
    assert answer.status_code == 403
    assert answer.text.count("\n") == 1


@pytest.mark.parametrize("host", ["127.0.0.1:8050", "localhost:8050", "[::1]:8050"])
def test_a_page_under_its_own_name_is_served(page: Any, base: str, host: str) -> None:
    assert page.client.get("/", base_url=base, headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:9999"},
        {"Origin": "https://127.0.0.1:8050"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
        {"Host": "evil.example"},
    ],
)
def test_a_request_from_another_site_is_refused(page: Any, headers: dict[str, str]) -> None:
    assert page.post({}, **headers).status_code == 403


def test_a_form_cannot_be_posted(page: Any, base: str) -> None:
    answer = page.client.post("/_dash-update-component", base_url=base, data={"output": "numbers.children"})
    assert answer.status_code == 403


def test_a_large_request_is_refused(page: Any) -> None:
    assert page.post("[" + "0," * 2**17 + "0]").status_code == 413


@pytest.mark.parametrize("body", FOREIGN_BODIES)
def test_a_request_that_no_page_sends_is_refused_in_one_line(page: Any, body: str) -> None:
    answer = page.post(body)
    assert 400 <= answer.status_code < 500
    assert answer.text.count("\n") == 1
    assert "Traceback" not in answer.text


def test_inputs_that_are_missing_are_refused_in_one_line(page: Any) -> None:
    answer = page.post(
        {"output": "numbers.children", "outputs": {"id": "numbers", "property": "children"}, "inputs": []}
    )
    assert answer.status_code == 400


def test_every_answer_keeps_the_page_to_itself(page: Any, base: str) -> None:
    scripts = " ".join(page.app.csp_hashes())
    assert "sha256-" in scripts
    assert "unsafe" not in scripts
    for path in ("/", "/_dash-layout", "/beat.js", "/nowhere/at/all"):
        headers = page.client.get(path, base_url=base).headers
        assert headers["Content-Security-Policy"] == POLICY.format(scripts)
        assert {name: headers[name] for name in SEALS} == SEALS


@pytest.mark.parametrize("path", ["/nope", "/nowhere/at/all", "/_dash-nothing", "/assets/nothing.js"])
def test_a_path_that_nothing_answers_is_not_found(page: Any, base: str, path: str) -> None:
    answer = page.client.get(path, base_url=base)
    assert answer.status_code == 404
    assert answer.text == "Not Found\n"


def test_the_page_names_no_other_server(page: Any, base: str) -> None:
    text = page.client.get("/", base_url=base).text
    assert "http://" not in text
    assert "https://" not in text
    assert "/beat.js" in text
