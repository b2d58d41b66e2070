"""Pieces of sentences that are put into words in each language: a small closed set."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Literal

from editor.language.messages.de import WORDS_DE
from editor.language.messages.refusals_de import REFUSALS_DE
from editor.language.messages.sentences import Sentences
from editor.language.messages.syntax_errors_de import MISTAKES_DE

Language = Literal["en", "de"]
LANGUAGES: tuple[Language, ...] = ("en", "de")


@dataclass(frozen=True, slots=True)
class Said:
    """Words that are always the same; `english` is their key, and its first letter may be made large."""

    english: str

    def say(self, language: Language) -> str:
        """Return the words."""
        if language == "en":
            return self.english
        small = self.english[:1].lower() + self.english[1:]
        if self.english not in WORDS_DE and small in WORDS_DE:
            german = WORDS_DE[small]
            return german[:1].upper() + german[1:]
        return WORDS_DE.get(self.english, self.english.replace("“", "„").replace("”", "“"))


@dataclass(frozen=True, slots=True)
class Refusal:
    """What was found in a script, or what to write instead."""

    english: str

    def say(self, language: Language) -> str:
        """Return the words."""
        return self.english if language == "en" else refused_in_german(self.english)


@dataclass(frozen=True, slots=True)
class Quoted:
    """A word of the language in quotation marks."""

    word: str

    def say(self, language: Language) -> str:
        """Return the words."""
        return f"“{self.word}”" if language == "en" else f"„{self.word}“"


@dataclass(frozen=True, slots=True)
class Span:
    """A range: `1 to 30 min`, `15 °C or more`; empty when there is none, else `lead` comes before it."""

    minimum: float | None
    maximum: float | None
    unit: str = ""
    """The unit as people write it."""
    lead: str = ""

    def say(self, language: Language) -> str:
        """Return the words."""
        behind = f" {self.unit}" if self.unit and self.unit != "%" else self.unit
        least = "" if self.minimum is None else number_text(self.minimum, language)
        most = "" if self.maximum is None else number_text(self.maximum, language)
        if least and most:
            return f"{self.lead}{least} {'to' if language == 'en' else 'bis'} {most}{behind}"
        if not least and not most:
            return ""
        if language == "en":
            return f"{self.lead}{least or most}{behind} or {'more' if least else 'less'}"
        return f"{self.lead}{'mindestens' if least else 'höchstens'} {least or most}{behind}"


@dataclass(frozen=True, slots=True)
class Amounts:
    """How many a robot carries at a time; 0 when nobody knows."""

    capacity: int

    def say(self, language: Language) -> str:
        """Return the words."""
        if self.capacity <= 2:
            known = {1: "1", 2: "1 or 2" if language == "en" else "1 oder 2"}
            return known.get(self.capacity, "1 or more" if language == "en" else "1 oder mehr")
        return f"1 {'to' if language == 'en' else 'bis'} {self.capacity}"


@dataclass(frozen=True, slots=True)
class Plural:
    """Many of a kind of object, whose name comes from the devices; empty: objects of any kind."""

    thing: str

    def say(self, language: Language) -> str:
        """Return the words."""
        if language == "de":
            return f"Objekte „{self.thing}“" if self.thing else "Objekte"
        return _plural(self.thing or "object")


@dataclass(frozen=True, slots=True)
class Options:
    """What can be chosen: `box, can`; between the last two stands `last` where it is given."""

    names: tuple[str, ...]
    last: Literal["", "and", "or"] = ""
    none: str = "nothing"

    def say(self, language: Language) -> str:
        """Return the words."""
        if not self.names:
            return Said(self.none).say(language)
        return (f" {Said(self.last).say(language)} " if self.last else ", ").join(self.names)


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot by its name, or any of a sort: `TurtleBot 1`, `A TurtleBot`, `A robot`."""

    name: str
    sort: bool = False

    def say(self, language: Language) -> str:
        """Return the words, at the beginning of a sentence."""
        if not self.sort:
            return self.name
        if language == "de":
            return f"Ein {self.name or 'Roboter'}"
        return f"{'An' if self.name[:1].upper() in {*'AEIOU'} else 'A'} {self.name or 'robot'}"


@dataclass(frozen=True, slots=True)
class Driver:
    """The one robot that has a role, as the object of a sentence: its name, or the role's where any robot will do."""

    name: str
    bound: bool

    def say(self, language: Language) -> str:
        """Return the words."""
        if self.bound:
            return self.name
        return f"{'the robot' if language == 'en' else 'den Roboter'} {Quoted(self.name).say(language)}"


Phrase = Said | Refusal | Quoted | Span | Amounts | Plural | Options | Robot | Driver
Argument = str | int | float | Phrase


def say_argument(argument: Argument, language: Language) -> str:
    """Return an argument of a sentence in words."""
    if isinstance(argument, str):
        return argument
    if isinstance(argument, int | float):
        return number_text(argument, language)
    return argument.say(language)


def refused_in_german(english: str) -> str:
    """Return why a script is refused in German; as it is, when it is nothing that VIPO says."""
    found = _refusals().find(english)
    if found is None:
        return english
    sentence, names = found
    german = REFUSALS_DE.get(sentence) or MISTAKES_DE[sentence]
    return german.format_map({name: _sentence(piece) for name, piece in names.items()})


def _sentence(piece: str) -> str:
    """Return a piece of a sentence, which may be a sentence of its own."""
    return refused_in_german(piece) if piece.endswith(".") else piece


@cache
def _refusals() -> Sentences:
    return Sentences({english: english for english in {**MISTAKES_DE, **REFUSALS_DE}})


def number_text(value: float, language: Language) -> str:
    """Return a number as people of the language write it."""
    text = str(int(value)) if float(value).is_integer() else f"{value:g}"
    return text.replace(".", ",") if language == "de" else text


def _plural(thing: str) -> str:
    if thing.endswith(("s", "x", "ch", "sh")):
        return f"{thing}es"
    return f"{thing[:-1]}ies" if thing.endswith("y") and thing[-2:-1] not in "aeiou" else f"{thing}s"
