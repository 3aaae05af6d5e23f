"""`ana serve`: free play in a browser on this computer."""

from __future__ import annotations

import webbrowser

import click

from game.commands.ana_study_web import web_extra

LOOPBACK = "127.0.0.1"


@click.command(name="serve")
@click.option("--port", type=click.IntRange(0, 65535), default=8080, show_default=True,
              help="The port; 0 takes a free one.")  # fmt: skip
@click.option("--no-browser", is_flag=True, help="Only print the address.")
def serve_play(port: int, *, no_browser: bool) -> None:
    """Play in a browser on this computer. Nobody else can reach it; Ctrl+C ends it."""
    with web_extra():
        from game.web.doors import PlayDoor
        from game.web.serving import serve

    def ready(address: str) -> None:
        click.echo(f"ana: play at {address} (Ctrl+C ends this)")
        if not no_browser:
            webbrowser.open(address)

    serve(PlayDoor(), LOOPBACK, port, ready=ready)
