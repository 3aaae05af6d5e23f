"""One row a mission, with its rescuer's knowledge group: what the questions about the coach's
behaviour start from."""

import pandas as pd

from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded

SHARES = ("share_c1", "share_c2", "share_c3")
KEPT = (
    *["participant", "adaptivity", "complexity", "building", "order", "victims"],
    *SHARES,
    *["switches", "mean_comprehension", "missteps", "disobeyed_in_round", "preset"],
)


def missions(recorded: Recorded, study: StudyData) -> pd.DataFrame:
    """The missions with a result of the people in `study`; columns `KEPT` and `knowledge`.

    Raises Refusal where the study has no knowledge groups.
    """
    return with_groups(recorded.of_missions("rounds"), study)[[*KEPT, "knowledge"]]


def with_groups(frame: pd.DataFrame, study: StudyData) -> pd.DataFrame:
    """The rows of the people in `study`, with their knowledge groups.

    Raises Refusal where the study has none.
    """
    study.need_groups()
    groups = study.participants["knowledge"].dropna()
    inside = frame[frame["participant"].isin(groups.index)]
    return inside.assign(knowledge=inside["participant"].map(groups)).reset_index(drop=True)
