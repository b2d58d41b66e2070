"""Small random plans against arbitrary events: the machine never raises and always ends in a legal state."""

import json

from hypothesis import given, settings
from hypothesis import strategies as st

from editor.language.expressions import nodes as e
from editor.language.plan import instructions as p
from execution.machine import machine
from execution.machine import messages as r

SIZE = 12
OPEN = {"running", "paused"}
values = st.sampled_from([e.Constant(n) for n in (0, 1, 2, True, False, "box", "", -1)] + [
    e.Variable("n"), e.Variable("x"), e.Reading(e.Constant("oven"), "heat"),
    e.Operation("+", (e.Variable("n"), e.Constant(1))), e.Operation("<", (e.Variable("n"), e.Constant(3))),
    e.Operation(">", (e.Reading(e.Constant("oven"), "heat"), e.Constant(50))),
])  # fmt: skip
truths = st.sampled_from([e.Constant(True), e.Constant(False), e.Operation("<", (e.Variable("n"), e.Constant(3))),
                          e.Operation(">", (e.Reading(e.Constant("oven"), "heat"), e.Constant(50)))])  # fmt: skip
addresses = st.integers(0, SIZE)
shelf = st.just(e.PlaceRef(device="shelf"))
kinds = st.sampled_from([(), ("failed",), ("offline", "timed_out"), ("cancelled",)])
maybe = st.sampled_from([None, e.Constant(5)])
names = st.sampled_from(["n", "x", "#i"])
actions = st.one_of(
    st.builds(p.Move, st.just("robot"), shelf),
    st.builds(p.Pick, st.just("robot"), shelf, values, values),
    st.builds(p.Call, shelf, st.just("mix"), st.fixed_dictionaries({"time": values})),
    st.just(p.Release("robot")),
    st.builds(p.Cover, st.just("robot"), st.just("hall"), st.none() | values),
    st.builds(p.Wait, values),
    st.builds(p.WaitUntil, truths, maybe),
    st.builds(p.Branch, truths, addresses),
    st.builds(p.Jump, addresses),
    st.builds(p.Fork, st.lists(addresses, max_size=3).map(tuple), addresses, st.integers(0, 3)),
    st.just(p.Join()),
    st.builds(p.TryBegin, addresses, kinds, st.booleans()),
    st.just(p.TryEnd()),
    st.builds(p.LimitBegin, values),
    st.just(p.Rethrow()),
    st.builds(p.Invoke, addresses, st.just("f"), st.fixed_dictionaries({"n": values}), st.none() | names,
              st.booleans()),
    st.builds(p.Return, st.none() | values),
    st.builds(p.Assign, names, values, st.booleans()),
    st.builds(p.AskPerson, values, st.just(e.AnswerSpec()), st.none() | names, st.booleans(), maybe),
    st.builds(p.Notify, values, st.sampled_from(["info", "warning"])),
    st.builds(p.End, st.booleans()),
    st.just(p.EventEnd()),
    st.builds(p.Fail, values),
    st.builds(p.Caught, names, names),
    st.builds(p.Perform, st.just("robot"), st.just("honk"), st.fixed_dictionaries({"times": values})),
)  # fmt: skip
steps = st.sampled_from(["", "", "s1", "s2", "s3"])
marks = st.sampled_from([(), (), ("a",), ("b",), ("s1",)])
instructions = st.builds(p.Instruction, actions, steps, st.just(0), marks, marks)
events = st.builds(p.EventEntry, st.sampled_from(["e", "f", ""]), addresses, truths | values,
                   st.sampled_from(["branch", "run"]))  # fmt: skip
plans = st.builds(
    p.Plan,
    st.lists(instructions, min_size=1, max_size=SIZE).map(tuple),
    st.just({}),
    st.sampled_from([{}, {"n": 0}]),
    events=st.lists(events, max_size=2).map(tuple),
)
happenings = st.one_of(
    st.sampled_from([r.PauseAsked("p"), r.Resumed(), r.CancelAsked("c"), r.Resumed(), r.Resumed()]),
    st.builds(r.Facts, st.sampled_from([{("oven", "heat"): value} for value in (0, 60, 100, "hot")])),
    st.builds(r.TaskDone, st.integers(1, 30)),
    st.builds(r.TaskFailed, st.integers(1, 30), st.sampled_from(["failed", "offline", "blocked"]), st.just("why")),
    st.builds(r.TimerFired, st.integers(1, 30)),
    st.builds(r.Answered, st.integers(1, 30), st.sampled_from([True, 3, "box"])),
    st.just("answer"),
)


def answer(asked):
    """The next event for what is open: the oldest mission is done, timer fires, question is answered."""
    kind, number = asked.pop(0)
    return {"mission": r.TaskDone(number), "timer": r.TimerFired(number), "ask": r.Answered(number, 1)}[kind]


def note(actions, asked):
    for action in actions:
        match action:
            case r.Ask(task=number):
                asked.append(("mission", number))
            case r.SetTimer(timer=number):
                asked.append(("timer", number))
            case r.AskPeople(question=number):
                asked.append(("ask", number))
            case r.Cancel(task=number):
                asked[:] = [item for item in asked if item != ("mission", number)]
            case r.CancelTimer(timer=number):
                asked[:] = [item for item in asked if item != ("timer", number)]
            case r.CancelQuestion(question=number):
                asked[:] = [item for item in asked if item != ("ask", number)]


def check(plan, state):
    """A state is legal: threads stand somewhere, have a frame, a parent that waits, and something to wait for."""
    assert state.status in {"running", "paused", "finished", "failed", "cancelled"}
    if state.status not in OPEN:
        assert state.threads == {}
    for thread in state.threads.values():
        assert all(call.frame in state.frames for call in thread.calls)
        if thread.parent is not None:
            assert state.threads[thread.parent].waits_for == "join"
        if thread.waits_for in {"mission", "timer", "until", "ask"}:
            assert 0 <= thread.at < len(plan.instructions)
        if state.status == "running":
            assert thread.waits_for, "a thread could go on and does not"
    if state.status == "running":
        assert 0 in state.threads or state.ending is not None


def carry_out(plan, happened):
    """Play the events; return all states as JSON and all actions."""
    asked, history = [], []
    state, done = machine.start(plan, {}, {("oven", "heat"): 20})
    note(done, asked)
    check(plan, state)
    history.append((machine.to_json(state), done))
    for event in happened:
        if event == "answer":
            if not asked:
                continue
            event = answer(asked)
        state = machine.from_json(json.loads(json.dumps(machine.to_json(state))))
        state, done = machine.step(plan, state, event)
        note(done, asked)
        check(plan, state)
        history.append((machine.to_json(state), done))
    return history


@settings(max_examples=4 * settings.default.max_examples, deadline=None)
@given(plans, st.lists(happenings, max_size=25))
def test_random_plans_against_random_events_stay_legal_and_replay_the_same(plan, happened):
    first = carry_out(plan, happened)
    assert carry_out(plan, happened) == first
    actions = [action for _, done in first for action in done]
    finished = [action for action in actions if isinstance(action, r.Finished)]
    assert len(finished) == (first[-1][0]["status"] not in OPEN)
    assert not finished or actions[-1] == finished[0]


@settings(max_examples=2 * settings.default.max_examples, deadline=None)
@given(plans)
def test_what_is_called_off_was_asked_for_and_everything_is_once(plan):
    actions = [action for _, done in carry_out(plan, ["answer"] * 30 + [r.CancelAsked("over")]) for action in done]
    asked = [action.task for action in actions if isinstance(action, r.Ask)]
    questions = [action.question for action in actions if isinstance(action, r.AskPeople)]
    assert len(set(asked)) == len(asked)
    assert {a.task for a in actions if isinstance(a, r.Cancel)} <= set(asked)
    assert {a.question for a in actions if isinstance(a, r.CancelQuestion)} <= set(questions)
    assert sum(isinstance(a, r.Finished) for a in actions) == 1


@settings(max_examples=2 * settings.default.max_examples, deadline=None)
@given(plans, st.lists(happenings, max_size=25))
def test_every_timer_has_a_thread_that_waits_for_it_or_a_time_limit(plan, happened):
    """With all timers and questions that are open: what nobody needs any more is dropped."""
    asked, running = [], set()
    state, done = machine.start(plan, {}, {("oven", "heat"): 20})
    for event in [*happened, r.CancelAsked("over")]:
        note(done, asked)
        running |= {action.timer for action in done if isinstance(action, r.SetTimer)}
        running -= {action.timer for action in done if isinstance(action, r.CancelTimer)}
        limits = {guard.limit for thread in state.threads.values() for guard in thread.guards}
        assert running <= limits | {thread.waits_id for thread in state.threads.values()}
        if event == "answer":
            if not asked:
                continue
            event = answer(asked)
        running -= {event.timer} if isinstance(event, r.TimerFired) else set()
        state, done = machine.step(plan, state, event)
    assert state.threads == {}
