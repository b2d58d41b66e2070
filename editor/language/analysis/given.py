"""What is known of a program's parameters where it is known what a run gives them."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Final

from editor.language.expressions.nodes import Constant
from editor.language.expressions.ranges import Here, Known
from editor.language.site.surroundings import Surroundings
from editor.language.tree.program import Parameter

_NOWHERE: Final = Surroundings(devices={}, places={})


def known_of(parameter: Parameter) -> Known:
    """Return what is known of a parameter."""
    return None if parameter.given is None else Here(_NOWHERE).known(Constant(parameter.given))


def known_of_all(parameters: Iterable[Parameter], but: Collection[str]) -> dict[str, Known]:
    """Return what is known of the parameters that are given, but for some names."""
    return {each.name: known_of(each) for each in parameters if each.given is not None and each.name not in but}
