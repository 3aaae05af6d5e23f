"""Where journals of free play, and reports of what failed, are kept."""

from __future__ import annotations

import os
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent


def checkout(package: Path = PACKAGE) -> Path | None:
    """The folder of the checkout that `package` runs from, or None when it is installed."""
    root = package.parent
    return root if (root / "pyproject.toml").is_file() else None


def sessions_folder(package: Path = PACKAGE) -> Path:
    """The folder for journals: in a checkout that the user may write to, its `data/sessions`, else
    the user's data folder.

    This does not create it.
    """
    root = checkout(package)
    if root is not None and os.access(root, os.W_OK):
        return root / "data" / "sessions"
    from platformdirs import user_data_path

    return user_data_path("ana", appauthor=False) / "sessions"


def shortened(path: Path) -> str:
    """A path as it is shown: the home folder as `~`."""
    try:
        return str(Path("~") / path.relative_to(Path.home()))
    except (ValueError, RuntimeError):
        return str(path)


def reports_folder(package: Path = PACKAGE) -> Path:
    """The folder for reports of what failed, beside that for journals."""
    return sessions_folder(package).with_name("reports")
