"""Knowledge groups of an analysed sample: as the source states them, or formed from its scores."""

import pandas as pd

from analysis.sources.absent import Absent, Refusal, attempt
from analysis.sources.factors import KNOWLEDGE
from analysis.sources.frames import StudyData, missing_notes
from analysis.stats.clustering import Clustering, knowledge_groups
from analysis.stats.power import EVEN


def clustering_of(study: StudyData) -> Clustering:
    """Cluster the static round's quiz scores. Raises Refusal without scores to cluster."""
    if not study.has("quiz_static"):
        raise Refusal("the source has no quiz scores")
    scores = study.participants["quiz_static"].dropna()
    return knowledge_groups({str(who): float(score) for who, score in scores.items()})


def grouped(study: StudyData) -> tuple[StudyData, Clustering | Absent]:
    """The study with knowledge groups, and the clustering of its scores.

    Groups that the source states are kept, and a note names the people whom the scores would place
    elsewhere; a source that states none gets the groups of its scores. Notes name the people who
    lack a round or a group.
    """
    study, clustering = _formed(study.noted(*missing_notes(study)))
    if study.has("knowledge"):
        without = study.participants.index[study.participants["knowledge"].isna()]
        if len(without):
            study = study.noted(
                "no knowledge group, for want of a quiz score before the static mission or of a "
                f"stated group: {', '.join(map(str, without))}"
            )
    return study, clustering


def _formed(study: StudyData) -> tuple[StudyData, Clustering | Absent]:
    clustering = attempt(clustering_of, study)
    if isinstance(clustering, Absent):
        return study, clustering
    formed = pd.Series(clustering.labels, dtype=object)
    if not study.has("knowledge"):
        told = clustering.note()
        study = study.with_groups(formed)
        return (study.noted(told) if told else study), clustering
    stated = study.participants["knowledge"].dropna()
    both = stated.index.intersection(formed.index)
    moved = [str(who) for who in both if stated[who] != formed[who]]
    if moved:
        study = study.noted(
            f"the quiz scores would place {len(moved)} of {len(both)} participants in another "
            f"knowledge group than the source states, which is kept: {', '.join(moved)}"
        )
    return study, clustering


def group_shares(study: StudyData) -> tuple[float, ...]:
    """The shares of LOW, MED and HIGH; even ones where the study has no groups."""
    if not study.has("knowledge"):
        return EVEN
    sizes = study.participants["knowledge"].value_counts().reindex(list(KNOWLEDGE)).fillna(0)
    return tuple(float(share) for share in sizes / sizes.sum())
