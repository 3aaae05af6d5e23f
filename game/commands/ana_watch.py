"""`ana watch`: watch a simulated rescuer play a mission."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from game.commands.ana_play import mission_options, options_of
from game.commands.offered import offering, rescuers
from game.rescuers.catalogue import LITERAL, RESCUERS, character
from game.screens.play.app import run_watch


@click.command(name="watch")
@mission_options
@click.option(
    "--rescuer",
    default=LITERAL,
    show_default=True,
    metavar="NAME",
    shell_complete=offering(rescuers),
    help="Who plays: " + "; ".join(f"{who.name}, {who.summary}" for who in RESCUERS.values()) + ".",
)
def watch(rescuer: str, **given: Any) -> int:
    """Watch a simulated rescuer play a mission."""
    return run_watch(replace(options_of(**given), rescuer=character(rescuer).name))
