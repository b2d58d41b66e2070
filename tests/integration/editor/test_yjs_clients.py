"""Plain y-websocket clients against the real application in Daphne."""

from __future__ import annotations

import signal

from tests.integration.editor.node_clients import node_clients
from tests.kit.web import Web


def test_a_step_drawn_by_one_is_seen_by_another_and_kept(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.open("bob", "second")
        clients.tell("add", name="ada", id="s1", x=4, y=-2.5)
        clients.tell("saved", name="ada")
        clients.tell("converged")
        step = {"kind": "wait", "place": ["program", "body", "s1"], "pos": [4, -2.5], "params": {"duration": 5}}
        assert clients.tell("steps", name="bob")["steps"] == {"s1": step}
        assert clients.tell("problems")["problems"] == []
    web.wait_for_document(program, {"s1": step})


def test_five_people_who_edit_at_once_converge_also_over_a_cut(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        for number in range(5):
            clients.open(f"c{number}", "author" if number % 2 else "second")
        clients.tell("storm", steps=40)
        clients.tell("cut", name="c1")
        clients.tell("disconnect", name="c2")
        clients.tell("add", name="c2", id="offline")
        clients.tell("storm", steps=40)
        clients.tell("connect", name="c2")
        clients.tell("converged")
        for number in range(5):
            clients.tell("saved", name=f"c{number}")
        steps = clients.tell("steps", name="c3")["steps"]
        assert "offline" in steps
        assert clients.tell("problems")["problems"] == []
    web.wait_for_document(program, steps)


def test_what_was_shown_as_saved_outlives_a_killed_server(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        for number in range(30):
            clients.tell("add", name="ada", id=f"s{number}", x=number, y=1)
        clients.tell("saved", name="ada")
        steps = clients.tell("steps", name="ada")["steps"]
        clients.tell("destroy", name="ada")
        web.kill()
        web.start()
        clients.open("bob", "second")
        assert clients.tell("steps", name="bob")["steps"] == steps
    assert len(steps) == 30
    web.wait_for_document(program, steps)


def test_clients_outlive_a_killed_server_and_lose_nothing(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.open("bob", "second")
        clients.tell("storm", steps=20)
        web.kill()
        clients.tell("add", name="ada", id="while-away")
        web.start()
        clients.tell("converged")
        clients.tell("saved", name="ada")
        steps = clients.tell("steps", name="bob")["steps"]
        assert "while-away" in steps
    web.wait_for_document(program, steps)


def test_a_viewer_sees_and_cannot_change(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.open("eve", "viewer")
        clients.open("oda", "operator")
        clients.tell("add", name="ada", id="s1")
        clients.tell("converged")
        clients.tell("add", name="eve", id="not-allowed")
        clients.tell("add", name="oda", id="nor-this")
        clients.tell("add", name="ada", id="s2")
        clients.tell("saved", name="ada")
        assert sorted(clients.tell("steps", name="ada")["steps"]) == ["s1", "s2"]
        ada = clients.tell("steps", name="ada")["steps"]
    web.wait_for_document(program, ada)


def test_people_are_shown_under_the_name_of_their_session(web: Web) -> None:
    with node_clients(web, web.new_program()) as clients:
        clients.open("ada")
        clients.open("bob", "second")
        clients.tell("show", name="bob", state={"user": {"name": "The Boss"}, "cursor": [1, 2]})
        clients.tell("show", name="ada", state={"cursor": [3, 4]})
        assert "Ada second" in clients.tell("seen", name="ada", count=2)["states"]
        clients.tell("destroy", name="bob")
        clients.tell("seen", name="ada", count=1)


def test_a_change_above_a_mebibyte_is_taken(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.tell("fill", name="ada", bytes=3 * 1024 * 1024)
        clients.tell("add", name="ada", id="after")
        clients.tell("saved", name="ada")
        clients.open("bob", "second")
        assert sorted(clients.tell("steps", name="bob")["steps"]) == ["after"]


def test_a_document_above_its_limit_is_refused_for_good(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.open("bob", "second")
        clients.tell("fill", name="ada", bytes=9 * 1024 * 1024)
        assert clients.tell("closed", name="ada")["closed"] == 4413
        clients.tell("add", name="bob", id="still-works")
        clients.tell("saved", name="bob")


def test_strangers_and_signed_out_people_are_refused_for_good(web: Web) -> None:
    web.sessions["nobody"] = "no-such-session"
    with node_clients(web, web.program) as clients:
        assert clients.open("stranger", "stranger", wait=True)["closed"] == 4404
        assert clients.open("nobody", "nobody", wait=True)["closed"] == 4401


def test_who_signs_out_edits_no_more_and_others_go_on(web: Web) -> None:
    program = web.new_program()
    with web.client(None) as browser, node_clients(web, program) as clients:
        browser.post("/sign-in", json={"email": "second@vipo.example", "password": "a long password"})
        web.sessions["leaving"] = browser.cookies["sessionid"]
        clients.open("leaving", "leaving")
        clients.open("ada")
        browser.headers["X-CSRFToken"] = browser.get("/me").json()["csrf"]
        assert browser.post("/sign-out").status_code == 200
        assert clients.tell("closed", name="leaving")["closed"] == 4401
        clients.tell("add", name="ada", id="still-works")
        clients.tell("saved", name="ada")


def test_a_server_that_is_told_to_end_keeps_what_it_has_heard(web: Web) -> None:
    program = web.new_program()
    with node_clients(web, program) as clients:
        clients.open("ada")
        for number in range(20):
            clients.tell("add", name="ada", id=f"s{number}")
        clients.open("bob", "second")  # asked last, so all has been heard
        heard = clients.tell("steps", name="bob")["steps"]
        process = web.process
        assert process is not None
        process.send_signal(signal.SIGTERM)
        clients.tell("destroy", name="ada")
        clients.tell("destroy", name="bob")
        assert process.wait(15) == 0
        web.start()
        clients.open("eve", "viewer")
        assert clients.tell("steps", name="eve")["steps"] == heard
    assert len(heard) == 20
