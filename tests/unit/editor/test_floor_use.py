"""Which points of a document stand on the floor."""

from __future__ import annotations

from editor.programs.floor_use import goal_points, step_points

DOCUMENT = {
    "steps": {
        "a": {"kind": "move", "place": ["program", "body", "0V"], "pos": [1, 2], "params": {"to": {"point": [3, 4]}}},
        "b": {"kind": "wait", "place": ["program", "body", "1V"], "pos": "nowhere", "params": {}},
        "c": {"kind": "comment", "place": None, "pos": [9, 9], "params": {"text": "on the margin"}},
        "d": {
            "kind": "pick_and_drop",
            "place": ["program", "body", "2V"],
            "pos": [5.5, 6],
            "params": {"source": {"device": "m"}, "target": {"point": [7, 8]}, "via": [[0, 0], {"point": [1]}]},
        },
    }
}


def test_steps_stand_where_they_are_drawn_and_comments_do_not_count() -> None:
    assert list(step_points(DOCUMENT)) == [(1.0, 2.0), (5.5, 6.0)]


def test_goals_are_the_points_that_steps_name() -> None:
    assert list(goal_points(DOCUMENT)) == [(3.0, 4.0), (7.0, 8.0)]
