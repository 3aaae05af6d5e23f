"""forms.toml: typed, what is wrong in it is named, and items.toml is read as one."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.errors import AnaError
from game.forms.form import Forms, shown
from game.forms.items import ChoiceItem, Condition, HeadingItem, ScaleItem, SliderItem
from game.forms.reading import FormsError, forms_in, paper_forms, paper_text, read_forms
from game.study.protocol.conduct import items_in_order
from game.study.ready import PAPER, ready_forms, ready_names
from game.study.texts import read_texts

EARLIER = Path(__file__).parents[1] / "data" / "earlier_study"
FORM = """
version = "1"
[[form]]
id = "mood"
place = "before"
answers = ["no", "yes"]
[[form.item]]
kind = "scale"
id = "well"
text = "Are you well?"
[[form.item]]
kind = "slider"
id = "warm"
text = "How warm is it?"
low = "cold"
high = "hot"
reverse = true
shown_when = { item = "well", is = 2 }
[[form.composite]]
id = "state"
items = ["warm"]
"""


def read(text: str) -> Forms:
    return forms_in(tomllib.loads(text), "forms.toml")


def test_a_form_is_typed_and_its_scales_have_its_answers() -> None:
    (form,) = read(FORM).forms
    well, warm = form.questions
    assert isinstance(well, ScaleItem)
    assert well.anchors == ("no", "yes")
    assert isinstance(warm, SliderItem)
    assert (warm.least, warm.most, warm.scored(1), warm.scored(100)) == (1, 100, 100, 1)
    assert form.phase("before") == "mood"


@pytest.mark.parametrize(
    ("was", "becomes", "told"),
    [
        ('kind = "scale"', 'kind = "scalle"', r"form 1 \(mood\), item 1 \(well\).*Did you mean"),
        ('text = "How', 'txt = "How', r"item 2 \(warm\).*no key `txt`.*Did you mean text"),
        ('place = "before"', 'place = "befor"', r"form 1 \(mood\), place.*'befor'.*after practice"),
        ('place = "before"', 'plce = "before"', r"form 1 \(mood\).*Did you mean place"),
        ('id = "warm"', 'id = "well"', "two items have the id well"),
        ('id = "mood"', 'id = "label"', "label is a phase of the study"),
        ('id = "state"', 'id = "well"', "two items have the id well"),
        ('items = ["warm"]', 'items = ["cold"]', "counts cold"),
        ("is = 2", "is = 3", "its answers go from 1 to 2"),
        ('item = "well"', 'item = "warm"', "no earlier item has this id"),
        (", is = 2", "", "give is, at_least or at_most"),
        ('["no", "yes"]', '["no", "no"]', "the answers must differ"),
        ('answers = ["no", "yes"]', "", "well must have from 2 to 40 answers, not 0"),
        (
            "Are you well?",
            "Are you well, {instructor}?",
            r"mood, item well: there is no \{inst",
        ),
        ("reverse = true", "reverse = true\nright = 101", "right must be between 1 and 100"),
        ("reverse = true", 'role = "attention"', "needs its right answer"),
        ("reverse = true", "from = 100", "from must be below to"),
        ("reverse = true", 'role = "mood"', r"item 2 \(warm\), role.*'mood'"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(was: str, becomes: str, told: str) -> None:
    assert was in FORM
    with pytest.raises(AnaError, match=told) as refused:
        read(FORM.replace(was, becomes, 1))
    assert "forms.toml" in str(refused.value)


@pytest.mark.parametrize("text", ["version = ", "version = 1", "", "[[forms]]", "form = 3"])
def test_other_toml_is_refused_without_a_traceback(tmp_path: Path, text: str) -> None:
    (tmp_path / "forms.toml").write_text(text)
    with pytest.raises(FormsError, match=r"forms\.toml"):
        read_forms(tmp_path, None)


def test_items_of_an_earlier_study_are_the_papers_forms() -> None:
    texts = read_texts(EARLIER / "texts.toml")
    old = read_forms(EARLIER, texts.form_pages)
    new = paper_forms()
    assert "items.toml" in old.note
    for earlier, later in zip(old.forms.forms, new.forms, strict=True):
        assert earlier.questions == later.questions
        assert (earlier.id, earlier.place, earlier.order) == (later.id, later.place, later.order)
        assert (earlier.title, earlier.body.strip()) == (later.title, later.body.strip())


def test_two_files_of_questions_are_one_too_many(tmp_path: Path) -> None:
    (tmp_path / "items.toml").write_text((EARLIER / "items.toml").read_text())
    (tmp_path / "forms.toml").write_text(paper_text())
    with pytest.raises(FormsError, match=r"items\.toml as well"):
        read_forms(tmp_path, None)


@pytest.mark.parametrize("name", ready_names())
def test_a_german_form_asks_what_the_english_one_asks(name: str) -> None:
    for there, here in zip(ready_forms(name).forms, ready_forms(name, "de").forms, strict=True):
        assert (there.id, there.places, there.order) == (here.id, here.places, here.order)
        for one, other in zip(there.questions, here.questions, strict=True):
            assert (one.id, one.role, one.rights) == (other.id, other.role, other.rights)
            assert (one.least, one.most) == (other.least, other.most)
            assert one.shown_when == other.shown_when
            assert one.text != other.text
        assert [it.items for it in there.composites] == [it.items for it in here.composites]


def test_a_language_that_there_is_not_is_refused() -> None:
    with pytest.raises(AnaError, match="no translation 'fr'"):
        ready_forms("sus", "fr")


@pytest.mark.parametrize("name", ready_names())
def test_a_ready_form_can_be_copied_into_a_study(name: str) -> None:
    forms = ready_forms(name)
    assert forms.forms
    if name != PAPER:
        paper = {it.id for form in ready_forms(PAPER).forms for it in form.questions}
        assert not paper & set(forms.questions)


def test_the_score_of_the_usability_scale() -> None:
    (form,) = ready_forms("sus").forms
    (composite,) = form.composites
    best = {it.id: it.scored(1 if it.id in _REVERSED else 5) for it in form.questions}
    worst = {it.id: it.scored(5 if it.id in _REVERSED else 1) for it in form.questions}
    assert composite.value(best) == 100
    assert composite.value(worst) == 0
    assert composite.value(dict.fromkeys(best, 3)) == 50
    assert composite.value({"sus1": 3}) is None


_REVERSED = ("sus2", "sus4", "sus6", "sus8", "sus10")


@given(seed=st.integers(0, 10_000), round_=st.sampled_from([0, 1, 2]))
def test_a_drawn_order_keeps_headings_in_place_and_what_depends_behind(
    seed: int, round_: int
) -> None:
    follower = Condition(item="b", at_least=1)
    items: list[dict[str, Any]] = [
        {"kind": "heading", "text": "one"},
        *({"kind": "scale", "id": name, "text": name} for name in "abcd"),
        {"kind": "scale", "id": "after_b", "text": "x", "shown_when": {"item": "b", "is": 1}},
        {"kind": "heading", "text": "two"},
        *({"kind": "scale", "id": name, "text": name} for name in "efg"),
    ]
    tree = {
        "version": "1",
        "form": [
            {"id": "f", "place": "at the end", "order": "drawn", "answers": ["no", "yes"],
             "item": items}
        ],
    }  # fmt: skip
    (form,) = forms_in(tree, "here").forms
    order = items_in_order(form, seed, round_)
    names = [it.text if isinstance(it, HeadingItem) else it.id for it in order]
    assert names[0] == "one"
    assert names[6] == "two"
    assert sorted(names[1:6]) == ["a", "after_b", "b", "c", "d"]
    assert names.index("after_b") == names.index("b") + 1
    assert sorted(names[7:]) == ["e", "f", "g"]
    assert follower.holds(1)


@given(st.sets(st.integers(1, 4), min_size=1), st.integers(1, 4))
def test_one_of_several_answers_fulfils_a_condition(given_: set[int], wanted: int) -> None:
    answer = tuple(sorted(given_))
    assert Condition(item="x", is_=wanted).holds(answer) is (wanted in given_)
    assert not Condition(item="x", is_=wanted).holds(None)


def test_what_depends_on_a_hidden_item_is_hidden() -> None:
    answers = ("no", "yes")
    items = (
        ChoiceItem(id="a", text="A", answers=answers),
        ChoiceItem(id="b", text="B", answers=answers, shown_when=Condition(item="a", is_=2)),
        ChoiceItem(id="c", text="C", answers=answers, shown_when=Condition(item="b", is_=2)),
    )
    told = {"a": 1, "b": 2}
    assert shown(items, told.get) == items[:1]
    assert shown(items, (told | {"a": 2}).get) == items
