"""`python -m game` is `ana`."""

import sys

from game.cli import main

sys.exit(main())
