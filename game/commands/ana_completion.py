"""`ana completion`: the script that lets a shell complete `ana` commands."""

from __future__ import annotations

import os
from pathlib import Path

import click
from click.shell_completion import get_completion_class

from game.errors import AnaError

SHELLS = ("bash", "zsh", "fish")
COMPLETION_VARIABLE = "_ANA_COMPLETE"


@click.command("completion")
@click.argument("shell", type=click.Choice(SHELLS), required=False)
@click.pass_context
def completion_command(ctx: click.Context, shell: str | None) -> None:
    """Print the completion script for SHELL (default: the one in $SHELL).

    \b
    bash:  echo 'eval "$(ana completion bash)"' >> ~/.bashrc
    zsh:   echo 'eval "$(ana completion zsh)"' >> ~/.zshrc
    fish:  ana completion fish > ~/.config/fish/completions/ana.fish
    """
    chosen = shell or Path(os.environ.get("SHELL", "")).name
    if chosen not in SHELLS:
        raise AnaError(
            f"there is no completion for the shell '{chosen}'",
            place="completion",
            hint="Give one: ana completion bash, zsh or fish.",
        )
    script = get_completion_class(chosen)
    assert script is not None
    click.echo(script(ctx.find_root().command, {}, "ana", COMPLETION_VARIABLE).source())
