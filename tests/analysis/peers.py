"""Other people's statistics to compare with.

Each is imported when it is first used: it takes a second, and every worker collects every file.
"""

from importlib import import_module
from typing import Any


class Later:
    """A module that is imported when something of it is asked for."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __getattr__(self, attribute: str) -> Any:
        return getattr(import_module(self.name), attribute)


pingouin = Later("pingouin")
smf = Later("statsmodels.formula.api")
sm_anova = Later("statsmodels.stats.anova")
sm_multitest = Later("statsmodels.stats.multitest")
sm_ordinal = Later("statsmodels.miscmodels.ordinal_model")
