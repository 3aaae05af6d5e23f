"""How much a visitor may send."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic


class TokenBucket:
    """Lets `per_second` through in the long run, and `burst` at once."""

    def __init__(
        self, per_second: float, burst: float, now: Callable[[], float] = monotonic
    ) -> None:
        self._per_second, self._burst, self._now = per_second, burst, now
        self._left, self._at = burst, now()

    def take(self, amount: float) -> bool:
        """Whether `amount` may pass; if it may not, nothing is taken."""
        now = self._now()
        self._left = min(self._burst, self._left + (now - self._at) * self._per_second)
        self._at = now
        if amount > self._left:
            return False
        self._left -= amount
        return True
