"""The explorer without a browser: its callbacks asked as the page asks them."""

import json
from typing import Any

import pytest
from dash import Dash
from werkzeug.test import TestResponse

from agents.explorer.app import make_app

BASE = "http://127.0.0.1:8050"
OWN_WING = {"wing-name": "my wing", "mass": 100, "wing_length": 13, "mean_chord": 4, "r1_hat": 0.49}
STROKE = {
    "frequency": 30.0,
    "flap_amplitude": 80.0,
    "flap_shape": 0.5,
    "pitch_shape": 4.0,
    "alpha_mid": 30.0,
    "pitch_phase": 85.0,
}


class Page:
    """What a page knows and asks."""

    def __init__(self, app: Dash) -> None:
        self.app, self.client = app, app.server.test_client()
        self.values: dict[str, Any] = {"insect": "hawkmoth", "problem": "free-frequency", "beside": "own"}
        self.values |= OWN_WING | {"reference_frequency": 100} | STROKE

    def post(self, body: Any, **headers: str) -> TestResponse:
        """Any request to the callbacks."""
        sent = body if isinstance(body, str | bytes) else json.dumps(body)
        return self.client.post(
            "/_dash-update-component", base_url=BASE, data=sent, content_type="application/json", headers=headers
        )

    def ask(self, output: str, changed: str = "insect.value", **values: Any) -> Any:
        """The answer of the callback whose outputs name `output`, with these values of the page."""
        self.values |= {name.replace("__", "-"): value for name, value in values.items()}
        key = next(key for key in self.app.callback_map if output in key)
        callback = self.app.callback_map[key]
        body = {
            "output": key,
            "outputs": self._outputs(key),
            "inputs": self._filled(callback["inputs"]),
            "state": self._filled(callback["state"]),
            "changedPropIds": [changed],
        }
        answer = self.post(body)
        assert answer.status_code in (200, 204), answer.text
        return answer.get_json()["response"] if answer.status_code == 200 else None

    def _outputs(self, key: str) -> Any:
        parts = [part.rsplit(".", 1) for part in key.strip(".").split("...")]
        made = [{"id": part[0], "property": part[1]} for part in parts]
        return made if key.startswith("..") else made[0]

    def _filled(self, wanted: list[dict[str, str]]) -> list[dict[str, Any]]:
        return [one | {"value": self.values.get(one["id"])} for one in wanted]

    def choose(self, **values: Any) -> dict[str, Any]:
        """Choose an insect; its case is known to the page then."""
        answer = self.ask("case.data", **values)
        self.values["case"] = answer["case"]["data"]
        return answer

    def numbers(self, **values: Any) -> Any:
        """What the page shows of a stroke."""
        return self.ask("numbers.children", changed="frequency.value", **values)["numbers"]["children"]

    @staticmethod
    def exact(children: Any) -> dict[str, Any]:
        """The numbers in full, of what `numbers` gave."""
        found = next(one["props"]["children"] for one in children if one["props"].get("id") == "exact")
        numbers: dict[str, Any] = json.loads(found)
        return numbers

    @classmethod
    def words(cls, component: Any) -> str:
        """All text of a component."""
        if isinstance(component, list):
            return " ".join(map(cls.words, component))
        return cls.words(component["props"].get("children")) if isinstance(component, dict) else str(component or "")


@pytest.fixture(scope="session")
def app() -> Dash:
    return make_app()


@pytest.fixture
def page(app: Dash) -> Page:
    return Page(app)


@pytest.fixture
def base() -> str:
    return BASE
