"""Maps for a site: as a robot sends them, as somebody brings them, and what they replace."""

from datetime import UTC, datetime, timedelta

from django.core.files.uploadedfile import SimpleUploadedFile

from registry import services as registry
from registry.floorplan.map_server import write_pgm, write_yaml
from registry.floorplan.plan import Grid
from tests.kit import demo_floor
from tests.kit.programs import SITE
from tests.kit.sign_in import post_json
from tests.unit.robot_agent.agent import RobotGrid, write_grid

AT = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
PLAN = demo_floor.grid()
MARGIN = 8


def widened(grid=PLAN, cells=None):
    """Return the grid with unknown cells all round, as a robot's map has them: every cell gets another number."""
    rows = [grid.cells[row * grid.width : (row + 1) * grid.width] for row in range(grid.height)]
    side, width = b"\xff" * MARGIN, grid.width + 2 * MARGIN
    empty = [b"\xff" * width] * MARGIN
    origin = (grid.origin_x_m - MARGIN * grid.resolution_m, grid.origin_y_m - MARGIN * grid.resolution_m)
    whole = b"".join([*empty, *(side + row + side for row in rows), *empty])
    return Grid(width, grid.height + 2 * MARGIN, grid.resolution_m, *origin, whole)


def say_map(grid, number=1, robot="robot01"):
    said = RobotGrid(grid.width, grid.height, grid.resolution_m, (grid.origin_x_m, grid.origin_y_m, 0.0), grid.cells)
    at = AT + timedelta(seconds=20 * number)
    for message in write_grid(said, 1, number):
        registry.ingest_map_part(device_id=robot, payload=message, at=at)


def use(client, version=1, replaces=1, robot="robot01"):
    return post_json(
        client, f"/api/sites/{SITE}/map/from-device", {"device": robot, "version": version, "replaces": replaces}
    )


def walled(x1, y1, x2, y2):
    """Return the plan with a block of wall; metres."""
    cells = bytearray(PLAN.cells)
    (row1, column1), (row2, column2) = PLAN.cell_of(x1, y1), PLAN.cell_of(x2, y2)
    for row in range(row1, row2):
        cells[row * PLAN.width + column1 : row * PLAN.width + column2] = b"\x64" * (column2 - column1)
    return Grid(PLAN.width, PLAN.height, PLAN.resolution_m, PLAN.origin_x_m, PLAN.origin_y_m, bytes(cells))


def packed(grid):
    """Return a grid as the two files of a map, as a form sends them."""
    return {
        "yaml": SimpleUploadedFile("m.yaml", write_yaml(grid, "m.pgm")),
        "image": SimpleUploadedFile("m.pgm", write_pgm(grid)),
    }


def tag_of(client):
    return client.get(f"/api/sites/{SITE}/map/cells")["ETag"]


def bring(client, grid, tag=None, source="edit", path="map/upload"):
    """Bring a map in the place of the one with the tag: None stands for the one that holds, empty for no word of it."""
    tag = tag_of(client) if tag is None else tag
    headers = {"If-Match": tag} if tag else {}
    return client.post(f"/api/sites/{SITE}/{path}", {"source": source, **packed(grid)}, headers=headers)
