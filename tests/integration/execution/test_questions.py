"""Questions to people and notices: who may answer, that one answer counts, and that nobody is flooded."""

from uuid import uuid4

import pytest

from editor.language.expressions.nodes import AnswerSpec, Constant, Operation, Variable
from editor.language.plan.instructions import AskPerson, Assign, Branch, End, Instruction, Jump, Notify, Plan, Wait
from execution import services
from execution.models import InboxEvent, Question, Run, RunEvent
from tests.kit.programs import SITE, run_status
from tests.kit.sign_in import join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)


def asking(answer, timeout_s=None):
    limit = None if timeout_s is None else Constant(timeout_s)
    ask = AskPerson(Constant("How is it?"), answer, "it", True, limit)
    return Plan((Instruction(ask, "q", 1), Instruction(Branch(Constant(True), 2)), Instruction(End())))


def open_question(factory, answer=None, **more):
    run = factory.start(asking(answer or AnswerSpec("boolean"), **more))
    factory.work()
    return run, services.list_questions(site=SITE)[0].id


def send(client, question, value):
    return post_json(client, f"/api/questions/{question}/answer", {"value": value})


def test_a_question_is_shown_answered_and_the_run_goes_on(factory):
    run, question = open_question(factory)
    shown = services.list_questions(site=SITE)[0]
    assert (str(shown.run), shown.run_number, shown.text, shown.state) == (run, 1, "How is it?", "open")
    assert shown.answer == {"type": "boolean", "unit": "", "minimum": None, "maximum": None, "options": []}
    step = Run.objects.get(id=run).steps["q"]
    assert (step["status"], step["why"]) == ("waiting", {"code": "question", "args": {}})
    answer = services.answer_question(question_id=question, value=False, by="Ada")
    assert (answer.state, answer.value, answer.answered_by) == ("answered", False, "Ada")
    factory.work()
    assert run_status(run) == "finished"
    assert services.list_questions(site=SITE) == ()
    assert [row.state for row in services.list_questions(site=SITE, run_id=run)] == ["answered"]
    texts = list(RunEvent.objects.filter(run=run, kind="question").values_list("text", flat=True))
    assert texts == ["How is it?", "Ada answered: no."]
    assert Run.objects.get(id=run).state["frames"]["0"] == {"it": False}


def test_of_many_who_answer_exactly_one_is_first_and_the_run_hears_one_answer(factory):
    _run, question = open_question(factory, AnswerSpec("number"))
    seen = []
    for number in range(4):
        try:
            seen.append(services.answer_question(question_id=question, value=number, by=f"P{number}").value)
        except services.AlreadyAnswered as error:
            seen.append(error.detail)
    assert seen == [0, *["P0 has answered already: 0."] * 3]
    assert InboxEvent.objects.filter(payload__type="answered").count() == 1


@pytest.mark.parametrize(
    ("answer", "value", "why"),
    [
        (AnswerSpec("boolean"), 1, "Answer yes or no."),
        (AnswerSpec("number"), "3", "Answer with a number."),
        (AnswerSpec("number"), True, "Answer with a number."),
        (AnswerSpec("number", minimum=2), 1.5, "The number must be at least 2."),
        (AnswerSpec("number", maximum=2), 3, "The number must be at most 2."),
        (AnswerSpec("number", minimum=-1234567.5), -1234568, "The number must be at least -1234567.5."),
        (AnswerSpec("number", maximum=1234567), 1234568, "The number must be at most 1234567."),
        (AnswerSpec("choice", options=("red", "blue")), "green", "Choose one of: red, blue."),
        (AnswerSpec("text"), "x" * 501, "Answer with a text of at most 500 characters."),
        (AnswerSpec("text"), None, "Answer with a text of at most 500 characters."),
    ],
)
def test_an_answer_that_does_not_fit_is_refused_and_the_question_stays_open(factory, answer, value, why):
    run, question = open_question(factory, answer)
    reply = send(join_and_sign_in("operator", SITE), question, value)
    assert (reply.status_code, reply.json()["code"], reply.json()["detail"]) == (422, "answer_not_fitting", why)
    assert Question.objects.get(id=question).state == "open"
    assert run_status(run) == "running"


@pytest.mark.parametrize(("role", "code"), [("stranger", 404), ("viewer", 403), ("operator", 200), ("admin", 200)])
def test_operators_and_above_answer_viewers_only_look(factory, role, code):
    _, question = open_question(factory)
    client = join_and_sign_in(role, SITE)
    assert client.get(f"/api/sites/{SITE}/questions").status_code == (404 if role == "stranger" else 200)
    assert send(client, question, True).status_code == code
    assert Question.objects.get(id=question).state == ("answered" if code == 200 else "open")


def test_a_second_answer_hears_who_was_first(factory):
    _, question = open_question(factory)
    services.answer_question(question_id=question, value=True, by="Ada")
    reply = send(join_and_sign_in("operator", SITE), question, False)
    assert (reply.status_code, reply.json()["detail"]) == (409, "Ada has answered already: yes.")
    assert Question.objects.get(id=question).value is True
    assert send(join_and_sign_in("admin", SITE), uuid4(), True).status_code == 404


def test_a_second_answer_hears_the_first_with_all_its_digits(factory):
    _, question = open_question(factory, AnswerSpec("number"))
    services.answer_question(question_id=question, value=1234567.25, by="Ada")
    reply = send(join_and_sign_in("operator", SITE), question, 7)
    assert (reply.status_code, reply.json()["detail"]) == (409, "Ada has answered already: 1234567.25.")


def test_a_question_that_nobody_answers_in_time_is_withdrawn_and_the_step_times_out(factory):
    run, question = open_question(factory, timeout_s=20)
    factory.go(lambda: run_status(run) == "failed", limit_s=30)
    assert Question.objects.get(id=question).state == "withdrawn"
    with pytest.raises(services.NotPossibleNow):
        services.answer_question(question_id=question, value=True, by="Ada")
    assert Run.objects.get(id=run).reason == "Nobody answered in time."


def test_a_cancelled_run_withdraws_its_questions(factory):
    run, question = open_question(factory)
    services.cancel_run(run_id=run, by="Ada")
    factory.work()
    assert Question.objects.get(id=question).state == "withdrawn"


def test_a_loop_cannot_flood_the_screens_with_notices(factory):
    told = Notify(Constant("Hello"), "info")
    run = factory.start(Plan((Instruction(told, "n"), Instruction(Wait(Constant(0.1))), Instruction(Jump(0)))))
    factory.work()
    for _ in range(30):
        factory.pass_time(0.5)
        factory.work()
    assert RunEvent.objects.filter(run=run, kind="notice").count() == 20
    services.cancel_run(run_id=run, by="Ada")
    factory.work()
    last = RunEvent.objects.filter(run=run, kind="notice").last()
    assert (last.code, last.text) == ("notices_held", "11 more notices were not shown.")


def test_a_variable_set_by_an_answer_is_read(factory):
    ask = AskPerson(Constant("Which?"), AnswerSpec("choice", options=("a", "b")), "which", True)
    run = factory.start(Plan((Instruction(ask, "q"), Instruction(Notify(Variable("which"))), Instruction(End()))))
    factory.work()
    question = services.list_questions(site=SITE)[0].id
    services.answer_question(question_id=question, value="b", by="Ada")
    factory.work()
    assert RunEvent.objects.get(run=run, kind="notice").text == "b"


def test_a_step_that_begins_very_often_does_not_fill_the_journal(factory):
    count = Operation("+", (Variable("n"), Constant(1)))
    body = (
        Instruction(Assign("n", count, True), "s"),
        Instruction(Branch(Operation("<", (Variable("n"), Constant(250))), 4)),
        Instruction(Wait(Constant(0.1))),
        Instruction(Jump(0)),
        Instruction(End()),
    )
    run = factory.start(Plan(body), n=0)
    factory.go(lambda: run_status(run) == "finished")
    assert Run.objects.get(id=run).steps["s"]["count"] == 250
    assert RunEvent.objects.filter(run=run, step="s", code="step_entered").count() == 101
