"""Where journals go: the checkout's own folder, or the user's."""

from pathlib import Path

import platformdirs
import pytest

from game import places


def test_this_checkout_is_known() -> None:
    root = Path(__file__).resolve().parents[1]
    assert places.checkout() == root
    assert places.sessions_folder() == root / "data" / "sessions"


def test_installed_elsewhere_uses_the_users_data_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    package = tmp_path / "site-packages" / "game"
    assert places.checkout(package) is None
    folder = places.sessions_folder(package)
    assert folder == platformdirs.user_data_path("ana", appauthor=False) / "sessions"
    assert folder.is_relative_to(tmp_path)
    assert not folder.exists()


def test_a_checkout_keeps_its_own_unless_it_may_not_be_written_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    root = tmp_path / "checkout"
    root.mkdir()
    (root / "pyproject.toml").touch()
    assert places.sessions_folder(root / "game") == root / "data" / "sessions"
    monkeypatch.setattr("os.access", lambda *_: False)
    assert places.sessions_folder(root / "game") == tmp_path / "data" / "ana" / "sessions"


def test_a_path_is_shown_from_the_home_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/home/somebody")
    assert places.shortened(Path("/home/somebody/data/x")) == "~/data/x"
    assert places.shortened(Path("/srv/x")) == "/srv/x"
