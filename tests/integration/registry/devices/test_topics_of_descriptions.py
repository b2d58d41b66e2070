"""Descriptions of many devices at once, some of which ask for legacy topics."""

from __future__ import annotations

from dataclasses import replace

from registry import services
from registry.services import DeviceView
from tests.kit.sites import MIXER, describe_later
from vipo_device.protocol.description import MethodSpec


def test_of_two_that_ask_for_one_topic_at_once_one_gets_it_and_the_others_are_kept(hall: str) -> None:
    asking = [
        replace(MIXER, id=name, methods=(MethodSpec("mix", "plant/mixer/start"),)) for name in ("mixer2", "mixer3")
    ]
    first, second, plain = services.ingest_descriptions(descriptions=[describe_later(d) for d in (*asking, MIXER)])
    assert isinstance(first, DeviceView)
    assert "another device asks for" in getattr(second, "detail", "")
    assert isinstance(plain, DeviceView)
    again = [describe_later(replace(asking[0], name="Again")), describe_later(replace(asking[1], name="Again"))]
    first, second = services.ingest_descriptions(descriptions=again)
    assert getattr(first, "name", "") == "Again"
    assert "another device asks for" in getattr(second, "detail", "")
