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
