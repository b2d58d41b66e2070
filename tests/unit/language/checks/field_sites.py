"""Two sites beside the painting factory: a hospital with its laboratory, and a warehouse.

Their devices have units, capacities, methods and kinds of values that the factory's have not.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from editor.language.site.surroundings import DeviceFacts, PlaceFacts, Surroundings
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, PropertySpec, Size

SIZE = Size(1.2, 1.2, 1.5)
BATTERY = PropertySpec("battery", "number", "PERCENT", 0, 100)


def measured(name: str, unit: str, minimum: float, maximum: float) -> PropertySpec:
    """Return a reading that is a number in a unit, "" for one that is not said and "NUM" for a count."""
    return PropertySpec(name, "number", unit, minimum, maximum)


def said(name: str, *options: str) -> PropertySpec:
    """Return a reading that is one of some texts."""
    return PropertySpec(name, "text", options=options)


def yes_or_no(name: str) -> PropertySpec:
    """Return a reading that is True or False."""
    return PropertySpec(name, "boolean")


def method(name: str, *parameters: ParameterSpec) -> MethodSpec:
    """Return a method with these parameters."""
    return MethodSpec(name, f"vipo/v1/down/{name}", parameters=parameters)


def number(name: str, unit: str, minimum: float, maximum: float) -> ParameterSpec:
    """Return an argument that is a number."""
    return ParameterSpec(name, "number", unit, minimum, maximum)


def choice(name: str, *options: str) -> ParameterSpec:
    """Return an argument that is a text, one of some if they are given."""
    return ParameterSpec(name, "text", options=options)


def machine(name: str, *offers: PropertySpec | MethodSpec, gives: str = "", takes: str = "") -> DeviceFacts:
    """Return a machine; what it gives and takes is written with commas."""
    return DeviceFacts(_described(name, "machine", offers, gives=_listed(gives), takes=_listed(takes)))


def robot(name: str, capacity: int, *offers: PropertySpec | MethodSpec) -> DeviceFacts:
    """Return a robot that moves, and picks and drops if it can carry anything."""
    carried = number("value", "", 1, capacity)
    thing = (ParameterSpec("device", "device"), ParameterSpec("object", "object"), carried)
    hands = (method("pick", *thing), method("drop", *thing)) if capacity else ()
    moves = method("move", ParameterSpec("path", "location"))
    return DeviceFacts(_described(name, "robot", (moves, *hands, *offers), capacity=capacity))


def _listed(text: str) -> tuple[str, ...]:
    return tuple(each.strip() for each in text.split(",") if each.strip())


def _described(name: str, kind: Any, offers: tuple[PropertySpec | MethodSpec, ...], **more: Any) -> Description:
    properties = tuple(each for each in offers if isinstance(each, PropertySpec))
    methods = tuple(each for each in offers if isinstance(each, MethodSpec))
    moving: dict[str, Any] = {"radius_m": 0.3, "speed_m_s": 0.8} if kind == "robot" else {}
    pose = Pose(0.0, 0.0)
    return Description(name, name, kind, "device", pose, SIZE, properties=properties, methods=methods, **moving, **more)


def _site(devices: tuple[DeviceFacts, ...], rooms: str, docks: str) -> Surroundings:
    places = [PlaceFacts(name, name, "room", 2.0 * at, -3.0) for at, name in enumerate(_listed(rooms))]
    places += [PlaceFacts(name, name, "dock", 2.0 * at, -8.0) for at, name in enumerate(_listed(docks))]
    return Surroundings({each.description.id: each for each in devices}, {each.id: each for each in places})


WARD = (measured("freeSlots", "NUM", 0, 12), yes_or_no("call"), measured("occupancy", "PERCENT", 0, 100))
GOODS_OF_A_WARD = "medicine, infusion, meal, linen, tray"
CHARGE = method("charge", number("level", "PERCENT", 20, 100))
CART = (
    BATTERY,
    measured("temperature", "DEG_C", -10, 60),
    yes_or_no("drawerOpen"),
    method("lift", number("height", "MilliM", 50, 300)),
    method("speak", choice("text")),
    CHARGE,
)


@lru_cache(maxsize=1)
def hospital() -> Surroundings:
    """Return a hospital with a pharmacy, wards, a laboratory and a sterile store."""
    return _site(
        (
            machine(
                "pharmacy",
                measured("stock", "NUM", 0, 200),
                measured("temperature", "DEG_C", 2, 40),
                method("dispense", ParameterSpec("object", "object"), number("value", "", 1, 20)),
                gives="medicine, infusion",
            ),
            machine("kitchen", measured("waiting", "NUM", 0, 60), gives="meal"),
            machine("wardA", *WARD, gives="used tray, sample, laundry", takes=GOODS_OF_A_WARD),
            machine("wardB", *WARD, gives="used tray, sample, laundry", takes=GOODS_OF_A_WARD),
            machine("icu", yes_or_no("call"), gives="sample", takes="medicine, infusion, blood bag"),
            machine(
                "analyzer",
                measured("queue", "NUM", 0, 50),
                said("result", "pending", "negative", "positive", "invalid"),
                measured("left", "MIN", 0, 120),
                method("analyze", choice("program", "blood", "urine", "culture"), number("repeats", "NUM", 1, 5)),
                takes="sample",
            ),
            machine(
                "centrifuge",
                measured("speed", "REV-PER-MIN", 0, 15000),
                measured("vibration", "MilliM-PER-SEC", 0, 50),
                yes_or_no("lidOpen"),
                method("spin", number("speed", "REV-PER-MIN", 500, 15000), number("time", "SEC", 30, 3600)),
                gives="sample",
                takes="sample",
            ),
            machine(
                "autoclave",
                measured("temperature", "DEG_C", 10, 150),
                measured("pressure", "KiloPA", 0, 400),
                said("phase", "idle", "heating", "holding", "drying", "done"),
                yes_or_no("doorOpen"),
                method("sterilize", number("temperature", "DEG_C", 105, 138), number("time", "MIN", 3, 60)),
                gives="tray",
                takes="used tray",
            ),
            machine(
                "bloodBank",
                measured("temperature", "DEG_C", -10, 30),
                measured("stock", "NUM", 0, 80),
                yes_or_no("doorOpen"),
                method("defrost", number("time", "MIN", 5, 60)),
                gives="blood bag",
            ),
            machine(
                "laundry",
                measured("humidity", "PERCENT", 0, 100),
                method("wash", number("temperature", "DEG_C", 30, 95), choice("programme", "short", "hygiene")),
                gives="linen",
                takes="laundry",
            ),
            machine(
                "lift",
                measured("floor", "NUM", 0, 6),
                yes_or_no("moving"),
                method("goTo", number("floor", "NUM", 0, 6)),
                method("hold", number("time", "SEC", 5, 120)),
            ),
            machine("door", yes_or_no("open"), method("unlock"), method("close")),
            machine(
                "airUnit",
                measured("co2", "PPM", 300, 5000),
                measured("humidity", "PERCENT", 0, 100),
                measured("pressure", "PA", -50, 50),
                method("setFan", number("level", "PERCENT", 0, 100)),
            ),
            machine(
                "alarm",
                method("sound", number("time", "SEC", 1, 60)),
                method("light", choice("colour", "red", "green")),
            ),
            machine(
                "meter",
                measured("power", "KiloW", 0, 500),
                measured("voltage", "V", 0, 260),
                measured("current", "A", 0, 100),
                measured("energy", "KiloW-HR", 0, 1_000_000),
            ),
            machine("scale", measured("weight", "KiloGM", 0, 200), method("tare")),
            robot("cart01", 6, *CART),
            robot("cart02", 6, *CART),
            robot("courier01", 1, *CART, method("unlock")),
            robot(
                "scrubber01",
                0,
                BATTERY,
                CHARGE,
                measured("tank", "L", 0, 20),
                method("scrub", number("time", "MIN", 1, 60)),
            ),
        ),
        "hall, corridorA, corridorB, isolation, entrance, theatreDoor",
        "charger1, charger2, charger3",
    )


TRUCK = (
    BATTERY,
    measured("speed", "M-PER-SEC", 0, 3),
    measured("voltage", "V", 0, 60),
    method("beep", number("times", "NUM", 1, 10)),
    CHARGE,
)
FORK = method("raiseFork", number("height", "MilliM", 0, 6000))
RACK = (measured("free", "NUM", 0, 120), measured("fill", "PERCENT", 0, 100))
PACK = (
    measured("queue", "NUM", 0, 10),
    yes_or_no("ready"),
    method("pack", choice("size", "S", "M", "L"), number("parts", "NUM", 1, 12)),
)


@lru_cache(maxsize=1)
def warehouse() -> Surroundings:
    """Return a warehouse with racks, a cold store, packing, a sorter and shipping."""
    return _site(
        (
            machine("goodsIn", measured("arrived", "NUM", 0, 40), yes_or_no("truckThere"), gives="carton, pallet"),
            *(machine(f"rack{each}", *RACK, gives="carton", takes="carton") for each in "ABC"),
            machine(
                "coldStore",
                measured("temperature", "DEG_C", -30, 10),
                yes_or_no("doorOpen"),
                gives="frozen carton",
                takes="frozen carton",
            ),
            *(machine(f"pack{each}", *PACK, gives="parcel", takes="carton, frozen carton, label") for each in "12"),
            machine(
                "printer",
                measured("paper", "NUM", 0, 500),
                method("printLabel", choice("text"), number("copies", "NUM", 1, 20)),
                gives="label",
            ),
            machine(
                "shipping",
                measured("freeSlots", "NUM", 0, 30),
                method("accept", ParameterSpec("object", "object"), number("value", "", 1, 10)),
                takes="parcel, pallet",
            ),
            machine(
                "sorter",
                measured("speed", "M-PER-SEC", 0, 2.5),
                yes_or_no("jam"),
                measured("motorTemperature", "DEG_C", 0, 120),
                method("run", number("speed", "M-PER-SEC", 0.1, 2.5), number("time", "SEC", 1, 600)),
                method("stop"),
                takes="parcel",
            ),
            machine(
                "wrapper",
                measured("film", "M", 0, 500),
                method("wrap", number("turns", "NUM", 1, 12)),
                gives="pallet",
                takes="pallet",
            ),
            machine("gate", yes_or_no("open"), method("raise"), method("close")),
            machine("palletScale", measured("weight", "KiloGM", 0, 1500), gives="pallet", takes="pallet"),
            machine("weather", measured("wind", "M-PER-SEC", 0, 40), measured("light", "LUX", 0, 100_000)),
            robot("forklift01", 1, *TRUCK, FORK),
            robot("forklift02", 1, *TRUCK, FORK),
            *(robot(f"picker0{each}", 4, *TRUCK) for each in (1, 2, 3)),
            robot(
                "scanner01",
                0,
                BATTERY,
                CHARGE,
                method("scan", choice("aisle", "A", "B", "C"), number("time", "SEC", 5, 300)),
            ),
        ),
        "aisleA, aisleB, aisleC, yard, office",
        "charger1, charger2, charger3, charger4",
    )
