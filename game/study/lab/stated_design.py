"""What the texts of a new study say of the paper's design, and a study of another design still
says: a debriefing about an adaptive instructor where there is none."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator

import msgspec

from game.study.folder import TEXTS, Study
from game.study.languages import ENGLISH, Translation, languages
from game.study.study_settings import StudySettings
from game.study.texts import Texts, shipped_texts

_ADAPTIVE = ("ana", "knowledge", "knowledge+quiz")
"""Who changes the level by how somebody walks."""


def outdated(study: Study) -> Iterator[str]:
    """A sentence for each passage of the shipped texts that the study still has and its design
    contradicts, whatever shipped language it is in."""
    settings, texts = study.settings, study.texts
    for shipped in _all_shipped():
        for place, passage, untrue in _passages(shipped, settings):
            if untrue and passage in getattr(texts, place).body:
                yield f'{TEXTS}, {place}.body says "{passage}", but {untrue}: change the text'


def _all_shipped() -> Iterator[Texts]:
    """The texts of a new study in every language."""
    yield shipped_texts()
    for language in languages():
        if language != ENGLISH:
            tree = tomllib.loads(Translation(language).texts[TEXTS])
            yield msgspec.convert(tree, Texts)


def _passages(shipped: Texts, settings: StudySettings) -> Iterator[tuple[str, str, str]]:
    """Page and passage of the shipped texts, and what of a design makes it untrue, if anything."""
    first, again = shipped.consent.body.strip().split(";")[:2]
    done = ",".join(first.rpartition(".")[2].split(",")[:2]).strip()
    left_out = [it for it in ("memorise", "label") if it not in settings.round_phases]
    yield "consent", done, f"round_phases has no {' and no '.join(left_out)}" if left_out else ""
    rounds = f"rounds is {settings.rounds}" if settings.rounds != 2 else ""
    yield "consent", again.partition(".")[0].strip(), rounds
    differed = re.split(r"(?<=\.)\s+", shipped.debrief.body.strip())[1]
    yield "debrief", differed, _not_one_that_adapts(settings)


def _not_one_that_adapts(settings: StudySettings) -> str:
    """Why the debriefing of the paper's study is untrue; empty where it is not."""
    if settings.rounds < 2:
        return "rounds is 1, so that everybody met one instructor"
    kinds = sorted(it.kind for it in settings.pair)
    if any(kinds == sorted(("static", kind)) for kind in _ADAPTIVE):
        return ""
    names = settings.instructors or ("static", settings.coach)
    return f"the instructors are {' and '.join(names)}"
