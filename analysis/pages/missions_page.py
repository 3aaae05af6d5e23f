"""One page in which a point leads to the person: a scatter of all missions, and a replay of the
chosen one. It is one file, and loads nothing."""

import json
import math
from pathlib import Path

from analysis.sources.absent import Plain
from analysis.sources.frames import StudyData
from analysis.sources.replays import Replays

TEMPLATE = Path(__file__).with_name("missions.html")


def missions_html(replays: Replays, study: StudyData) -> str:
    """The page; `study` is the analysed sample, which gives groups and answers. People who are not
    in it are left out."""
    people = study.participants
    rounds = study.by_round
    missions = []
    for mission in replays.missions:
        who, adaptivity = str(mission["participant"]), str(mission["adaptivity"])
        if who not in people.index:
            continue
        scores: dict[str, Plain] = {"quiz": None}
        if study.has("quiz_static"):
            scores["quiz"] = _known(people.loc[who, "quiz_static"])
        for outcome in study.outcomes:
            scores[outcome] = _known(rounds.loc[who, (outcome, adaptivity)])
        group = people.loc[who, "knowledge"] if study.has("knowledge") else None
        known: Plain = group if isinstance(group, str) else None
        missions.append(mission | {"scores": scores, "knowledge": known})
    data = {
        "label": study.label,
        "simulated": study.simulated,
        "measures": ["quiz", *study.outcomes],
        "buildings": replays.buildings,
        "missions": missions,
    }
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return TEMPLATE.read_text(encoding="utf-8").replace("DATA", text.replace("</", "<\\/"), 1)


def _known(value: object) -> float | None:
    number = float(str(value))
    return number if math.isfinite(number) else None
