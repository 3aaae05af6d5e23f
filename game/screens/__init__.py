"""The screens: the only place that knows a terminal.

Textual reads its environment when it is imported, so it is set here, before any of that happens:
no paint waits longer than 1/60 s for the frame limiter, an arrow key whose bytes a slow link splits
by less than half a second stays one key, and no other colours are sent than `terminal` says.
"""

from __future__ import annotations

import os

from game.screens.widgets.terminal import colour_system

os.environ["TEXTUAL_COLOR_SYSTEM"] = colour_system(os.environ)
os.environ.setdefault("TEXTUAL_FPS", "120")
os.environ.setdefault("ESCDELAY", "500")
