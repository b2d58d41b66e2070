"""The sites of the programs of the field, a hospital and a warehouse: `python scripts/example_sites.py` writes them."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from registry.demo.factory import make_grid  # noqa: E402
from registry.floorplan.map_server import write_pgm, write_yaml  # noqa: E402
from scripts.example_devices import Door, Machine, Robot, Spot, free, stock  # noqa: E402
from vipo_device.protocol.description import PropertySpec, Scalar, description_to_json  # noqa: E402

FOLDER = ROOT / "examples" / "field"
EAST_M, SOUTH_M = 26.0, 16.0
OUTLINE = [[0, 0], [EAST_M, 0], [EAST_M, SOUTH_M], [0, SOUTH_M]]
Plan = Mapping[str, Any]


@dataclass(frozen=True)
class Example:
    """A site: its floor (metres, y downwards), devices, places (id: name, kind, x, y) and first readings.

    `labels` says where the map writes the names of rooms.
    """

    id: str
    plan: Plan
    devices: tuple[Door | Machine | Robot, ...]
    places: Mapping[str, tuple[str, str, float, float]]
    readings: Mapping[str, Mapping[str, Scalar]] = field(default_factory=dict)
    labels: Mapping[str, Spot] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """Return the site file."""
        devices = [
            description_to_json(each.describe(self.id))
            | ({"readings": dict(self.readings[each.id])} if each.id in self.readings else {})
            for each in self.devices
        ]
        places = [
            {
                "id": key,
                "name": name,
                "kind": kind,
                "x": x,
                "y": -y,
                "theta": round(pi / 2, 4) if kind == "dock" else 0.0,
            }
            for key, (name, kind, x, y) in self.places.items()
        ]
        return {"devices": devices, "places": places, "grid": {"yaml": f"{self.id}.yaml"}}


def _outer_walls() -> list[list[float]]:
    return [
        [0, 0, EAST_M, 0, 0.2],
        [EAST_M, 0, EAST_M, SOUTH_M, 0.2],
        [0, SOUTH_M, EAST_M, SOUTH_M, 0.2],
        [0, 0, 0, SOUTH_M, 0.2],
    ]


TEMPERATURE = PropertySpec("temperature", "number", "DEG_C", 15.0, 120.0, "Temperature")
HOSPITAL_DEVICES: tuple[Door | Machine | Robot, ...] = (
    Machine(
        "pharmacy",
        "Pharmacy",
        "shelf",
        (2.6, 1.2),
        (2.6, 1.2),
        "Hands out medicine.",
        gives="medicine",
        readings=stock(24),
    ),
    Machine(
        "returns",
        "Returns",
        "rollers",
        (6.8, 1.2),
        (1.5, 1.2),
        "Takes medicine back.",
        takes="medicine",
        readings=free(9),
    ),
    Machine(
        "sampleRack",
        "Sample Rack",
        "shelf",
        (10.2, 1.2),
        (1.6, 1.2),
        "Keeps samples.",
        gives="sample",
        readings=stock(24),
    ),
    Machine(
        "dryingOven",
        "Drying Oven",
        "oven",
        (13.0, 1.2),
        (1.8, 1.4),
        "Dries samples for the given time.",
        gives="sample",
        takes="sample",
        readings=(TEMPERATURE,),
        job=("dry", "Dry", "MIN", 60.0),
    ),
    Machine(
        "archive",
        "Sample Archive",
        "rollers",
        (16.0, 1.2),
        (1.6, 1.2),
        "Takes finished samples.",
        takes="sample",
        readings=free(9),
    ),
    Machine(
        "trayA",
        "Tray Ward A",
        "rollers",
        (23.6, 1.2),
        (1.8, 1.2),
        "Takes medicine.",
        takes="medicine",
        readings=free(9),
    ),
    Machine(
        "trayB",
        "Tray Ward B",
        "rollers",
        (10.2, 14.2),
        (1.8, 1.2),
        "Takes medicine.",
        takes="medicine",
        readings=free(9),
    ),
    Door("wardADoor", "Ward A Door", (20.5, 6.4), (0.5, 0.24), "Opens Ward A to the corridor."),
    Robot("courier01", "Courier 1", (1.6, 14.2), "Carries up to two objects."),
    Robot("courier02", "Courier 2", (3.6, 14.2), "Carries up to two objects."),
    Robot("cleaner01", "Cleaner", (5.6, 14.2), "Cleans the floor where it stands.", cleans=True),
)
HOSPITAL_PLACES = {
    "pharmacyRoom": ("Pharmacy", "room", 4.3, 5.2),
    "laboratory": ("Laboratory", "room", 13.0, 5.2),
    "wardA": ("Ward A", "room", 21.7, 5.2),
    "wardB": ("Ward B", "room", 13.0, 10.4),
    "reception": ("Reception", "room", 21.7, 10.4),
    "corridor": ("Corridor", "room", 8.6, 7.7),
    "dock1": ("Dock 1", "dock", 1.6, 14.2),
    "dock2": ("Dock 2", "dock", 3.6, 14.2),
    "dock3": ("Dock 3", "dock", 5.6, 14.2),
}
HOSPITAL_LABELS = {
    "pharmacyRoom": (0.5, 6.0),
    "laboratory": (9.0, 6.0),
    "wardA": (17.8, 0.7),
    "wardB": (9.0, 9.6),
    "reception": (17.8, 9.45),
    "corridor": (0.5, 8.5),
}


def hospital() -> Example:
    """Return a ward floor: pharmacy, laboratory and two wards on a corridor, couriers and a cleaning robot."""
    walls = _outer_walls()
    walls += [[x, a, x, b, 0.15] for x in (8.6, 17.4) for a, b in ((0, 6.4), (9.0, SOUTH_M))]
    walls += [[a, y, b, y, 0.15] for a, b in ((0, 3.4), (5.2, 12.1), (13.9, 20.8), (22.6, EAST_M)) for y in (6.4, 9.0)]
    plan = {"outline": OUTLINE, "walls": walls, "columns": []}
    return Example("hospital", plan, HOSPITAL_DEVICES, HOSPITAL_PLACES, labels=HOSPITAL_LABELS)


WRAPS, PRINTS = ("wrap", "Wrap", "MIN", 20.0), ("printLabels", "Print labels", "MIN", 20.0)
PICK_FACES = [
    Machine(
        f"face{c}",
        f"Pick Face {c}",
        "shelf",
        (x, 7.6),
        (1.8, 1.0),
        "Takes cartons.",
        takes="carton",
        readings=free(12),
    )
    for c, x in (("A", 10.6), ("B", 14.2), ("C", 17.8))
]
PART_BINS = [
    Machine(
        f"bin{c}",
        f"Part Bin {c}",
        "cans",
        (x, 14.2),
        (1.4, 0.9),
        "Hands out parts.",
        gives="part",
        readings=stock(24),
    )
    for c, x in (("A", 10.4), ("B", 13.4), ("C", 16.4))
]
WAREHOUSE_DEVICES: tuple[Machine | Robot, ...] = (
    Machine(
        "goodsIn",
        "Goods In",
        "shelf",
        (2.4, 1.3),
        (2.4, 1.2),
        "Hands out cartons.",
        gives="carton",
        readings=stock(24),
    ),
    Machine(
        "reserve",
        "Reserve Rack",
        "shelf",
        (12.0, 1.3),
        (6.0, 1.2),
        "Keeps cartons; takes and gives them.",
        gives="carton",
        takes="carton",
        capacity=60,
        readings=stock(60),
    ),
    *PICK_FACES,
    *PART_BINS,
    Machine(
        "kitting",
        "Kitting Station",
        "rollers",
        (21.0, 14.2),
        (2.2, 1.3),
        "Takes parts.",
        takes="part",
        readings=free(12),
    ),
    Machine("printer01", "Label Printer 1", "machine", (19.6, 1.4), (1.4, 1.0), "Prints labels.", job=PRINTS),
    Machine("printer02", "Label Printer 2", "machine", (23.8, 1.4), (1.4, 1.0), "Prints labels.", job=PRINTS),
    Machine(
        "wrapper",
        "Stretch Wrapper",
        "booth",
        (23.2, 6.4),
        (1.8, 1.4),
        "Wraps a carton.",
        gives="carton",
        takes="carton",
        job=WRAPS,
    ),
    Machine(
        "dispatch",
        "Dispatch",
        "rollers",
        (23.4, 11.4),
        (1.8, 1.4),
        "Takes cartons.",
        takes="carton",
        readings=free(9),
    ),
    *(
        Robot(f"amr0{n}", f"AMR {n}", (x, 14.2), "Carries up to two objects.")
        for n, x in ((1, 1.6), (2, 3.6), (3, 5.6))
    ),
)
WAREHOUSE_PLACES = {
    "receiving": ("Receiving", "room", 2.4, 4.4),
    "aisle": ("Aisle", "room", 12.0, 4.6),
    "labels": ("Labels", "room", 21.7, 4.4),
    "shipping": ("Shipping", "room", 20.4, 10.8),
    "assembly": ("Assembly", "room", 12.6, 11.8),
    "dock1": ("Dock 1", "dock", 1.6, 14.2),
    "dock2": ("Dock 2", "dock", 3.6, 14.2),
    "dock3": ("Dock 3", "dock", 5.6, 14.2),
}
WAREHOUSE_LABELS = {
    "receiving": (4.4, 0.6),
    "aisle": (15.9, 0.6),
    "labels": (21.1, 0.6),
    "shipping": (23.8, 13.0),
    "assembly": (17.6, 15.4),
}
WAREHOUSE_READINGS = {
    "reserve": {"stock": 30},
    "amr01": {"battery": 24},
    "amr02": {"battery": 40},
    "amr03": {"battery": 18},
}


def warehouse() -> Example:
    """Return a hall with a rack, pick faces, bins of parts, label printers and a wrapper; three mobile robots."""
    plan = {"outline": OUTLINE, "walls": _outer_walls(), "columns": []}
    return Example("warehouse", plan, WAREHOUSE_DEVICES, WAREHOUSE_PLACES, WAREHOUSE_READINGS, WAREHOUSE_LABELS)


def write(example: Example, folder: Path = FOLDER) -> None:
    """Write a site file and its map."""
    folder.mkdir(parents=True, exist_ok=True)
    grid = make_grid(dict(example.plan))
    (folder / f"{example.id}.json").write_text(json.dumps(example.to_json(), indent=1) + "\n")
    (folder / f"{example.id}.pgm").write_bytes(write_pgm(grid))
    (folder / f"{example.id}.yaml").write_bytes(write_yaml(grid, f"{example.id}.pgm"))


if __name__ == "__main__":
    for site in (hospital(), warehouse()):
        write(site)
