"""MTConnect's `path`: what it chooses, and that nothing that is written there costs much."""

from __future__ import annotations

import pytest

from registry.mtconnect.xpath import MOST_CHARACTERS, BadPath, Node, choose, read_path
from tests.kit.work import count_work


def item(key: str, **more: str) -> Node:
    return Node("DataItem", {"id": key, "category": "SAMPLE", "type": "LOAD", **more})


def device(name: str, *items: Node) -> Node:
    return Node("Device", {"id": f"d_{name}", "name": name}, (Node("DataItems", {}, items),))


def document(*devices: Node) -> Node:
    return Node("", {}, (Node("MTConnectDevices", {}, (Node("Devices", {}, devices),)),))


PLANT = document(
    device("a", item("a1", name="x"), item("a2", type="EXECUTION", category="EVENT")),
    device("b", item("b1", name="y", subType="ACTUAL"), item("b2", name="it's")),
)
ALL = {"a1", "a2", "b1", "b2"}


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("//DataItem", ALL),
        (".", ALL),
        ("//*", ALL),
        (".//Device", ALL),
        ("/MTConnectDevices/Devices/Device", ALL),
        ("/m:MTConnectDevices/m:Devices/m:Device[@name='a']", {"a1", "a2"}),
        ("//Device[@name='a']//DataItem[@type='LOAD']", {"a1"}),
        ('//DataItem[@type="LOAD" and @name="x"] | //DataItem[@id="b2"]', {"a1", "b2"}),
        ("//DataItem[@type='EXECUTION' or @subType='ACTUAL']", {"a2", "b1"}),
        ("//DataItem[not(@name)]", {"a2"}),
        ("//DataItem[@name!='x']", {"b1", "b2"}),
        ("//DataItem[@category='SAMPLE'][@subType]", {"b1"}),
        ("//DataItem[(@name='x' or @name='y') and @type='LOAD']", {"a1", "b1"}),
        ('//DataItem[@name="it\'s"]', {"b2"}),
        ("//Device[@name='a']/DataItem", set()),
        ("/Device", set()),
        ("//Axes//DataItem", set()),
    ],
)
def test_a_path_chooses_the_items_that_it_names_or_that_lie_below(path: str, expected: set[str]) -> None:
    assert choose(read_path(path), PLANT) == expected


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("", "character 1: an element's name is expected"),
        ("//DataItem[", "character 12: `@` is expected"),
        ("//DataItem[@type=LOAD]", "character 18: a text in quotes is expected"),
        ("//DataItem[@type='LOAD'", "character 24: `]` is expected"),
        ("//DataItem]", "character 11: `/`, `[`, `|` or the end is expected"),
        ("//DataItem[1]", "character 12: '1]'"),
        ("//DataItem[contains(@name,'x')]", "character 26: \",'x')]\""),
        ("//DataItem[position()]", "character 12: `@` is expected"),
        ("//a/ancestor::b", "character 13: '::b'"),
        ("document('file:///etc/passwd')", "character 9: `/`, `[`, `|` or the end is expected"),
        ("//DataItem['", 'character 12: "\'"'),
        ("/a" * 17, "`path` may have 16 steps."),
        (f"//a[{'(' * 9}@b{')' * 9}]", "`path` may have 8 pairs of parentheses."),
        ("a" * (MOST_CHARACTERS + 1), f"`path` may have {MOST_CHARACTERS} characters."),
    ],
)
def test_what_cannot_be_read_is_told_with_its_place(path: str, told: str) -> None:
    with pytest.raises(BadPath) as refused:
        read_path(path)
    assert told in str(refused.value)


def test_the_worst_path_over_the_largest_site_is_bounded() -> None:
    site = document(*(device(f"m{n}", *(item(f"m{n}_{k}") for k in range(66))) for n in range(200)))
    with count_work() as work:
        assert choose(read_path("//*" * 16), site) == set()
        assert len(choose(read_path("//*" * 3 + "//DataItem[@type='LOAD']"), site)) == 200 * 66
    assert work.lines < 4_000_000, "1.9 million today: steps of the path times elements of the site"
