"""All constructs, in the order of the editor's rail."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from editor.language.constructs.record import Construct, Field, Form, Look

ROLE = Field("role", "role", shown=False)
QUANTITY, OBJECT = Field("quantity", wanted="number"), Field("object", wanted="object")
ROUTE = Field("route", "route", optional=True, shown=False)
CONDITION = Field("condition", wanted="boolean")
TIMEOUT = Field("timeout", wanted="time", at="timeout_s", optional=True, shown=False)
BODY = (("body", "body"),)
ERROR_KINDS = ("refused", "failed", "timed_out", "offline", "blocked", "cancelled")

_MOVE = Construct(
    "move",
    (
        Form(
            "Move",
            (ROLE, Field("to", "place"), ROUTE),
            "role.move(to, via=route)",
            "Write self.robot.move(self.oven.location).",
        ),
    ),
    Look("move", "motion", "pill", "M"),
    takes_time=True,
)


def _load(kind: str, node: str, place: str, look: Look) -> Construct:
    fields = (ROLE, Field("at", "place", accepts=place, shown=False), OBJECT, QUANTITY)
    script = f'role.{kind}({{"value": quantity, "object": object}})'
    example = 'Write self.robot.pick({"value": 1, "object": "box"}).'
    return Construct(kind, (Form(node, fields, script, example),), look, takes_time=True)


_PICK = _load("pick", "Pick", "gives", Look("pick", "motion", "pill", "K", letters=3))
_DROP = _load("drop", "Drop", "takes", Look("drop", "motion", "pill", "J", letters=3))
_RELEASE = Construct(
    "release",
    (Form("Release", (ROLE,), "role.release()", "Write self.robot.release()."),),
    Look("release", "motion", "pill", rare=True, letters=16),
)
_COVER = Construct(
    "cover",
    (
        Form(
            "Cover",
            (ROLE, Field("zone", "zone"), Field("lane", wanted="length", at="lane_m", optional=True, shown=False)),
            "role.cover(zone, lane=lane)",
            "Write self.robot.cover(self.hall), or self.robot.cover(self.hall, lane=0.4).",
        ),
    ),
    Look("cover", "motion", "pill", rare=True, letters=6),
    takes_time=True,
)
_PICK_AND_DROP = Construct(
    "pick_and_drop",
    (
        Form(
            "",
            (
                ROLE,
                Field("source", "place", accepts="gives", shown=False),
                Field("target", "place", accepts="takes", shown=False),
                OBJECT,
                QUANTITY,
                ROUTE,
            ),
        ),
    ),
    Look("pickdrop", "motion", "pill", "P", letters=3),
)
_METHOD, _ARGUMENTS = Field("method", "method"), Field("args", "arguments", at="arguments")
_OPERATE = Construct(
    "operate",
    (
        Form("Perform", (Field("device", "own_robot", at="role", shown=False), _METHOD, _ARGUMENTS)),
        Form(
            "Operate",
            (Field("device", "place", accepts="methods", shown=False), _METHOD, _ARGUMENTS),
        ),
    ),
    Look("operate", "machine", "pill", "O", letters=0),
    takes_time=True,
)
_WAIT_EXAMPLE = "Write self.wait(60), or self.wait(until=self.oven.temperature < 40, timeout=600)."
_WAIT = Construct(
    "wait",
    (
        Form(
            "WaitUntil",
            (Field("until", wanted="boolean", at="condition"), TIMEOUT),
            "self.wait(until=until, timeout=timeout)",
            _WAIT_EXAMPLE,
            marked_by="until",
        ),
        Form("Wait", (Field("duration", wanted="time", at="seconds"),), "self.wait(duration)", _WAIT_EXAMPLE),
    ),
    Look("wait", "machine", "pill", "U", letters=5),
    takes_time=True,
)
_IF = Construct(
    "if",
    (Form("If", (CONDITION,)),),
    Look("if", "logic", "diamond", "I", tall=True),
    (("then", "then"), ("else", "otherwise")),
)
_WHILE = Construct(
    "while", (Form("While", (CONDITION,)),), Look("while", "logic", "header", "W", tall=True), BODY, loops=True
)
_REPEAT = Construct(
    "repeat",
    (Form("Repeat", (Field("times", wanted="number"),)),),
    Look("repeat", "logic", "header", "R"),
    BODY,
    loops=True,
)
_FOR_EACH = Construct(
    "for_each",
    (
        Form(
            "ForEach",
            (
                Field("variable", "loop_variable", suggested="item"),
                Field("items", "values"),
                Field("index", "loop_variable", optional=True),
                Field("list", "value", "list", at="over", optional=True),
            ),
        ),
    ),
    Look("foreach", "logic", "header", "E"),
    BODY,
    loops=True,
)
_PARALLEL = Construct(
    "parallel",
    (
        Form(
            "Parallel",
            (Field("branches", "branches", shown=False), Field("needed", "whole", optional=True)),
        ),
    ),
    Look("parallel", "logic", "fork", "L"),
    names_branches=True,
)
_TRY = Construct(
    "try",
    (
        Form(
            "Try",
            (
                Field("kinds", "choices", at="handlers", choices=ERROR_KINDS, numbered=8, shown=False),
                Field("catch", "flag", at="handlers", optional=True, shown=False),
            ),
        ),
    ),
    Look("try", "logic", "header", "T"),
    (("body", "body"), ("catch", "handlers"), ("finally", "final")),
)
_LIMIT = Construct(
    "limit",
    (Form("Limit", (Field("duration", wanted="time", at="seconds"),)),),
    Look("limit", "logic", "header", rare=True, letters=9),
    BODY,
)
_ON_EVENT = Construct(
    "on_event",
    (
        Form(
            "Event",
            (CONDITION, Field("starts", "choice", choices=("branch", "run"), explained=True, shown=False)),
        ),
    ),
    Look("event", "logic", "root", "G", rare=True, tall=True),
    BODY,
)
_BREAK = Construct("break", (Form("Break"),), Look("break", "logic", "box", rare=True))
_CONTINUE = Construct("continue", (Form("Continue"),), Look("continue", "logic", "box", rare=True))
_RETURN = Construct(
    "return", (Form("Return", (Field("value", optional=True),)),), Look("return", "logic", "box", rare=True)
)
_END = Construct(
    "end",
    (Form("End", (), "self.end()", "Write self.end()."),),
    Look("end", "logic", "box", rare=True),
)
_FAIL = Construct(
    "fail", (Form("Fail", (Field("message", wanted="text"),)),), Look("fail", "logic", "box", rare=True, letters=7)
)
_CALL = Construct(
    "call",
    (
        Form(
            "Call",
            (
                Field("function", "function", shown=False),
                Field("args", "arguments", at="arguments"),
                Field("result", "variable", optional=True, shown=False),
            ),
        ),
    ),
    Look("fn", "func", "box", "F", letters=12),
)
_SET = Construct(
    "set", (Form("Set", (Field("variable", "variable"), Field("value"))),), Look("set", "func", "box", "S")
)
_NOTIFY = Construct(
    "notify",
    (
        Form(
            "Notify",
            (
                Field("message", wanted="text"),
                Field("level", "choice", choices=("info", "warning"), shown=False),
            ),
            "self.notify(message, level=level)",
            'Write self.notify("The box is dry.", level="info").',
        ),
    ),
    Look("notify", "func", "box", "N", letters=7),
)
_ASK = Construct(
    "ask",
    (
        Form(
            "Ask",
            (
                Field("question", wanted="text"),
                Field("answer", "answer", shown=False),
                Field("variable", "variable", optional=True, suggested="answer", shown=False),
                TIMEOUT,
            ),
            "variable = self.ask(question, **answer, timeout=timeout)",
            'Write self.dry = self.ask("Is it dry?", type="boolean", timeout=600).',
        ),
    ),
    Look("ask", "func", "box", "A", rare=True, letters=7),
    takes_time=True,
)
_COMMENT = Construct("comment", (Form("", (Field("text", "text"),)),), Look("comment", "note", "note", "C"))

CONSTRUCTS: Final[Mapping[str, Construct]] = {
    construct.kind: construct
    for construct in (
        _MOVE, _PICK, _DROP, _PICK_AND_DROP, _COVER, _RELEASE, _OPERATE, _WAIT, _IF, _WHILE,
        _REPEAT, _FOR_EACH, _PARALLEL, _TRY,
        _LIMIT, _ON_EVENT, _BREAK, _CONTINUE, _RETURN, _END, _FAIL, _CALL, _SET, _NOTIFY, _ASK, _COMMENT,
    )
}  # fmt: skip
"""By kind."""
COMMENT: Final = "comment"
"""The kind of what people write beside the program; it stands in no branch."""
STEPS: Final = tuple(construct for kind, construct in CONSTRUCTS.items() if kind != COMMENT)
"""The constructs that take part in a program."""
FORMS: Final[Mapping[str, tuple[Construct, Form]]] = {
    form.node: (construct, form) for construct in STEPS for form in construct.forms if form.node
}
"""Each node's construct and form, by the name of the node's class."""


def fields_by_kind(*types: str) -> dict[str, str]:
    """Return the kinds that have a field of one of these types, each with the field's name."""
    found = ((one.kind, field.name) for one in STEPS for field in one.fields if field.type in types)
    return dict(found)
