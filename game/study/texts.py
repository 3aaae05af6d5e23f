"""What participants read and are asked: data files in the study folder, typed and checked."""

from __future__ import annotations

import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

import msgspec

from game.coach.acts import Level
from game.errors import AnaError
from game.forms.checks import told_apart
from game.forms.placeholders import check_placeholders
from game.forms.reading import Pages
from game.mission_words import MissionWords
from game.toml_words import NOT_UTF8, SAVE_AS_UTF8, in_plain_words, parted
from game.world.events import LevelWish

LATER_TEXTS = ("login", "no_place", "withdrawn", "cut_off", "level_key", "browser")
"""Tables that older texts.toml files lack: the shipped ones are used instead."""
LATER_WORDS = (
    "fault", "decline_title", "decline_text", "more_below", "too_long", "paste_too_long",
    "clock_stopped", "mission_goes_on", "leave_now", "mission",
    "mark", "write", "whole_number",
)  # fmt: skip
"""Small words that they lack."""


EARLIER_PAGES = {
    "mental_state": {"title": "", "body": "{instructor}"},
    "likert": {"title": "", "body": "{instructor}"},
    "check": {"title": "", "body": ""},
}
"""Pages that texts.toml had before forms had their own words, and what could be filled in."""


class TextsError(AnaError):
    """The file of texts cannot be used as it is."""


_COMPARE = "Compare the file with the one in a new study folder"


class _Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    pass


class Page(_Part, frozen=True):
    """A title and its text; blank lines separate paragraphs, and `**words**` are highlighted."""

    title: str
    body: str


class Consent(Page, frozen=True):
    agree: str
    decline: str

    def __post_init__(self) -> None:
        told_apart("the answers", self.agree, self.decline)


class InstructorNames(_Part, frozen=True):
    """Neutral names for the instructors of the first and the second round, who take turns."""

    first: str
    second: str

    def __post_init__(self) -> None:
        told_apart("the names of the instructors", self.first, self.second)

    def of(self, round_: int) -> str:
        """The instructor of a round, from 1."""
        return (self.first, self.second)[(round_ - 1) % 2]


class Lesson(Page, frozen=True):
    """A page of practice; with `map`, the practice building's map is shown beside it."""

    map: bool = False


class Lessons(_Part, frozen=True):
    """What practice explains: how to walk, and each of the ways instructors talk."""

    walking: Lesson
    steps: Lesson
    doors: Lesson
    names: Lesson

    def of(self, level: Level) -> Lesson:
        """The lesson about instructions of a level."""
        return {Level.C1: self.steps, Level.C2: self.doors, Level.C3: self.names}[level]


class Units(_Part, frozen=True):
    """Words for times."""

    minute: str
    minutes: str
    second: str
    seconds: str

    def time(self, ms: int) -> str:
        """A time in whole seconds, rounded up: `3 minutes`, `1 minute 5 seconds`."""
        minutes, seconds = divmod(-(-ms // 1000), 60)
        parts = [f"{minutes} {self.minute if minutes == 1 else self.minutes}"] if minutes else []
        if seconds or not minutes:
            parts.append(f"{seconds} {self.second if seconds == 1 else self.seconds}")
        return " ".join(parts)


class Login(_Part, frozen=True):
    """Asking for the participant's ID; `wrong` is the reply to something that is not an ID."""

    ask: str
    wrong: str


class CutOff(_Part, frozen=True):
    """Shown above the questions about something that was interrupted."""

    mission: str


class LevelKeyWords(_Part, frozen=True):
    """Where the level key is allowed: what is said of it before a mission, and shown for a moment
    when it is pressed."""

    text: str
    simpler: str
    shorter: str

    def of(self, want: LevelWish) -> str:
        """What is shown when it has been pressed."""
        return self.simpler if want == "simpler" else self.shorter


class ScreenWords(_Part, frozen=True):
    """The small words of the screens: what keys do, and what is left to do."""

    go_on: str
    scroll: str
    yes: str
    no: str
    choose: str
    move: str
    answer: str
    number: str
    next: str
    filter: str
    clear: str
    finish: str
    left: str
    still_open: str
    finish_title: str
    finish_text: str
    stop_title: str
    stop_text: str
    stop_yes: str
    stop_no: str
    decline_title: str
    decline_text: str
    more_below: str
    too_long: str
    paste_too_long: str
    goodbye: Page
    preflight: Page
    too_small: str
    clock_stopped: str
    mission_goes_on: str
    leave_now: str
    mark: str
    write: str
    whole_number: str
    size_fine: str
    press_keys: str
    keys_fine: str
    mission: MissionWords
    busy: Page
    trouble: Page
    fault: str


class BrowserPage(Page, frozen=True):
    """A page outside the program, and its button; without words for it, there is none."""

    button: str = ""


class BrowserWords(_Part, frozen=True):
    """What someone who takes part in a browser reads around the program."""

    wrong_link: BrowserPage
    too_small: BrowserPage
    full: BrowserPage
    interrupted: BrowserPage
    lost: BrowserPage
    elsewhere: BrowserPage
    idle: BrowserPage
    ended: BrowserPage
    finished: BrowserPage
    failed: BrowserPage


class Texts(_Part, frozen=True):
    """texts.toml."""

    version: str
    login: Login
    no_place: Page
    withdrawn: Page
    consent: Consent
    declined: Page
    practice: Page
    lessons: Lessons
    check_right: Page
    check_wrong: Page
    memorise: Page
    label: Page
    mission: Page
    cut_off: CutOff
    level_key: LevelKeyWords
    preference: Page
    reason: Page
    debrief: Page
    instructors: InstructorNames
    units: Units
    words: ScreenWords
    browser: BrowserWords
    check: Page | None = None
    mental_state: Page | None = None
    likert: Page | None = None

    @property
    def form_pages(self) -> Pages | None:
        """What the forms in items.toml of an earlier study stood on; in new studies each form in
        forms.toml has its own words."""
        if self.mental_state is None or self.likert is None or self.check is None:
            return None
        pages = self.mental_state, self.likert, self.check
        return Pages(*((page.title, page.body) for page in pages))


def filled(page: Page, **facts: str) -> Page:
    """The page with each `{name}` replaced by that fact; other braces stay."""
    title, body = page.title, page.body
    for name, fact in facts.items():
        title, body = title.replace(f"{{{name}}}", fact), body.replace(f"{{{name}}}", fact)
    return Page(title=title, body=body)


def preceded(page: Page, remark: str) -> Page:
    """The page with a highlighted remark above its text."""
    return Page(title=page.title, body=f"**{remark}**\n\n{page.body.strip()}")


def followed(page: Page, more: str) -> Page:
    """The page with another paragraph below its text."""
    return Page(title=page.title, body=f"{page.body.strip()}\n\n{more}")


def read_texts(path: Path) -> Texts:
    """Raises TextsError, naming the file and the key."""
    shipped = _shipped_tree()
    words = {name: shipped["words"][name] for name in LATER_WORDS}
    try:
        tree = {name: shipped[name] for name in LATER_TEXTS}
        tree |= tomllib.loads(path.read_text(encoding="utf-8-sig"))
        if isinstance(tree.get("words"), dict):
            tree["words"] = words | tree["words"]
        read = msgspec.convert(tree, Texts)
    except OSError as error:
        raise TextsError(
            f"the file cannot be read ({error.strerror})",
            place=str(path),
            hint="Copy the file from a new study folder",
        ) from error
    except UnicodeDecodeError as error:
        raise TextsError(NOT_UTF8, place=str(path), hint=SAVE_AS_UTF8) from error
    except tomllib.TOMLDecodeError as error:
        raise TextsError(f"this is not TOML: {error}", place=str(path), hint=_COMPARE) from error
    except msgspec.ValidationError as error:
        found, key = parted(str(error))
        place = f"{path}, {key.removeprefix('$.')}" if key.strip("$") else str(path)
        raise TextsError(in_plain_words(found), place=place, hint=_COMPARE) from error
    check_placeholders(tree, shipped | EARLIER_PAGES, str(path))
    return read


def shipped_texts() -> Texts:
    """The texts of a new study."""
    return msgspec.convert(_shipped_tree(), Texts)


def _shipped_tree() -> dict[str, Any]:
    shipped = resources.files("game.study") / "template" / "texts.toml"
    return tomllib.loads(shipped.read_text(encoding="utf-8"))
