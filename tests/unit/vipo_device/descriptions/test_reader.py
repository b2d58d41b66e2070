from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from registry.demo.devices import describe_devices
from tests.kit.files import FIGURE_5, ROOT
from tests.unit.vipo_device.descriptions.examples import THING, descriptions
from vipo_device.descriptions.forms import FORMS, BadDescription, form_of
from vipo_device.descriptions.reader import canonical_hash, read, write_description
from vipo_device.descriptions.td_schema import check_thing
from vipo_device.descriptions.thing_description import thing_of
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size


@settings(max_examples=40, deadline=None)
@given(descriptions(), st.sampled_from(sorted(FORMS)))
def test_a_description_survives_each_form(description: Description, form: str) -> None:
    reading = read(write_description(description, form, broker="mqtt://broker.example:1883/").encode())
    assert (reading.description, reading.form, reading.notes) == (description, form, ())
    assert canonical_hash(reading.description) == canonical_hash(description)


@settings(max_examples=40, deadline=None)
@given(descriptions())
def test_every_thing_that_is_written_keeps_to_the_schema_of_the_w3c(description: Description) -> None:
    check_thing(thing_of(description, "mqtt://broker.example:1883/"))


@pytest.mark.parametrize("form", FORMS)
def test_the_same_description_gives_the_same_text(form: str) -> None:
    for description in describe_devices():
        text = write_description(description, form)
        assert form_of(text.encode()) == form
        assert write_description(read(text.encode(), device_id=description.id).description, form) == text


def test_an_unknown_form_is_refused() -> None:
    with pytest.raises(BadDescription, match=f"Ask for {', '.join(FORMS)}"):
        write_description(describe_devices()[0], "xml")


def test_the_forms_of_a_thing_name_their_topics() -> None:
    mixer = next(d for d in describe_devices() if d.id == "paintMixer02")
    thing = thing_of(mixer, "mqtt://broker.example:1883/")
    action = thing["actions"]["mixPaint"]["forms"][0]
    assert action["href"] == "mqtt://broker.example:1883/vipo/v1/dev/paintMixer02/down/mixPaint"
    assert action["mqv:topic"] == "vipo/v1/dev/paintMixer02/down/mixPaint"
    reading = thing["properties"]["temperature"]["forms"][0]
    assert reading["href"] == "mqtt://broker.example:1883/vipo/v1/dev/paintMixer02/up/state"
    assert (reading["mqv:filter"], reading["vipo:pointer"]) == (
        "vipo/v1/dev/paintMixer02/up/state",
        "/props/temperature",
    )
    assert thing["properties"]["temperature"]["unit"] == "unit:DEG_C"


PAINT_MIXER = Description(
    "paintMixer02",
    "Paint Mixer B",
    "machine",
    "",
    Pose(14.775500297546387, -5.847640037536621, 0.5699999992847443, 0.0),
    Size(1.0, 1.0, 1.0),
    description="Functions: Mixes Paint for a given duration of time",
    done=False,
    properties=(PropertySpec("jobStatus", "number"),),
    methods=(
        MethodSpec(
            "mixPaint",
            "vipo/v1/dev/paintMixer02/down/mixPaint",
            "time",
            parameters=(ParameterSpec("time", "number", "MIN"),),
        ),
        MethodSpec(
            "dispense",
            "vipo/v1/dev/paintMixer02/down/dispense",
            "object",
            parameters=(ParameterSpec("object", "object"), ParameterSpec("value", "number")),
        ),
    ),
)


def test_figure_5_is_read_as_it_is_printed_and_says_what_was_mended() -> None:
    reading = read(FIGURE_5, device_id="paintMixer02")
    assert (reading.form, replace(reading.description, pose=PAINT_MIXER.pose)) == ("paper", PAINT_MIXER)
    assert reading.description.pose.z == pytest.approx(0.57)
    assert tuple(note.text for note in reading.notes) == (
        "Line 5: put the value of size in quotes: 'medium'.",
        "Line 11: put a colon behind methods.",
        "Line 14: put the value of topic_name in quotes: '/dev05_mixPaint'.",
        "Line 17: read 'topic name' as topic_name.",
        "Line 17: put the value of topic_name in quotes: '/dev05 dispense'.",
        "Left out imgUrl '/imgs/mixer.png': only an address with http:// or https:// can be shown.",
        "Left out the value of jobStatus: values come on up/state.",
        "Commands for mixPaint come on vipo/v1/dev/paintMixer02/down/mixPaint, not on the ROS topic '/dev05_mixPaint'.",
        "Commands for dispense come on vipo/v1/dev/paintMixer02/down/dispense, not on the ROS topic '/dev05 dispense'.",
    )


def test_the_papers_message_may_be_json_or_written_with_dashes() -> None:
    body = {
        "ID": "m1",
        "location": [1, 2, 0],
        "size": "small",
        "methods": [{"name": "go", "vipo_msg_type": "location"}],
        "colour": "red",
    }
    found = read(json.dumps(body).encode())
    assert tuple(note.text for note in found.notes) == (
        "Read 'ID' as id.",
        "Left out '/colour', which means nothing here.",
    )
    assert found.description == Description(
        "m1",
        "m1",
        "machine",
        "",
        Pose(1.0, 2.0),
        Size(0.5, 0.5, 0.5),
        methods=(
            MethodSpec("go", "vipo/v1/dev/m1/down/go", "location", parameters=(ParameterSpec("path", "location"),)),
        ),
    )
    text = (
        b"---\nid: m1\nlocation: [1, 2, 0]\nsize: small\nmethods: \n  - \n    vipo_msg_type: location\n    name: go\n"
    )
    assert read(text).description == found.description


@pytest.mark.parametrize(
    ("line", "text", "mended"),
    [
        ('name: "Mixer', "Mixer", True),
        ('name: Mixer"', "Mixer", True),
        ("name: 'Mixer'", "Mixer", True),
        ("name: “Mixer”", "Mixer", True),
        ("name: Bob\u2019s mixer", "Bob\u2019s mixer", True),
        ("name: Paint Mixer B", "Paint Mixer B", True),
        ('name "Mixer"', "Mixer", True),
        ('Name: "Mixer"', "Mixer", True),
        ('name: "Mix\\"er"', 'Mix"er', False),
        ('name: "It\'s"', "It's", False),
    ],
)
def test_quotes_and_spelling_are_mended_where_one_reading_is_possible(line: str, text: str, mended: bool) -> None:
    found = read(f'id: "m1"\n{line}\nlocation: [1, 2]\nsize: [1, 1, 1]\n'.encode())
    assert found.description.name == text
    assert bool(found.notes) == mended


@pytest.mark.parametrize(
    ("text", "line", "column", "says"),
    [
        ('id: "m1"\nname: "a" "b"\n', 2, 7, "value of name that cannot be read"),
        ('id: "m1"\nname: "a\', \'b"x\n', 2, 7, "value of name that cannot be read"),
        ('id: "m1"\nname: "a"\nname: "b"\n', 3, 7, "says name twice"),
        ('id: "m1"\nlocation: [1, NaN, 0]\nsize: small\n', 2, 11, "holds NaN"),
        ('id: "m1"\nlocation: [1, 1e999, 0]\nsize: small\n', 2, 11, "too large"),
        ('id: "m1"\nlocation: nan\nsize: small\n', 2, 11, "list of numbers for location"),
        ('id: 5\nname: "x"\n', 1, 5, "text in quotes for id"),
        ('id: "m1"\n  name: "x"\n', 2, 9, "set in under id"),
        ('id: "m1"\nmethods:\n  title: "x"\n', 3, 10, "needs name as the first line"),
        ('id: "m1"\n{{{\n', 2, 1, "not `key: value`"),
        ('id: "m1"\nsize: huge\nlocation: [1, 2]', 2, 7, "small, medium, large"),
        ('id: "m1"\nname: "\\ud800"\n', 2, 7, "not text"),
        ('id: "m1"\nlocation: [1, 2]\nsize: small\nkind: ship\n', 4, 7, "machine or robot"),
    ],
)
def test_what_could_mean_several_things_is_refused_with_its_line(text: str, line: int, column: int, says: str) -> None:
    with pytest.raises(BadDescription, match=says) as refusal:
        read(text.encode())
    assert [(fault.line, fault.column) for fault in refusal.value.faults] == [(line, column)]


FORM = {"href": "mqtts://broker.example/vipo/v1/dev/m1/down/dim"}


def test_somebody_elses_thing_is_read() -> None:
    body = {
        **THING,
        "@context": ["https://www.w3.org/2022/wot/td/v1.1", {"v": "urn:vipo:ns#", "saref": "https://w3id.org/saref#"}],
        "@type": ["saref:LightSwitch", "v:Machine"],
        "v:location": [3, 4],
        "properties": {"state": {"type": "string", "enum": ["on", "off"], "forms": [{"href": "coap://lamp/state"}]}},
        "actions": {"dim": {"input": {"type": "integer", "maximum": 100}, "forms": [{"href": "http://lamp"}, FORM]}},
        "events": {"broken": {"forms": [{"href": "coap://lamp/broken"}]}},
    }
    del body["vipo:location"]
    found = read(json.dumps(body).encode(), device_id="m1").description
    assert found == Description(
        "m1",
        "Lamp",
        "machine",
        "",
        Pose(3.0, 4.0),
        Size(1.0, 1.0, 1.0),
        properties=(PropertySpec("state", "text", options=("on", "off")),),
        methods=(
            MethodSpec("dim", "vipo/v1/dev/m1/down/dim", parameters=(ParameterSpec("value", "number", maximum=100.0),)),
        ),
    )


@pytest.mark.parametrize(
    ("base", "href", "topic"),
    [
        ("mqtt://broker/vipo/v1/dev/m1/down/", "dim", "vipo/v1/dev/m1/down/dim"),
        ("mqtts://broker:8883/vipo/v1/dev/m1/", "down/dim", "vipo/v1/dev/m1/down/dim"),
        ("mqtt://broker", "vipo/v1/dev/m1/down/dim", "vipo/v1/dev/m1/down/dim"),
        ("mqtt://broker/else/", "/vipo/v1/dev/m1/down/dim", "vipo/v1/dev/m1/down/dim"),
        ("mqtt://broker/else/", "mqtts://another/vipo/v1/dev/m1/down/dim", "vipo/v1/dev/m1/down/dim"),
        ("http://lamp.local/", "mqtt://broker/vipo/v1/dev/m1/down/dim", "vipo/v1/dev/m1/down/dim"),
    ],
)
def test_where_a_form_leads_to_is_told_within_the_base(base: str, href: str, topic: str) -> None:
    forms = [{"href": "http://lamp.local/dim"}, {"href": href}]
    found = read(json.dumps({**THING, "base": base, "actions": {"dim": {"forms": forms}}}).encode()).description
    assert [method.topic for method in found.methods] == [topic]


@pytest.mark.parametrize(("base", "href"), [("http://lamp.local/", "actions/dim"), ("", "http://["), ("http://[", "d")])
def test_a_form_that_leads_elsewhere_is_none_for_mqtt(base: str, href: str) -> None:
    actions = {"dim": {"forms": [{"href": href}]}}
    with pytest.raises(BadDescription, match="a form for MQTT"):
        read(json.dumps({**THING, "base": base, "actions": actions}).encode())


@pytest.mark.parametrize(
    ("schema", "spec"),
    [
        ({"type": "integer", "enum": [3, 1, 2]}, PropertySpec("a", "number", minimum=1, maximum=3)),
        ({"type": "number", "enum": [0, 5], "maximum": 4}, PropertySpec("a", "number", minimum=0, maximum=4)),
        ({"enum": [0.5, 1]}, PropertySpec("a", "number", minimum=0.5, maximum=1)),
        ({"enum": ["on", "off"]}, PropertySpec("a", "text", options=("on", "off"))),
        ({"type": "boolean", "enum": [True]}, PropertySpec("a", "boolean")),
        ({"const": "on"}, PropertySpec("a", "text", options=("on",))),
        ({"const": 0}, PropertySpec("a", "number", minimum=0, maximum=0)),
        ({"const": False}, PropertySpec("a", "boolean")),
        ({}, PropertySpec("a", "number")),
    ],
)
def test_a_value_of_which_only_a_few_are_allowed_is_read(schema: dict[str, object], spec: PropertySpec) -> None:
    thing = {**THING, "properties": {"a": {**schema, "forms": [FORM]}}}
    assert read(json.dumps(thing).encode()).description.properties == (spec,)


@pytest.mark.parametrize(
    ("change", "path", "says"),
    [
        ({"security": None}, "/security", "is not valid under any"),
        ({"actions": {"dim": {}}}, "/actions/dim", "'forms' is a required property"),
        ({"properties": {"a": {"forms": [{}]}}}, "/properties/a/forms/0", "'href' is a required property"),
        ({"vipo:location": [1]}, "/vipo:location", r"needs \[x, y, z, theta\]"),
        ({"vipo:size": "big"}, "/vipo:size", "needs a list of numbers"),
        ({"@type": "Lamp"}, "/@type", "either vipo:Machine or vipo:Robot"),
        ({"id": "urn:uuid:1"}, "/id", "urn:vipo:device:"),
        ({"actions": {"dim": {"forms": [{"href": "coap://x/dim"}]}}}, "/actions/dim/forms", "a form for MQTT"),
        (
            {"actions": {"dim": {"forms": [{**FORM, "mqv:topic": "vipo/v1/dev/m1/down/x"}]}}},
            "/actions/dim/forms/0/mqv:topic",
            "use one",
        ),
        (
            {"properties": {"a": {"type": "object", "forms": [FORM]}}},
            "/properties/a/type",
            "use number, string or boolean",
        ),
        ({"properties": {"a": {"enum": ["on", 1], "forms": [FORM]}}}, "/properties/a/enum", "a list of texts"),
        ({"vipo:capacity": 1.5}, "/vipo:capacity", "a whole number"),
        (
            {"@context": ["https://www.w3.org/2022/wot/td/v1.1", "https://a.example/c"]},
            "/@context",
            "is not known here",
        ),
        (
            {"@context": ["https://www.w3.org/2022/wot/td/v1.1", {"vipo": "urn:other#"}]},
            "/@context",
            "another meaning",
        ),
    ],
)
def test_a_thing_that_is_wrong_is_refused_with_the_path(change: dict[str, object], path: str, says: str) -> None:
    with pytest.raises(BadDescription, match=says) as refusal:
        read(json.dumps({**THING, **change}).encode())
    assert [fault.path for fault in refusal.value.faults] == [path]


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_a_damaged_message_brings_no_more_than_a_refusal(data: st.DataObject) -> None:
    source = data.draw(
        st.sampled_from([FIGURE_5, json.dumps({**THING, "actions": {"dim": {"forms": [FORM]}}}).encode()])
    )
    text = bytearray(source)
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at : at + data.draw(st.integers(0, 6))] = data.draw(st.binary(max_size=4))
    refusals = []
    try:
        read(bytes(text))
    except BadDescription as error:
        refusals.append(error.detail)
    assert all(detail.startswith("The description") for detail in refusals)


def test_the_examples_of_the_protocol_are_read() -> None:
    page = (ROOT / "docs" / "protocol.md").read_text()
    section = page[page.index("## Descriptions") :]
    examples = re.findall(r"```(json|text)\n((?:\{|id:).*?)```", section, re.DOTALL)
    found = [read(text.encode()) for _, text in examples]
    assert [(reading.form, reading.description.id) for reading in found] == [
        ("td", "lamp01"),
        ("paper", "paintMixer02"),
    ]
    assert found[0].description.methods[0].parameters == (ParameterSpec("value", "number", "PERCENT", 0.0, 100.0),)
    assert examples[1][1].encode() == FIGURE_5


def test_a_form_of_an_action_is_one_that_invokes_it() -> None:
    ask = {"href": "mqtts://broker.example/vipo/v1/dev/m1/down/status", "op": "queryaction"}
    found = read(_thing(actions={"dim": {"forms": [ask, {**FORM, "op": ["invokeaction"]}]}}), device_id="m1")
    assert [method.topic for method in found.description.methods] == ["vipo/v1/dev/m1/down/dim"]
    with pytest.raises(BadDescription, match="a form for MQTT"):
        read(_thing(actions={"dim": {"forms": [ask]}}), device_id="m1")


def test_a_brokers_address_needs_no_slash_at_its_end() -> None:
    lamp = read(_thing(actions={"dim": {"forms": [FORM]}}), device_id="m1").description
    written = write_description(lamp, "td", broker="mqtts://b:8883")
    assert "mqtts://b:8883/vipo/v1/dev/m1/down/dim" in written
    assert read(written.encode(), device_id="m1").description == lamp


@pytest.mark.parametrize("schema", ["https://schema.org/", "http://schema.org/"])
def test_limits_are_read_however_schema_org_is_written(schema: str) -> None:
    turtle = f"""@prefix schema: <{schema}> . @prefix vipo: <urn:vipo:ns#> . @prefix dct: <http://purl.org/dc/terms/> .
    @prefix td: <https://www.w3.org/2019/wot/td#> .
    <urn:vipo:device:m1> a vipo:Machine ; dct:identifier "m1" ; vipo:location ( 1 2 ) ; vipo:size ( 1 1 1 ) ;
      schema:image "https://a.example/m1.png" ;
      td:hasPropertyAffordance [ td:name "level" ; schema:minValue 0 ; schema:maxValue 5 ] ."""
    found = read(turtle.encode(), device_id="m1").description
    assert (found.image, found.properties) == (
        "https://a.example/m1.png",
        (PropertySpec("level", "number", minimum=0.0, maximum=5.0),),
    )
    context = ["https://www.w3.org/2022/wot/td/v1.1", {"vipo": "urn:vipo:ns#", "schema": schema}]
    thing = _thing(**{"@context": context, "schema:image": found.image})
    assert read(thing, device_id="m1").description.image == found.image


@pytest.mark.parametrize(
    ("written", "code"), [("percent", "PERCENT"), ("%", "PERCENT"), ("°C", "DEG_C"), ("m/s", "M-PER-SEC"), ("C", "C")]
)
def test_units_of_things_and_of_the_paper_are_taken_as_people_write_them(written: str, code: str) -> None:
    level = {"type": "number", "unit": written, "forms": [{"href": "coap://lamp/level"}]}
    found = read(_thing(properties={"level": level}), device_id="m1").description
    paper = f"id: m1\nlocation: [1, 2]\nsize: [1, 1, 1]\nproperties:\n- name: level\n  unit: {written}\n"
    assert [
        spec.unit for spec in (*found.properties, *read(paper.encode(), device_id="m1").description.properties)
    ] == [
        code,
        code,
    ]


def _thing(**said: object) -> bytes:
    return json.dumps({**THING, **said}).encode()
