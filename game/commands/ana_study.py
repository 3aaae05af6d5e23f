"""`ana study`: set up a study, let participants in and out, watch it, export its data."""

from __future__ import annotations

import getpass
import sys
from pathlib import Path

import click
import msgspec

from game.errors import STATUS_TROUBLE, AnaError
from game.journal.records import STUDY_MODES, StudyMode
from game.lazy import LazyGroup


def _red(line: str) -> None:
    click.secho(line, fg="red", err=True)


def _as_its_owner(ctx: click.Context, _param: click.Parameter, folder: Path) -> Path:
    """Refuse another account than the folder's owner."""
    from game.study.folder import refuse_other_accounts

    refuse_other_accounts(folder, f"{ctx.command_path} {folder} ...")
    return folder


_FOLDER = click.argument(
    "folder", metavar="DIR", type=click.Path(path_type=Path), callback=_as_its_owner
)
_ANY_FOLDER = click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
"""Where a participant is at the terminal: what fails, this check included, is shown on a page."""
_PARTICIPANT = click.argument("participant", metavar="ID")
_PILOT = click.option("--pilot", is_flag=True, help="Try the study without taking a place in it.")
STATUS_WRONG = 1
_UNBLINDED = (
    "The study is still open, and this shows who was allocated what: the ledger now records that "
    "it was unblinded."
)
_UNBLINDS = (
    "The study is still open. An export of live sessions shows who was allocated what, so the "
    "ledger will record that the study was unblinded."
)
_ELSEWHERE = (
    "Datasets exported before, and backups, still have them: delete those, or make them again."
)


@click.group(name="study", cls=LazyGroup)
def study_group() -> None:
    """Run the experiment. A study lives in a folder."""


@study_group.command("new", short_help="Create a study folder.")
@_FOLDER
@click.option("--seed", type=int, help="Decides who is allocated what.  [default: random]")
@click.option("--blocks", type=click.IntRange(1), default=5, show_default=True,
              help="How many blocks of 24 places the study has.")  # fmt: skip
@click.option("--language", default="en", show_default=True, metavar="CODE",
              help="The language of everything participants read: en or de.")  # fmt: skip
def make_study(folder: Path, seed: int | None, blocks: int, language: str) -> None:
    """Create the study folder DIR, with settings and texts to check before you begin."""
    from game.forms.reading import FORMS
    from game.study.folder import SETTINGS, TEXTS, new_study

    new_study(folder, seed, blocks, language=language)
    click.echo(
        f"{folder}: new study created. Edit {SETTINGS}, {TEXTS} and {FORMS}, then try it:\n"
        f"  ana study check {folder}\n"
        f"  ana study run {folder} --participant TEST --pilot"
    )
    if language != "en":
        click.echo("This is a first translation: let a native speaker read it before you use it.")


@study_group.command("design", short_help="Show what is crossed, and what it can find.")
@_FOLDER
def print_design(folder: Path) -> None:
    """Print the design of the study DIR: design cells, how often each comes, the power for the
    primary outcomes, and which of the paper's tests it supports. Nobody's allocation is shown."""
    from game.study.folder import open_study
    from game.study.lab.design_text import design_lines

    study = open_study(folder)
    for line in design_lines(study.settings, study.forms):
        click.echo(line)


@study_group.command("forms", short_help="Print ready forms to copy from.")
@click.argument("name", required=False, metavar="[NAME]")
@click.option("--language", default="en", show_default=True, metavar="CODE",
              help="The language of the form: en or de.")  # fmt: skip
def print_form(name: str | None, language: str) -> None:
    """List the ready forms, or print one of them.

    To ask it in a study: ana study forms NAME >> DIR/forms.toml
    """
    from game.study.ready import ready_names, ready_text, summary

    if name is not None:
        click.echo(ready_text(name, language), nl=False)
        return
    width = max(map(len, ready_names()))
    for one in ready_names():
        click.echo(f"{one.ljust(width)}  {summary(one)}")


@study_group.command("demo", short_help="Make a study half-way through, to try things on.")
@_FOLDER
@click.option("--participants", type=click.IntRange(6, 480), default=48, show_default=True,
              metavar="N", help="How many simulated people have come.")  # fmt: skip
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True,
              help="Seed for everything.")  # fmt: skip
def make_demonstration(folder: Path, participants: int, seed: int) -> None:
    """Make the study DIR with simulated people in it, about half of whose places are taken.

    Try status, export, the analysis and the notebooks on it, and take part in it yourself. It takes
    about a minute.
    """
    from game.commands.ana_study_demo import demonstration

    demonstration(folder, participants, seed)


@study_group.command("run", short_help="Let a participant take part here.")
@_ANY_FOLDER
@click.option("--participant", required=True, metavar="ID", help="A pseudonym, such as P01.")
@_PILOT
def run_participant(folder: Path, participant: str, pilot: bool) -> int:
    """Let participant ID take part at this terminal, or resume an earlier session."""
    from game.commands.ana_study_terminal import take_part_here

    return take_part_here(folder, participant, pilot=pilot)


@study_group.command("check", short_help="Try everything before the first participant.")
@_FOLDER
@click.option("--pictures", type=click.Path(path_type=Path), metavar="OUT",
              help="Write a picture of every page, and one page with all, to OUT.")  # fmt: skip
def check_study(folder: Path, pictures: Path | None) -> int:
    """Open every page of the study DIR at its size, and try the folder, the disk and the settings.

    Exit status 2 where something would go wrong. Notes name what the texts say of times and of the
    design that study.toml contradicts.
    """
    from game.screens.study.pictures import write_pictures
    from game.screens.study.rehearsal import found_wrong
    from game.study.folder import open_study
    from game.study.lab.stated_design import outdated
    from game.study.lab.stated_times import contradicted

    study = open_study(folder)
    wrong, pages = found_wrong(study, pictures=pictures is not None)
    if pictures is not None:
        click.echo(f"{write_pictures(pages, study.settings.name, pictures)}: {len(pages)} pages")
    doubts = [*contradicted(study), *outdated(study)]
    for note in (*study.notes, *doubts):
        click.echo(f"note: {note}")
    for one in wrong:
        _red(one)
    size = study.settings.screen
    if not wrong:
        well = "nothing is wrong but for what the notes say" if doubts else "all is well"
        click.echo(f"{folder}: {len(pages)} pages at {size.columns} x {size.rows}; {well}")
    return STATUS_TROUBLE if wrong else 0


@study_group.command("status", short_help="Show where everyone is, and problems.")
@_FOLDER
@click.option("--watch", is_flag=True, help="Keep the status on the screen; Q quits.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option(
    "--unblind", is_flag=True, help="Also show counts by design cell; the ledger records it."
)
def print_status(folder: Path, *, watch: bool, as_json: bool, unblind: bool) -> int:
    """Show where every participant of the study DIR is, and any problems.

    Changes nothing, and does not reveal anyone's allocation. Exit status 1 where something keeps
    people from logging in, or does not belong in the folder.
    """
    from game.study.lab.status_text import HINDRANCES, page
    from game.study.lab.study_status import StatusReader, breakdown
    from game.tables.exclusions import read_rules

    if watch:
        if as_json or unblind:
            raise click.UsageError("--watch cannot be combined with --json or --unblind.")
        from game.screens.lab.status_screen import watch_status

        return watch_status(folder)
    now = StatusReader(folder).look()
    shown = unblind or now.closed
    why = "ana study status --unblind"
    cells = breakdown(folder, read_rules().rule, why) if shown else ()
    if as_json:
        tree = msgspec.to_builtins(now) | ({"design_cells": cells} if shown else {})
        click.echo(msgspec.json.format(msgspec.json.encode(tree), indent=2))
    else:
        wrong = {f"  {hindrance}" for hindrance in now.hindrances} | {HINDRANCES}
        for line in page(now, cells):
            click.echo(click.style(line, fg="red", bold=True) if line in wrong else line)
    return STATUS_WRONG if now.hindrances else 0


@study_group.command("amend", short_help="Record a change of settings, texts or buildings.")
@_FOLDER
@click.option("--why", required=True, metavar="TEXT", help="The reason, kept in the ledger.")
def amend_settings(folder: Path, why: str) -> None:
    """Record that something was changed after the first participant, and why.

    That is study.toml, texts.toml, forms.toml, instructions.toml or a building. Until then nobody
    can log in.
    """
    from game.study.folder import amend

    changed = ", ".join(amend(folder, why))
    click.echo(f"{folder}: change of {changed} recorded; sessions continue with what is there now")


@study_group.command("drop", short_help="Record a drop-out; data are kept.")
@_FOLDER
@_PARTICIPANT
def drop_participant(folder: Path, participant: str) -> None:
    """Record that participant ID dropped out; their data are kept."""
    from game.study.folder import identify, open_study
    from game.study.lab.leaving import drop_out

    study = open_study(folder)
    drop_out(study, identify(participant))
    refilled = study.settings.refill_dropouts
    place = "will be given to someone else" if refilled else "stays empty"
    click.echo(f"{participant} dropped out; the place {place} (refill_dropouts in study.toml)")


@study_group.command("withdraw", short_help="Delete a participant's data.")
@_FOLDER
@_PARTICIPANT
@click.option("--pilot", is_flag=True, help="Withdraw a pilot session.")
@click.option("--yes", is_flag=True, help="Do not ask; for scripts.")
def withdraw_participant(folder: Path, participant: str, *, pilot: bool, yes: bool) -> None:
    """Delete everything recorded about participant ID, after asking.

    The ledger keeps that they withdrew, and which place they had.
    """
    from game.study.folder import identify, open_study
    from game.study.lab.leaving import recorded, withdraw

    study, identity = open_study(folder), identify(participant, pilot=pilot)
    told = recorded(study, identity).told()
    if not yes:
        if not sys.stdin.isatty():
            raise AnaError(
                "withdrawing deletes data, and nobody can be asked here",
                place=f"ana study withdraw {participant}",
                hint="Give --yes",
            )
        click.echo(f"{participant} ({identity.mode}): {told}")
        click.confirm("Delete everything recorded about them?", abort=True)
    deleted = withdraw(study, identity)
    data = "their data are deleted" if deleted else "nothing had been recorded"
    click.echo(f"{participant} has withdrawn; {data}")
    if deleted:
        click.echo(_ELSEWHERE)


@study_group.command("data", short_help="Give one participant their own data.")
@_FOLDER
@_PARTICIPANT
@click.argument("out", metavar="OUT", type=click.Path(path_type=Path))
@click.option("--pilot", is_flag=True, help="The data of a pilot session.")
def give_data(folder: Path, participant: str, out: Path, *, pilot: bool) -> None:
    """Write everything recorded about participant ID to the new folder OUT.

    That is their whole journal, and its tables with a codebook.
    """
    from game.study.folder import identify, open_study
    from game.study.lab.own_data import write_own_data

    count = write_own_data(open_study(folder), identify(participant, pilot=pilot), out)
    click.echo(f"{out}: {count} files with everything recorded about {participant}")


@study_group.command("close", short_help="End recruiting.")
@_FOLDER
def close_study(folder: Path) -> None:
    """End recruiting in the study DIR: no more places are given out.

    Anyone who has a place can finish. Everyone else is told that no place is left: newcomers when
    they log in, people in consent or practice when practice ends. From now on the status may show
    counts by design cell.
    """
    from game.study.folder import open_study

    open_study(folder).ledger.close()
    click.echo(
        f"{folder}: closed. Anyone who has a place can finish. Everyone else is told that no place "
        "is left: newcomers when they log in, people in consent or practice when practice ends"
    )


@study_group.command("export", short_help="Write a Psych-DS dataset.")
@_FOLDER
@click.argument("out", metavar="OUT", type=click.Path(path_type=Path))
@click.option(
    "--mode",
    "modes",
    type=click.Choice(STUDY_MODES),
    multiple=True,
    default=("live",),
    show_default=True,
    help="Which sessions to export; repeatable. Each mode has its own files.",
)
@click.option("--without", metavar="ID", multiple=True,
              help="Leave this session out, and say so in the dataset; repeatable.")  # fmt: skip
@click.option("--anonymous", is_flag=True,
              help="Other pseudonyms and dates, and no answers in their own words.")  # fmt: skip
@click.option("--yes", is_flag=True, help="Do not ask before an open study is unblinded.")
def write_dataset(
    folder: Path,
    out: Path,
    modes: tuple[StudyMode, ...],
    *,
    without: tuple[str, ...],
    anonymous: bool,
    yes: bool,
) -> None:
    """Write the study DIR to the folder OUT as a Psych-DS dataset with a codebook.

    An earlier export in OUT is replaced. Exporting the live sessions of an open study unblinds it,
    which the ledger records: at a terminal you are asked first.
    """
    from game.study.lab.export import export_study, unblinds

    if not yes and sys.stdin.isatty() and unblinds(folder, modes):
        click.echo(_UNBLINDS)
        click.confirm("Export all the same?", abort=True)
    done = export_study(folder, out, modes, without=without, anonymous=anonymous)
    for mode, sessions in done.sessions.items():
        click.echo(f"{out}: {mode} sessions {sessions}, rounds {done.rounds[mode]}")
    for mode in done.dropped:
        click.echo(f"{out}: the earlier export had {mode} sessions too, and was replaced", err=True)
    if done.unblinded:
        click.echo(_UNBLINDED, err=True)


@study_group.command("sshd", short_help="Print the SSH server's configuration.")
@_FOLDER
@click.option("--account", help="The participants' account.  [default: the owner of DIR]")
@click.option("--port", type=click.IntRange(1, 65535), help="The port of a local test server.")
@click.option("--keys", type=click.Path(path_type=Path), help="The folder of that server's keys.")
@click.option("--check/--no-check", "check", default=True, show_default=True,
              help="Also tell what `ana study check` finds wrong.")  # fmt: skip
def print_ssh_configuration(
    folder: Path, account: str | None, port: int | None, keys: Path | None, *, check: bool
) -> None:
    """Print the OpenSSH configuration that lets participants into the study DIR.

    With --port and --keys: the configuration of a test server on this machine alone. What
    `ana study check` finds wrong is told on the error stream.
    """
    from game.screens.study.rehearsal import found_wrong
    from game.study.folder import open_study
    from game.study.lab.sshd import LoopbackServer, configuration, program

    if (port is None) is not (keys is None):
        raise click.UsageError("Give --port and --keys together.")
    study = open_study(folder)
    loopback = None if port is None or keys is None else LoopbackServer(port, keys)
    user = account or (folder.owner() if loopback is None else getpass.getuser())
    click.echo(configuration(folder, user, program(), loopback), nl=False)
    for one in found_wrong(study)[0] if check else ():
        _red(f"{folder}: {one}")


@study_group.command("serve", short_help="Let participants in with a browser.")
@_FOLDER
@click.option("--host", default="127.0.0.1", show_default=True,
              help="The address to listen on; your own proxy adds TLS.")  # fmt: skip
@click.option("--port", type=click.IntRange(0, 65535), default=8080, show_default=True,
              help="The port; 0 takes a free one.")  # fmt: skip
@click.option("--url", help="The address that participants use, where a proxy stands before this.")
@click.option("--sessions", type=click.IntRange(1), default=40, show_default=True,
              help="How many may take part at once.")  # fmt: skip
def serve_browsers(folder: Path, host: str, port: int, url: str | None, sessions: int) -> None:
    """Let participants take part in the study DIR with a browser; Ctrl+C ends it.

    Each of them comes with a link of their own (ana study invite) or with a panel's ID. Everybody
    who is in the study when it ends can come back later and continues.
    """
    from game.commands.ana_study_web import serve_study

    serve_study(folder, host, port, url, sessions)


@study_group.command("invite", short_help="Print links for a browser.")
@_FOLDER
@click.argument("participants", metavar="ID...", nargs=-1, required=True)
@click.option("--url", help="The address that participants use, as `ana study serve` prints it.  "
              "[default: http://localhost:8080/]")  # fmt: skip
@click.option("--panel", is_flag=True,
              help="The IDs are a panel's: print what they are called in the study.")  # fmt: skip
@_PILOT
def print_invitations(
    folder: Path, participants: tuple[str, ...], url: str | None, *, panel: bool, pilot: bool
) -> None:
    """Print each participant ID and a link that opens that participant's session.

    The links are signed with a key in the study folder, so nobody can make one for another ID.
    """
    from game.commands.ana_study_web import print_links

    print_links(folder, participants, url, pilot=pilot, panel=panel)


@study_group.command("login", short_help="What the SSH server runs for a participant.")
@_ANY_FOLDER
@_PILOT
def let_in(folder: Path, *, pilot: bool) -> int:
    """Let the person who logged in over SSH take part in the study DIR (run by the server).

    The ID comes from the SSH key, or is asked for. If something goes wrong, the participant reads
    it in the study's own words; the system log has the details and how to fix it.
    """
    from game.commands.ana_study_terminal import let_in_over_ssh

    return let_in_over_ssh(folder, pilot=pilot)


def record_analysis(folder: Path) -> str:
    """Record that `ana analyse` reads live data, which unblinds an open study; returns what to
    tell the user. A ledger that cannot be written stops nobody from analysing their copy."""
    from game.study.folder import LEDGER
    from game.study.ledger import Ledger, LedgerError

    try:
        return f"{_UNBLINDED}\n" if Ledger(folder / LEDGER).unblind("ana analyse") else ""
    except LedgerError as error:
        return (
            f"If the study is still open, this unblinds it; that could not be recorded: {error}\n"
        )
