"""The command that makes all pages anew: which scripts it runs, and what it says of one that fails."""

import re
import sys

import pytest

from validation import pages
from validation.page import STUDIES


def test_every_page_that_names_its_script_is_made_anew():
    named = {
        name
        for path in STUDIES.glob("*.md")
        for name in re.findall(r"^Written by\s`python -m ([\w.]+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert len(named) > 10
    assert named <= {*pages.scripts()}


def test_scripts_are_chosen_by_words_of_their_names():
    assert [*pages.scripts(["contact.growth", "hypoid_pairs"])] == [
        "validation.contact.growth",
        "docs.how_it_works.hypoid_pairs",
    ]


def test_a_script_that_fails_is_named_with_its_log_and_the_others_run(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(pages, "scripts", lambda _: ["validation.no_such_script", "this"])
    monkeypatch.setattr(sys, "argv", ["pages", "--logs", str(tmp_path / "logs")])
    with pytest.raises(SystemExit) as end:
        pages.main()
    assert end.value.code == 1
    first, failed, well = capsys.readouterr().out.splitlines()
    assert "loaded_tca" in first
    log = tmp_path / "logs" / "validation.no_such_script.txt"
    assert re.fullmatch(rf"validation\.no_such_script: FAILED after \d+ s: see {re.escape(str(log))}", failed)
    assert "No module named" in log.read_text(encoding="utf-8")
    assert re.fullmatch(r"this: \d+ s", well)


def test_a_word_that_no_script_has_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["pages", "nothing-of-the-kind"])
    with pytest.raises(SystemExit) as end:
        pages.main()
    assert end.value.code == 2
    assert "no script has nothing-of-the-kind in its name" in capsys.readouterr().err
