"""Models of these tests are made anew: some of them change what makes the models, of which no key tells."""

import pytest

from loaded_tca.compliance.kept import FOLDER


@pytest.fixture(autouse=True)
def _no_models_on_disk(monkeypatch):
    monkeypatch.setenv(FOLDER, "off")
