"""Whose rehearsal is next: sites in turn, people in turn, and the oldest first among equals."""

from datetime import UTC, datetime, timedelta
from uuid import UUID

from hypothesis import given
from hypothesis import strategies as st

from execution.rehearsals.queue_order import Entry, order_fairly

BEGAN = datetime(2026, 11, 23, tzinfo=UTC)


def entries(*said):
    """Return entries of `site person`, in the order of their coming; one with `!` is under way."""
    found = []
    for number, words in enumerate(said):
        site, person = words.rstrip("!").split()
        since = BEGAN + timedelta(seconds=number)
        found.append(Entry(UUID(int=number), int(site), int(person), since, words.endswith("!")))
    return found


def order(*said, served=""):
    """Return the numbers of those that wait; `served` are whose were begun, the last one last."""
    begun = {}
    for number, words in enumerate(served.split(", ") if served else ()):
        site, person = map(int, words.split())
        begun[site, person] = BEGAN + timedelta(seconds=number)
    return [found.int for found in order_fairly(entries(*said), begun)]


def test_one_after_the_other_where_nobody_has_two():
    assert order("1 1", "1 2", "1 3") == [0, 1, 2]


def test_who_queues_ten_does_not_stand_before_who_queues_one():
    assert order(*["1 1"] * 10, "1 2") == [0, 10, 1, 2, 3, 4, 5, 6, 7, 8, 9]


def test_what_a_person_has_under_way_counts():
    assert order("1 1!", "1 1", "1 2") == [2, 1]


def test_a_site_with_many_people_does_not_stand_before_one_with_one():
    assert order("1 1", "1 2", "1 3", "2 9") == [0, 3, 1, 2]


def test_a_person_who_has_much_at_one_site_has_their_turn_at_the_other():
    assert order("1 1!", "1 1!", "1 1", "2 1") == [3, 2]


def test_who_was_served_longest_ago_comes_first_also_where_one_at_a_time_is_under_way():
    assert order("1 1", "1 1", "1 2", served="1 1") == [2, 0, 1]
    assert order("1 1", "1 2", "1 3", served="1 2, 1 1") == [2, 1, 0]
    assert order("1 1", "2 1", served="1 1") == [1, 0]
    assert order("1 1", "1 2", "2 1", served="2 1, 1 1") == [2, 1, 0]


@given(st.lists(st.tuples(st.integers(1, 3), st.integers(1, 3), st.booleans()), max_size=20), st.randoms())
def test_everybody_who_waits_has_one_place_whatever_the_order_of_the_rows(drawn, random):
    found = entries(*(f"{site} {person}{'!' if running else ''}" for site, person, running in drawn))
    shuffled = random.sample(found, len(found))
    ordered = order_fairly(shuffled, {})
    assert ordered == order_fairly(found, {})
    assert sorted(ordered) == sorted(entry.id for entry in found if not entry.is_running)


@given(st.lists(st.integers(1, 3), max_size=20))
def test_nobody_waits_behind_the_second_of_another_before_their_own_first(people):
    found = entries(*(f"1 {person}" for person in people))
    persons = [next(e.person for e in found if e.id == ordered) for ordered in order_fairly(found, {})]
    first = {person: persons.index(person) for person in set(persons)}
    assert all(place < len(first) for place in first.values())
