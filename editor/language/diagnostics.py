"""What the checks say: one sentence for a person, with a code and its arguments for translation."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from editor.language.texts import FIX_TEXTS, TEXTS
from registry.capability import Scalar

Severity = Literal["error", "warning"]
TextArguments = Mapping[str, str | int | float]


@dataclass(frozen=True, slots=True)
class Fix:
    """A change that one click makes: `field` of the step becomes `value`; `args.x` is the argument x."""

    label_code: str
    step: str
    field: str
    value: object
    args: TextArguments = dataclasses.field(default_factory=dict)

    @property
    def label(self) -> str:
        """Return the words on the button."""
        return FIX_TEXTS[self.label_code].format_map(self.args)


@dataclass(frozen=True, slots=True)
class Problem:
    """Something that is wrong with a step's field, not yet put into words."""

    code: str
    step: str = ""
    field: str = ""
    args: TextArguments = dataclasses.field(default_factory=dict)
    fix: Fix | None = None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A problem in words; `line` counts from 1 in the script, `column` is only known for scripts written by hand."""

    code: str
    severity: Severity
    message: str
    step: str = ""
    field: str = ""
    args: TextArguments = dataclasses.field(default_factory=dict)
    line: int | None = None
    fix: Fix | None = None
    column: int | None = None


def put_into_words(problem: Problem, line: int | None) -> Diagnostic:
    """Return the diagnostic for a problem that shows at a line of the script."""
    severity, text = TEXTS[problem.code]
    message = text.format_map(problem.args)
    return Diagnostic(
        problem.code, severity, message, problem.step, problem.field, problem.args, line, problem.fix
    )  # fmt: skip


def fix_value(problem_step: str, field_name: str, value: Scalar) -> Fix:
    """Return the fix that enters a value."""
    return Fix(
        "set_to", problem_step, field_name, value, {"value": f"{value:g}" if isinstance(value, float) else str(value)}
    )
