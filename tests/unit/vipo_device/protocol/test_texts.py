"""The one rule for text: what no text may hold, what one line may not, and one form for what looks the same."""

from __future__ import annotations

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vipo_device.protocol.texts import cleaned, cleaned_json, find_unfit, normal, refusal_of, unfit_texts

ANY_TEXT = st.text(st.characters(exclude_categories=()))


@pytest.mark.parametrize("text", ["Mixer 1", "Müller & Söhne", "日本語", "a\tb\nc", "👩‍🔧", "", "1 000 µm", "שלום"])
def test_what_people_write_is_fit(text: str) -> None:
    assert (find_unfit(text), refusal_of(text), cleaned(text)) == ("", "", text)


@pytest.mark.parametrize(
    "character", ["\0", "\x07", "\x1b", "\x7f", "\x85", "\u2028", "\u202e", "\u2066", "\ud800", "\uffff"]
)
def test_what_no_text_may_hold_is_named(character: str) -> None:
    said = f"holds U+{ord(character):04X}, which is no text: take that character out, or type the text anew"
    assert refusal_of(f"a{character}b") == said
    assert cleaned(f"a{character}b") == "ab"


def test_a_line_has_no_break_and_a_break_is_one_character() -> None:
    assert refusal_of("a\nb", is_line=True) == "must be one line: take out the line break or tab"
    assert normal("a\r\nb\rc") == "a\nb\nc"


def test_what_looks_the_same_is_the_same() -> None:
    assert normal("Mu\u0308ller") == cleaned("Mu\u0308ller") == "Müller"


@given(ANY_TEXT)
def test_a_cleaned_text_is_fit_stays_so_and_can_be_said_in_utf8(text: str) -> None:
    clean = cleaned(text)
    assert (find_unfit(clean), cleaned(clean), normal(clean)) == ("", clean, clean)
    assert unicodedata.is_normalized("NFC", clean)
    assert clean.encode().decode() == clean


def test_json_says_where_a_text_is_unfit_and_is_cleaned_with_its_names() -> None:
    body = {"a": [1, {"b": "x\0"}], "c\x01": 2}
    assert list(unfit_texts(body)) == [(("a", 1, "b"), "x\0"), ((), "c\x01")]
    assert cleaned_json(body) == {"a": [1, {"b": "x"}]}
