"""Links that only the study can make."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from game.study.folder import StudyError, admit_by_roster, identify
from game.study.links import (
    KEY,
    LinkError,
    checked_address,
    of_token,
    panel_pseudonym,
    study_key,
    token,
)

OURS, THEIRS = b"a" * 32, b"b" * 32
ids = st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}", fullmatch=True)
panel_ids = st.from_regex(r"[A-Za-z0-9_-]{1,64}", fullmatch=True)


@given(ids, st.booleans())
def test_a_link_says_whose_it_is(participant: str, pilot: bool) -> None:
    made = token(OURS, participant, pilot=pilot)
    assert of_token(OURS, made) == (participant, pilot)
    with pytest.raises(LinkError):
        of_token(THEIRS, made)


@example("P01", "P02", "\ud800")
@given(ids, ids, st.text(alphabet=st.characters(), max_size=80))
def test_nothing_else_is_a_link(participant: str, other: str, anything: str) -> None:
    name, signature = token(OURS, participant).split(".")
    forged = [
        anything,
        f"{name}.{anything}",
        f"{name}.pilot.{signature}",
        f"{name}.{signature}.{anything}",
        f"{name}.{signature}=",
        f"{name}.{signature[:-1]}",
        f" {name}.{signature}",
        *([f"{other}.{signature}"] if other != participant else []),
    ]
    for text in forged:
        if text != token(OURS, participant):
            with pytest.raises(LinkError):
                of_token(OURS, text)


def test_a_pilots_link_is_no_link_to_the_study() -> None:
    name, _, signature = token(OURS, "P01", pilot=True).split(".")
    with pytest.raises(LinkError):
        of_token(OURS, f"{name}.{signature}")


@given(panel_ids)
def test_a_panels_id_has_one_pseudonym_that_only_the_key_gives(panel_id: str) -> None:
    name = panel_pseudonym(OURS, panel_id)
    assert identify(name).participant == name == panel_pseudonym(OURS, panel_id)
    assert panel_pseudonym(THEIRS, panel_id) != name
    assert panel_id not in name or len(panel_id) < 5


@pytest.mark.parametrize("wrong", ["", "a b", "../P01", "a" * 65, "P01\n", "$(id)", "naïve"])
def test_what_cannot_be_a_panels_id_is_refused(wrong: str) -> None:
    with pytest.raises(LinkError, match="not a panel's ID"):
        panel_pseudonym(OURS, wrong)


# --- the key ------------------------------------------------------------------------------------


def test_the_key_is_made_once_for_the_owner_alone(tmp_path: Path) -> None:
    key = study_key(tmp_path)
    assert (len(key), (tmp_path / KEY).stat().st_mode & 0o777) == (32, 0o600)
    assert study_key(tmp_path) == key
    assert [it.name for it in tmp_path.iterdir()] == [KEY]


def test_all_who_make_the_key_at_once_get_the_same(tmp_path: Path) -> None:
    with ThreadPoolExecutor(16) as pool:
        assert len(set(pool.map(study_key, [tmp_path] * 64))) == 1


def test_a_key_that_others_may_read_is_not_used(tmp_path: Path) -> None:
    study_key(tmp_path)
    (tmp_path / KEY).chmod(0o640)
    with pytest.raises(LinkError, match="other accounts") as caught:
        study_key(tmp_path)
    assert "chmod 600" in str(caught.value)


@pytest.mark.parametrize("size", [0, 31, 33])
def test_a_torn_key_is_not_replaced(tmp_path: Path, size: int) -> None:
    path = tmp_path / KEY
    path.write_bytes(b"x" * size)
    path.chmod(0o600)
    with pytest.raises(LinkError, match=f"{size} bytes instead of 32"):
        study_key(tmp_path)
    assert path.stat().st_size == size


def test_a_key_that_cannot_be_made_names_the_place(tmp_path: Path) -> None:
    with pytest.raises(LinkError, match="cannot be read or made"):
        study_key(tmp_path / "missing")


# --- the roster ---------------------------------------------------------------------------------


def test_a_roster_of_panel_ids_admits_their_pseudonyms(tmp_path: Path) -> None:
    (tmp_path / "roster.csv").write_text("id\n5f0a1b2c\n")
    listed, stranger = (
        identify(panel_pseudonym(study_key(tmp_path), it)) for it in ("5f0a1b2c", "ffffffff")
    )
    admit_by_roster(tmp_path, listed)
    admit_by_roster(tmp_path, identify("5f0a1b2c"))
    with pytest.raises(StudyError, match="not on the roster"):
        admit_by_roster(tmp_path, stranger)


# --- addresses ----------------------------------------------------------------------------------


def test_an_address_ends_in_a_slash() -> None:
    assert checked_address("https://lab.example/study") == "https://lab.example/study/"
    assert checked_address("http://localhost:8080/") == "http://localhost:8080/"


@pytest.mark.parametrize(
    "wrong",
    ["lab.example", "ftp://lab.example", "https://", "https://lab.example/?a=1", "https://[::1",
     "https://lab.example/#a", "https://lab.example:port/", "https://lab example/"],
)  # fmt: skip
def test_what_is_no_address_is_refused(wrong: str) -> None:
    with pytest.raises(LinkError, match="not the address of a website"):
        checked_address(wrong)
