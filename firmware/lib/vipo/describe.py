"""A device's description in Turtle, made from what its driver declares and what its configuration says of it."""

PREFIXES = b"""@prefix dct: <http://purl.org/dc/terms/> .
@prefix qudt: <http://qudt.org/schema/qudt/> .
@prefix schema: <https://schema.org/> .
@prefix sosa: <http://www.w3.org/ns/sosa/> .
@prefix td: <https://www.w3.org/2019/wot/td#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix vipo: <urn:vipo:ns#> .
"""


def describe(device, driver, about):
    """Return the description in bytes of the device with that id.

    `about` may hold name, about (a text), site, location [x, y, z, theta] in metres and radians, size [x, y, z] in
    metres, and simulated.
    """
    pieces = [PREFIXES, ("<urn:vipo:device:%s> a sosa:Actuator, td:Thing, vipo:Machine" % device).encode()]
    for fact in facts_of(device, driver, about):
        pieces.append(b" ;\n ")
        pieces.append(fact.encode())
    pieces.append(b" .\n")
    return b"".join(pieces)


def facts_of(device, driver, about):
    """Yield what is said of the device, one predicate with its object at a time."""
    yield "dct:identifier " + quote(device)
    yield "dct:title " + quote(about.get("name") or device)
    yield "dct:description " + quote(about.get("about") or driver.about)
    yield "vipo:deviceClass " + quote(driver.device_class)
    yield "vipo:location " + row(about.get("location") or (0, 0, 0, 0))
    yield "vipo:size " + row(about.get("size") or driver.size)
    yield "vipo:done true"
    if about.get("site", "+") != "+":
        yield "vipo:site " + quote(about["site"])
    if about.get("simulated"):
        yield "vipo:simulated true"
    for thing in driver.gives:
        yield "vipo:gives " + quote(thing)
    for thing in driver.takes:
        yield "vipo:takes " + quote(thing)
    for index, value in enumerate(driver.readings):
        yield "td:hasPropertyAffordance " + describe_value(value, index + 1)
    for index in range(len(driver.order)):
        yield describe_method(device, driver, index)


def describe_method(device, driver, index):
    """Return the triples of one of the driver's methods."""
    name = driver.order[index]
    declared = driver.methods[name]
    facts = [
        "td:name " + quote(name),
        "dct:title " + quote(declared["title"]),
        "schema:position %d" % (index + 1),
        "vipo:topic " + quote("vipo/v1/dev/%s/down/%s" % (device, name)),
    ]
    if declared["message"]:
        facts.append("vipo:messageType " + quote(declared["message"]))
    if declared["parameters"]:
        facts.append("vipo:parameters ( %s )" % " ".join([describe_value(p) for p in declared["parameters"]]))
    return "td:hasActionAffordance [ %s ]" % " ; ".join(facts)


def describe_value(value, position=0):
    """Return the triples of a property or a parameter; a property has its place among the others."""
    facts = ["td:name " + quote(value["name"]), "vipo:type " + quote(value["type"])]
    if position:
        facts.append("schema:position %d" % position)
    if value.get("title"):
        facts.append("dct:title " + quote(value["title"]))
    if value.get("unit"):
        facts.append("qudt:hasUnit unit:" + value["unit"])
    for key, word in (("least", "schema:minValue"), ("most", "schema:maxValue")):
        if value.get(key) is not None:
            facts.append("%s %s" % (word, float(value[key])))
    if value.get("options"):
        facts.append("vipo:options ( %s )" % " ".join([quote(option) for option in value["options"]]))
    return "[ %s ]" % " ; ".join(facts)


def row(numbers):
    """Return numbers as an RDF list."""
    return "( %s )" % " ".join([str(float(number)) for number in numbers])


def quote(text):
    """Return a Turtle string; a configuration has no control characters."""
    return '"%s"' % text.replace("\\", "\\\\").replace('"', '\\"')
