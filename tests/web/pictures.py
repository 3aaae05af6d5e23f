"""`python -m tests.web.pictures FOLDER`: what a participant sees in Chromium, phase by phase."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from PIL import Image

from game.study.folder import Identity, Study, new_study, open_study
from tests.study.participant import TerminalParticipant
from tests.study.people import cut_off
from tests.study.pictures import COLOURS, PHASES, SETTLE_S
from tests.web.chromium import Chromium, Tab, Wire
from tests.web.served import Served


def take_pictures(folder: Path) -> None:
    """Write the pictures to `folder`, as browser-PHASE.png."""
    with tempfile.TemporaryDirectory() as place:
        new_study(Path(place) / "study", seed=1)
        study = open_study(Path(place) / "study")
        with Served(study) as server, Chromium() as chromium:
            for number, phase in enumerate(PHASES):
                identity = Identity("live", f"P{number:02}")
                cut_off(study, identity, at=phase.at, since=phase.since, times=phase.times)
                tab = chromium.tab()
                tab.open(server.link(identity.participant))
                tab.wait_for(phase.title(study.texts))
                tab.read_for(SETTLE_S)
                phase.go(TerminalParticipant(tab, study, identity))
                _save(tab, folder, phase.name)
                tab.close()
            _first_pages(study, server, chromium, folder)
            _notices(study, server, chromium, folder)


def _first_pages(study: Study, server: Served, chromium: Chromium, folder: Path) -> None:
    """What nothing can be cut off at, since nothing is recorded before consent."""
    tab = chromium.tab()
    tab.open(server.link("P50"))
    person = TerminalParticipant(tab, study, Identity("live", "P50"))
    person.preflight()
    _save(tab, folder, "consent")
    person.consent()
    _save(tab, folder, "practice")
    tab.close()


def _notices(study: Study, server: Served, chromium: Chromium, folder: Path) -> None:
    """What the page itself says."""
    words, finished = study.texts.browser, f"P{len(PHASES) - 1:02}"
    tab = chromium.tab()
    tab.open(f"{server.address}?link=wrong")
    _save(tab, folder, "wrong-link")
    tab.open(server.link(finished))
    tab.wait_for(study.texts.debrief.title)
    tab.read_for(1)
    tab.press("enter")
    tab.wait_for_notice(words.finished.title)
    _save(tab, folder, "finished")
    tab.close()
    with Wire(server.port) as wire:
        tab = chromium.tab()
        tab.open(server.link("P51").replace(server.address, wire.address))
        tab.wait_for("arrow keys")
        wire.cut()
        tab.wait_for_notice(words.interrupted.title)
        _save(tab, folder, "interrupted")
        tab.close()


def _save(tab: Tab, folder: Path, name: str) -> None:
    tab.read_for(SETTLE_S)
    path = folder / f"browser-{name}.png"
    tab.picture(path)
    Image.open(path).convert("RGB").quantize(COLOURS).save(path, optimize=True)


if __name__ == "__main__":
    take_pictures(Path(sys.argv[1]))
