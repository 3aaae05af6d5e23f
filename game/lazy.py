"""Commands that are listed by name and imported only when they run."""

from __future__ import annotations

from importlib import import_module
from typing import cast

import click

from game.errors import AnaError

OURS = ("analysis", "game")


class LazyCommand(click.Command):
    """A name and a summary; the command itself is imported only when it runs.

    `target` is `module:attribute`; the attribute is a `click.Command` whose function returns its
    exit status (None means 0). `section` is the heading that it is listed under.
    """

    def __init__(self, name: str, target: str, summary: str, section: str = "Commands") -> None:
        super().__init__(name, short_help=summary)
        self.target = target
        self.section = section

    def load(self) -> click.Command:
        """The command behind the name. Raises AnaError if a package it needs is missing."""
        module, _, attribute = self.target.partition(":")
        try:
            return cast(click.Command, getattr(import_module(module), attribute))
        except ModuleNotFoundError as error:
            raise _not_installed(error, self.name) from error


def _not_installed(error: ModuleNotFoundError, command: str | None) -> Exception:
    """What to raise where a package is missing: the error itself if it is one of ours."""
    missing = error.name or ""
    if missing.partition(".")[0] in ("", *OURS):
        return error
    return AnaError(
        f"this command needs the Python package {missing}, which is not installed",
        place=f"ana {command}",
        hint="In the source folder run `make test`, which installs everything, or "
        "`pip install --require-hashes --requirement requirements/all.txt`",
    )


class LazyGroup(click.Group):
    """A group that imports only the subcommand it runs, and lists its subcommands in order, by
    sections.

    A subcommand imports what not everybody has when it runs, so that its help can be read without.
    """

    def invoke(self, ctx: click.Context) -> object:
        try:
            return super().invoke(ctx)
        except ModuleNotFoundError as error:
            raise _not_installed(error, ctx.invoked_subcommand) from error

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        sections: dict[str, list[tuple[str, str]]] = {}
        longest = max(map(len, self.commands))
        for name, command in self.commands.items():
            section = command.section if isinstance(command, LazyCommand) else "Commands"
            row = f"{name:<{longest}}", command.get_short_help_str(formatter.width)
            sections.setdefault(section, []).append(row)
        for section, rows in sections.items():
            with formatter.section(section):
                formatter.write_dl(rows)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name, command, rest = super().resolve_command(ctx, args)
        return name, command.load() if isinstance(command, LazyCommand) else command, rest
