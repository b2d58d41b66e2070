"""Answers are compressed and not sent again to who has them; secrets and streams are left alone."""

from __future__ import annotations

import gzip
from typing import Any

import pytest

from tests.kit.sign_in import post_json, signed_in
from tests.kit.sites import approve, make_hall, make_mixers

pytestmark = pytest.mark.django_db
DEVICES = "/api/sites/hall/devices"


@pytest.fixture
def hall() -> None:
    make_hall()
    make_mixers("a", "b", "c")


def get(path: str, **headers: str) -> Any:
    return signed_in("viewer").get(path, headers={"Accept-Encoding": "gzip", **headers})


def test_large_answers_are_compressed_for_who_can_read_that(hall: None) -> None:
    plain, small = signed_in("viewer").get(DEVICES), get(DEVICES)
    assert "Content-Encoding" not in plain
    assert (small["Content-Encoding"], gzip.decompress(small.content)) == ("gzip", plain.content)
    assert len(plain.content) > 2 * len(small.content)
    assert "Accept-Encoding" in small["Vary"]
    assert int(small["Content-Length"]) == len(small.content)


@pytest.mark.parametrize("path", ["/api/sites", "/things/a", "/api/sites/hall/map/cells"])
def test_small_answers_tagged_bytes_and_what_is_compressed_already_are_left_alone(hall: None, path: str) -> None:
    plain, same = signed_in("viewer").get(path), get(path)
    assert (same.content, same.get("Content-Encoding")) == (plain.content, plain.get("Content-Encoding"))


def test_what_tells_a_secret_is_neither_compressed_nor_kept_nor_tagged(hall: None) -> None:
    client = signed_in("viewer", headers={"Accept-Encoding": "gzip"})
    body = {"name": "x" * 90, "scopes": ["read"]}
    made = post_json(client, "/api/sites/hall/tokens", body)
    assert (made.status_code, made["Cache-Control"]) == (201, "no-store")
    assert {"ETag", "Content-Encoding"}.isdisjoint(made.headers)


def test_the_stream_of_events_is_not_compressed(hall: None) -> None:
    stream = get("/api/sites/hall/things/events")
    assert (stream.status_code, stream.streaming) == (200, True)
    assert {"ETag", "Content-Encoding"}.isdisjoint(stream.headers)
    stream.close()


def test_what_has_not_changed_is_not_sent_again(hall: None) -> None:
    first = get(DEVICES)
    tag = first["ETag"]
    assert (tag[:3], first["Cache-Control"]) == ('W/"', "private, no-cache")
    again = get(DEVICES, **{"If-None-Match": tag})
    assert (again.status_code, again.content, again["ETag"]) == (304, b"", tag)
    assert signed_in("viewer").get(DEVICES)["ETag"] == tag
    approve()
    changed = get(DEVICES, **{"If-None-Match": tag})
    assert (changed.status_code, changed["ETag"] != tag) == (200, True)


def test_who_may_not_look_any_more_is_not_told_that_nothing_changed(hall: None) -> None:
    tag = get(DEVICES)["ETag"]
    answers = [
        signed_in(who).get(DEVICES, headers={"If-None-Match": tag}).status_code for who in ("nobody", "stranger")
    ]
    assert answers == [401, 404]
