"""DXF drawings: what is wall in them as lines by layer, and files that want too much."""

import io
import os
import re
from itertools import pairwise

import ezdxf
import pytest

from registry.maps import drawing_reader
from registry.maps.drawing_reader import Refused, read_drawing


def packed(drawing):
    file = io.StringIO()
    drawing.write(file)
    return file.getvalue().encode()


def new(unit=4):
    drawing = ezdxf.new()
    drawing.units = unit
    return drawing, drawing.modelspace()


def lines_of(read, layer):
    return next(each["lines"] for each in read["layers"] if each["name"] == layer)


def test_lines_and_polylines_come_by_layer_in_the_drawings_unit():
    drawing, space = new()
    drawing.layers.add("OLD").off()
    space.add_line((0, 0), (1000, 0), dxfattribs={"layer": "OLD"})
    space.add_lwpolyline([(0, 0), (10, 0), (10, 8)], close=True, dxfattribs={"layer": "WALLS"})
    space.add_text("Hall")
    read = read_drawing(packed(drawing))
    assert (read["metres"], read["skipped"]) == (0.001, {"TEXT": 1})
    assert [(layer["name"], layer["hidden"]) for layer in read["layers"]] == [("OLD", True), ("WALLS", False)]
    assert lines_of(read, "OLD") == [[0, 0, 1000, 0]]
    assert lines_of(read, "WALLS") == [[0, 0, 10, 0, 10, 8, 0, 0]]


@pytest.mark.parametrize(("unit", "metres"), [(0, None), (1, 0.0254), (5, 0.01), (6, 1.0), (13, None)])
def test_the_unit_is_the_headers_or_to_be_asked(unit, metres):
    drawing, space = new(unit)
    space.add_line((0, 0), (1, 0))
    assert read_drawing(packed(drawing))["metres"] == metres


@pytest.mark.parametrize("ends", [b"\n", b"\r\n"])
@pytest.mark.parametrize(
    ("version", "coding", "name"),
    [("R2010", "utf-8", "MÖBEL"), ("R2010", "latin-1", "MÖBEL"), ("R2000", "latin-1", "MÖBEL")],
)
def test_names_of_layers_are_read_where_no_code_page_is_named(version, coding, name, ends):
    drawing = ezdxf.new(version)
    drawing.modelspace().add_line((0, 0), (1, 0), dxfattribs={"layer": name})
    text = packed(drawing).decode()
    named = re.search(r"  9\n\$DWGCODEPAGE\n  3\n\w+\n", text)
    without = (text[: named.start()] + text[named.end() :]).encode(coding)
    (layer,) = read_drawing(without.replace(b"\n", ends))["layers"]
    assert (layer["name"], layer["lines"]) == (name, [[0, 0, 1, 0]])


def test_curves_become_lines_that_stay_near_them():
    drawing, space = new()
    space.add_circle((50, 20), 10)
    space.add_arc((0, 0), 5, 0, 90)
    space.add_ellipse((0, 0), (8, 0), 0.5)
    space.add_spline([(0, 0), (4, 6), (9, 1)])
    space.add_lwpolyline([(0, 0, 1), (4, 0, 0)], format="xyb")
    circle, arc, *others = lines_of(read_drawing(packed(drawing)), "0")
    for line, (x, y), radius in ((circle, (50, 20), 10), (arc, (0, 0), 5)):
        points = list(zip(line[::2], line[1::2], strict=True))
        middles = [((a + c) / 2, (b + d) / 2) for (a, b), (c, d) in pairwise(points)]
        assert all(abs(((a - x) ** 2 + (b - y) ** 2) ** 0.5 - radius) < radius * 0.01 for a, b in points + middles)
    assert len(others) == 3


def test_blocks_are_drawn_where_they_stand_on_the_layer_of_their_insert():
    drawing, space = new()
    inner, outer = drawing.blocks.new("POST"), drawing.blocks.new("PAIR")
    inner.add_line((0, 0), (1, 0))
    inner.add_line((0, 0), (0, 1), dxfattribs={"layer": "DOORS"})
    outer.add_blockref("POST", (0, 0))
    outer.add_blockref("POST", (10, 0))
    space.add_blockref("PAIR", (100, 50), dxfattribs={"layer": "WALLS", "xscale": 2, "rotation": 90})
    space.add_blockref("POST", (0, 0), dxfattribs={"column_count": 3, "column_spacing": 5})
    read = read_drawing(packed(drawing))
    assert [[round(v, 3) for v in line] for line in lines_of(read, "WALLS")] == [[100, 50, 100, 52], [100, 70, 100, 72]]
    assert lines_of(read, "0") == [[0, 0, 1, 0], [5, 0, 6, 0], [10, 0, 11, 0]]
    assert len(lines_of(read, "DOORS")) == 5


def test_a_block_of_another_file_and_one_that_is_nowhere_are_counted_as_left_out():
    drawing, space = new()
    drawing.add_xref_def("hall.dxf", "HALL")
    space.add_blockref("HALL", (0, 0))
    space.add_blockref("NOWHERE", (0, 0))
    space.add_blockref("NOWHERE", (5, 0))
    space.add_line((0, 0), (5, 0))
    space.add_linear_dim((0, 1), (0, 0), (5, 0))  # it has no picture of its own, which is no block
    assert read_drawing(packed(drawing))["skipped"] == {"XREF": 1, "INSERT": 2}


def test_a_drawing_whose_walls_all_lie_in_other_files_says_so():
    drawing, space = new()
    drawing.add_xref_def("hall.dxf", "HALL")
    space.add_blockref("HALL", (0, 0))
    space.add_blockref("NOWHERE", (0, 0))
    with pytest.raises(Refused, match=r"\(2\) lie in other files or nowhere. Bind them into the drawing"):
        read_drawing(packed(drawing))


def test_a_drawing_that_is_cut_off_before_its_lines_is_damaged_one_without_lines_is_not():
    drawing, space = new()
    empty = packed(drawing)
    space.add_line((0, 0), (5, 0))
    whole = packed(drawing)
    with pytest.raises(Refused, match="or it is damaged"):
        read_drawing(whole[: whole.index(b"ENTITIES")])
    with pytest.raises(Refused, match="no lines in its model space"):
        read_drawing(empty)


def test_blocks_that_stand_for_too_many_are_refused_before_they_are_drawn(monkeypatch):
    monkeypatch.setattr(drawing_reader, "MOST_ENTITIES", 2000)
    drawing, space = new()
    drawing.blocks.new("B0").add_line((0, 0), (1, 1))
    for depth in range(1, 9):
        block = drawing.blocks.new(f"B{depth}")
        for place in range(10):
            block.add_blockref(f"B{depth - 1}", (place, 0))
    space.add_blockref("B8", (0, 0))
    with pytest.raises(Refused, match="more than 2000 parts"):
        read_drawing(packed(drawing))


def test_a_block_that_is_repeated_or_stands_in_itself_is_refused():
    drawing, space = new()
    block = drawing.blocks.new("S")
    block.add_line((0, 0), (1, 0))
    grid = {"column_count": 30000, "row_count": 30000, "column_spacing": 2, "row_spacing": 2}
    insert = space.add_blockref("S", (0, 0), dxfattribs=grid)
    with pytest.raises(Refused, match="repeated 900000000 times"):
        read_drawing(packed(drawing))
    space.delete_entity(insert)
    block.add_blockref("S", (1, 0))
    space.add_blockref("S", (0, 0))
    with pytest.raises(Refused, match="12 deep"):
        read_drawing(packed(drawing))


def test_too_many_corners_and_layers_are_refused(monkeypatch):
    monkeypatch.setattr(drawing_reader, "MOST_POINTS", 30)
    monkeypatch.setattr(drawing_reader, "MOST_LAYERS", 3)
    drawing, space = new()
    space.add_circle((0, 0), 5)
    space.add_circle((9, 0), 5)
    with pytest.raises(Refused, match="30 corners"):
        read_drawing(packed(drawing))
    drawing, space = new()
    for number in range(4):
        space.add_line((0, 0), (1, 0), dxfattribs={"layer": f"L{number}"})
    with pytest.raises(Refused, match="3 layers"):
        read_drawing(packed(drawing))


def test_a_drawing_without_lines_is_refused():
    drawing, space = new()
    space.add_text("Hall")
    with pytest.raises(Refused, match="no lines"):
        read_drawing(packed(drawing))


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"AC1032\x00\x00", "DWG"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00", "binary DXF"),
        (b"", "no DXF drawing"),
        (b"GIF89a" + bytes(200), "no DXF drawing"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n 10\nnone\n", "DXF|no lines"),
        (b"0\nSECTION\n" * 500, "DXF|no lines"),
        (os.urandom(20_000), "DXF|no lines"),
    ],
)
def test_what_is_no_drawing_is_refused_in_a_sentence(data, told):
    with pytest.raises(Refused, match=told):
        read_drawing(data)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8, 0.95])
def test_a_drawing_that_is_cut_off_gives_what_is_there_or_is_refused(share):
    drawing, space = new()
    for number in range(50):
        space.add_line((number, 0), (number, 5))
    whole = packed(drawing)
    told = ""
    try:
        assert read_drawing(whole[: int(len(whole) * share)])["layers"]
    except Refused as refusal:
        told = str(refusal)
    assert told == "" or "DXF" in told or "no lines" in told


def test_a_drawing_in_millimetres_of_a_countrys_survey_is_read():
    drawing, space = new()
    space.add_line((5e8, 5.8e9), (5e8 + 1000, 5.8e9))
    space.add_line((0, 0), (1e12, 0))
    read = read_drawing(packed(drawing))
    assert (read["skipped"], lines_of(read, "0")) == ({"FAR": 1}, [[5e8, 5.8e9, 5e8 + 1000, 5.8e9]])


def test_a_drawing_whose_lines_all_lie_too_far_out_says_so():
    drawing, space = new()
    space.add_line((0, 0), (1e300, 0))
    with pytest.raises(Refused, match="All 1 lines lie farther than 1e\\+11 units from the drawing's origin"):
        read_drawing(packed(drawing))
