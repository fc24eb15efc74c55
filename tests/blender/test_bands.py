# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stored bands are those of core, geometry comes back from them, and nothing else changes."""

import bpy
import meshes
import numpy as np
import pytest
from framelet.core import BANKS, SurfaceMesh, connect, make_transform
from framelet.core.mesh.geometry import mean_edge_length
from framelet.core.settings.frame_catalog import FRAME_CATALOG
from framelet.core.stencils.cells import find_cells
from framelet.core.transform import choose_frame
from framelet.operators.bands.bands import analyze_object, synthesize_object
from framelet.operators.mesh_io import band_storage, mesh_bridge, mesh_facts

SHAPES = {
    "Triangles": lambda: meshes.flipped(meshes.triangle_torus()),
    "Quads": meshes.quad_torus,
    "Mixed": meshes.mixed_sheet,
    "Pages": meshes.three_pages,
}
FITTING = [(name, "AUTO") for name in SHAPES] + [
    (name, entry.identifier)
    for name in SHAPES
    for entry in FRAME_CATALOG
    if entry.lattice != "QUADS" or name in ("Quads", "Mixed")
]


def read(obj):
    return mesh_bridge.read_surface(obj).vertices


def values_of(obj, name):
    attribute = obj.data.attributes[name]
    values = np.empty((len(attribute.data), 3), np.float32)
    attribute.data.foreach_get("vector", values.reshape(-1))
    return values


def write_values(obj, name, values):
    obj.data.attributes[name].data.foreach_set("vector", np.ascontiguousarray(values, np.float32).reshape(-1))


def band_names(obj):
    """Return the domains of the attributes that Framelet made, by name."""
    return {item.name: item.domain for item in obj.data.attributes if item.name.startswith("framelet_")}


@pytest.fixture
def shape(make_object, rng):
    """Give a function that makes an object of one of the shapes, with noise."""
    return lambda name: make_object(meshes.noisy(SHAPES[name](), rng), name)


def monkey(is_triangles=False):
    bpy.ops.mesh.primitive_monkey_add()
    if is_triangles:
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.quads_convert_to_tris()
        bpy.ops.object.mode_set(mode="OBJECT")
    return bpy.context.object


def move_all(obj, rng):
    """Move every vertex somewhere else."""
    surface = mesh_bridge.read_surface(obj)
    mesh_bridge.write_vertices(obj, surface, surface.vertices + rng.normal(0, 0.3, surface.vertices.shape))


def coefficients_of(obj, frame, stencil="STRAIGHT", levels=1, boundary="ALONG"):
    surface = mesh_bridge.read_surface(obj)
    surface = surface.with_vertices(surface.vertices.astype(np.float64))
    frame = choose_frame(frame, connect(surface))
    return make_transform(surface, frame, stencil, levels, boundary=boundary).analyze(surface.vertices)


@pytest.mark.parametrize(("name", "frame"), FITTING)
def test_unedited_bands_give_back_the_positions(shape, name, frame, rng):
    obj = shape(name)
    before = read(obj)
    assert bpy.ops.object.framelet_analyze(frame=frame, levels=2) == {"FINISHED"}
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}
    assert read(obj).tobytes() == before.tobytes()
    move_all(obj, rng)
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}
    assert np.array_equal(read(obj), before)


@pytest.mark.parametrize("stencil", ["MEAN", "STRAIGHT", "ADAPTIVE"])
@pytest.mark.parametrize("is_triangles", [True, False])
def test_the_monkey_comes_back(is_triangles, stencil, rng):
    obj = monkey(is_triangles)
    before = read(obj)
    for frame in ("AUTO", "BOX_SPLINE_111", "B_SPLINE_3", "ADAPTIVE"):
        bpy.ops.object.framelet_analyze(frame=frame, stencil=stencil, levels=3, boundary="FREE")
        move_all(obj, rng)
        bpy.ops.object.framelet_synthesize()
        assert np.array_equal(read(obj), before), frame


@pytest.mark.parametrize(("name", "frame"), FITTING)
def test_stored_bands_are_those_of_core(shape, name, frame):
    obj = shape(name)
    expected = coefficients_of(obj, frame, levels=2, boundary="FREE")
    surface = mesh_bridge.read_surface(obj)
    note, n_bytes = analyze_object(obj, frame, levels=2, boundary="FREE")
    assert np.array_equal(values_of(obj, "framelet_low"), expected.low.astype(np.float32))
    assert values_of(obj, "framelet_rest").tobytes() == surface.vertices.tobytes()
    names = {"framelet_low": "POINT", "framelet_rest": "POINT"}
    for level in range(2):
        details = expected.details(level).astype(np.float32)
        assert note.n_bands[level] == len(details)
        bank = BANKS.get(note.frame)
        if level == 0 and bank and bank.is_cell_centered:
            cells = find_cells(surface, with_triangles=True)
            parts = []
            if cells.n_quads:
                parts.append(("FACE", "", slice(0, cells.n_quads), surface.n_faces))
            if len(cells.owner) > cells.n_quads:
                suffix = "_edges" if cells.n_quads else ""
                parts.append(("EDGE", suffix, slice(cells.n_quads, None), surface.n_edges))
        else:
            parts = [("POINT", "", slice(None), surface.n_vertices)]
        for domain, suffix, sites, n_elements in parts:
            owners = np.arange(n_elements) if domain == "POINT" else cells.owner[sites]
            for band, values in enumerate(details, 1):
                full = np.zeros((n_elements, 3), np.float32)
                full[owners] = values[sites]
                attribute = f"framelet_L{level + 1}_B{band}{suffix}"
                assert np.array_equal(values_of(obj, attribute), full), attribute
                names[attribute] = domain
    assert band_names(obj) == names
    assert n_bytes == sum(12 * len(obj.data.attributes[each].data) for each in names)


def test_cells_are_stored_where_they_are(shape):
    obj = shape("Quads")
    analyze_object(obj, "B_SPLINE_1")
    assert band_names(obj)["framelet_L1_B3"] == "FACE"
    obj = shape("Triangles")
    analyze_object(obj, "B_SPLINE_1")
    assert band_names(obj)["framelet_L1_B3"] == "EDGE"
    obj = shape("Mixed")
    analyze_object(obj, "B_SPLINE_1")
    assert (band_names(obj)["framelet_L1_B3"], band_names(obj)["framelet_L1_B3_edges"]) == ("FACE", "EDGE")
    sizes = mesh_bridge.read_surface(obj).face_sizes()
    assert not values_of(obj, "framelet_L1_B3")[sizes != 4].any()


@pytest.mark.parametrize(
    ("name", "frame"),
    [("Triangles", "AUTO"), ("Quads", "AUTO"), ("Mixed", "ADAPTIVE"), ("Mixed", "B_SPLINE_3")],
)
def test_edited_bands_change_the_geometry_linearly(shape, name, frame):
    obj = shape(name)
    rest = read(obj).astype(np.float64)
    coefficients = coefficients_of(obj, frame, levels=2)
    bpy.ops.object.framelet_analyze(frame=frame, levels=2)
    stored = {each: values_of(obj, each) for each in band_names(obj) if each != "framelet_rest"}
    changes = []
    for gain in (0.0, 0.5, 3.0):
        for each, values in stored.items():
            write_values(obj, each, values * np.float32(gain) if "_L1_" in each else values)
        bpy.ops.object.framelet_synthesize()
        details = [gain * coefficients.details(0), coefficients.details(1)]
        transform = coefficients.transform
        expected = transform.synthesize(coefficients.with_details(details, coefficients.low))
        tolerance = 1e-5 * mean_edge_length(mesh_bridge.read_surface(obj))
        assert np.abs(read(obj) - expected).max() < tolerance
        changes.append((read(obj) - rest) / (gain - 1.0))
    assert np.abs(changes[0]).max() > 0.01
    for other in changes[1:]:
        assert np.allclose(changes[0], other, atol=1e-5)


def test_an_edited_low_pass_moves_the_mesh(shape):
    obj = shape("Triangles")
    before = read(obj)
    bpy.ops.object.framelet_analyze(levels=2)
    write_values(obj, "framelet_low", values_of(obj, "framelet_low") + np.float32([0, 0, 2]))
    bpy.ops.object.framelet_synthesize()
    assert np.allclose(read(obj), before + np.float32([0, 0, 2]), atol=1e-5)


def snapshot(obj):
    """Return what analyzing, showing and clearing must leave as it is."""
    mesh = obj.data
    values = {}
    for item in mesh.attributes:
        if item.data_type == "FLOAT_VECTOR":
            array = np.empty(3 * len(item.data), np.float32)
            item.data.foreach_get("vector", array)
            values[item.name] = array.tobytes()
    return {
        "attributes": [(item.name, item.domain, item.data_type) for item in mesh.attributes],
        "vectors": values,
        "properties": dict(mesh.items()),
        "colors": (mesh.attributes.active_color_name, mesh.attributes.default_color_name),
        "uv": [(layer.name, layer.active, layer.active_render) for layer in mesh.uv_layers],
        "topology": band_storage.topology_fingerprint(mesh_bridge.read_surface(obj)),
    }


@pytest.mark.parametrize("frame", ["AUTO", "B_SPLINE_1"])
def test_clear_leaves_nothing_behind(frame):
    obj = monkey()
    mesh = obj.data
    mesh["mine"] = 3
    mesh.attributes.new("framelet_mine", "FLOAT_VECTOR", "POINT")
    for name in ("First", "Second"):
        mesh.color_attributes.new(name, "BYTE_COLOR", "CORNER")
    mesh.attributes.active_color_name, mesh.attributes.default_color_name = "First", "Second"
    before, positions = snapshot(obj), read(obj)
    bpy.ops.object.framelet_analyze(frame=frame, levels=2)
    assert read(obj).tobytes() == positions.tobytes()
    for band in (1, 2):
        bpy.ops.object.framelet_show_band(band=band)
    assert read(obj).tobytes() == positions.tobytes()
    assert snapshot(obj) != before
    assert bpy.ops.object.framelet_clear() == {"FINISHED"}
    assert snapshot(obj) == before
    assert read(obj).tobytes() == positions.tobytes()
    assert not bpy.ops.object.framelet_clear.poll()


def test_analyzing_again_replaces_the_bands(shape):
    obj = shape("Quads")
    bpy.ops.object.framelet_analyze(frame="B_SPLINE_3", levels=3)
    bpy.ops.object.framelet_analyze(frame="B_SPLINE_1", levels=1)
    names = ["framelet_low", "framelet_rest", *(f"framelet_L1_B{band}" for band in (1, 2, 3))]
    assert sorted(band_names(obj)) == sorted(names)


def test_undo_takes_the_bands_away():
    monkey()
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.framelet_analyze()
    bpy.ops.ed.undo_push(message="Analyze")
    assert band_names(bpy.data.objects["Suzanne"])
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Suzanne"]
    assert not band_names(obj) and not band_storage.has_note(obj.data)
    bpy.ops.ed.redo()
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}


def test_undo_takes_a_rebuild_back(rng):
    obj = monkey()
    bpy.ops.object.framelet_analyze()
    move_all(obj, rng)
    moved = read(obj)
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.framelet_synthesize()
    bpy.ops.ed.undo_push(message="Rebuild")
    assert read(bpy.data.objects["Suzanne"]).tobytes() != moved.tobytes()
    bpy.ops.ed.undo()
    assert read(bpy.data.objects["Suzanne"]).tobytes() == moved.tobytes()


def test_the_active_shape_key_is_analyzed_and_rebuilt(shape, rng):
    obj = shape("Triangles")
    basis = obj.shape_key_add(name="Basis")
    smile = obj.shape_key_add(name="Smile")
    obj.active_shape_key_index = 1
    wide = read(obj) * np.float32([2, 1, 1])
    smile.data.foreach_set("co", wide.reshape(-1))
    basis_before = [tuple(point.co) for point in basis.data]
    bpy.ops.object.framelet_analyze(levels=2)
    assert values_of(obj, "framelet_rest").tobytes() == wide.tobytes()
    move_all(obj, rng)
    bpy.ops.object.framelet_synthesize()
    assert np.array_equal(read(obj), wide)
    assert [tuple(point.co) for point in basis.data] == basis_before


def test_selected_meshes_are_analyzed_beside_bad_ones(shape, make_object, capfd):
    bad = make_object(SurfaceMesh.from_faces([(1.0, 1.0, 1.0)] * 3, [(0, 1, 2)]), "Bad")
    objects = [shape("Quads"), shape("Triangles")]
    for obj in (*objects, bad):
        obj.select_set(True)
    assert bpy.ops.object.framelet_analyze() == {"FINISHED"}
    assert [band_storage.has_note(obj.data) for obj in (*objects, bad)] == [True, True, False]
    assert "Warning: ‘Bad’" in capfd.readouterr().out
    frames = [obj.data["framelet_bands"]["frame"] for obj in objects]
    assert frames == ["LINEAR_SPLINE", "BOX_SPLINE_111"]
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}
    assert "‘Bad’ has no stored bands" in capfd.readouterr().out


def test_copies_of_a_mesh_keep_their_bands(shape, rng):
    obj = shape("Mixed")
    before = read(obj)
    bpy.ops.object.framelet_analyze(levels=2)
    twin = bpy.data.objects.new("Twin", obj.data.copy())
    bpy.context.collection.objects.link(twin)
    move_all(twin, rng)
    synthesize_object(twin)
    assert np.array_equal(read(twin), before)


def test_bands_survive_saving(shape, rng, tmp_path):
    obj = shape("Mixed")
    before = read(obj)
    bpy.ops.object.framelet_analyze(frame="B_SPLINE_3", levels=2)
    move_all(obj, rng)
    path = str(tmp_path / "bands.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}
    assert np.array_equal(read(bpy.data.objects["Mixed"]), before)


@pytest.mark.parametrize("name", meshes.MESHES)
def test_facts_agree_with_core(make_object, name):
    surface = meshes.MESHES[name]()
    connectivity = connect(surface)
    facts = mesh_facts.find_facts(surface)
    assert mesh_facts.resolve_frame("AUTO", facts) == choose_frame("AUTO", connectivity)
    assert facts.has_quads == connectivity.has_quads
    if not connectivity.is_non_manifold.any():
        assert facts.has_triangle_pairs == connectivity.has_triangle_pairs


@pytest.mark.parametrize(("name", "frame"), FITTING)
def test_the_size_is_known_before(shape, name, frame):
    obj = shape(name)
    facts = mesh_facts.find_facts(mesh_bridge.read_surface(obj))
    expected = mesh_facts.stored_bytes(mesh_facts.resolve_frame(frame, facts), "STRAIGHT", 2, facts)
    n_bytes = analyze_object(obj, frame, levels=2)[1]
    assert n_bytes <= expected <= 1.5 * n_bytes
    if frame in BANKS:
        assert n_bytes == expected
