"""The coaches that come with `ana`, one module a kind; `game.coach.registry` lists them."""
