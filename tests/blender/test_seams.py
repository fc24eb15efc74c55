# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing tears: split seams, mirrored halves, objects whose borders meet; custom normals."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from blender_objects import read, select_only
from checks import lengths
from framelet.core import PRESETS, Region, SurfaceMesh, add_noise, denoise
from framelet.core.mesh.borders import border_vertices
from framelet.core.mesh.geometry import vertex_normals
from framelet.core.mesh.weld import make_weld
from framelet.operators.mesh_io import custom_normals, mesh_bridge
from framelet.operators.modifier.offsets import offset_of
from framelet.operators.modifier.recipes import DISPLACEMENT
from meshes import noisy, triangle_grid, triangle_torus
from region_cases import box, exploded
from run_steps import settle, turn_on

PLACES = {"moved": {}, "turned": {"rotation_euler": (0.3, 1.0, 2.0), "location": (5, -3, 100)}}


def last_report():
    return bpy.context.window_manager.framelet_report


def ball(size=24):
    """Return a closed ball of triangles, with vertices exactly in all three planes of the axes."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=size, ring_count=size // 2)
    obj = bpy.context.object
    surface = mesh_bridge.read_surface(obj)
    points = surface.vertices.astype(float)
    points[np.abs(points) < 1e-6] = 0.0
    faces = [list(face.vertices) for face in obj.data.polygons]
    bpy.data.objects.remove(obj)
    return SurfaceMesh.from_faces(points, faces)


def part_of(surface, is_kept):
    """Return the part of a mesh whose faces have only some vertices, and which vertices those are."""
    starts = surface.face_offset
    faces = [surface.corner_vertex[a:b] for a, b in pairwise(starts)]
    faces = [face for face in faces if is_kept[face].all()]
    used = np.unique(np.concatenate(faces))
    number = np.full(surface.n_vertices, -1)
    number[used] = np.arange(len(used))
    return SurfaceMesh.from_faces(surface.vertices[used], [number[face] for face in faces]), used


# Seams of one mesh -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "BILATERAL"])
def test_split_seams_stay_closed_by_default(make_object, rng, preset):
    soup, vertex = exploded(noisy(triangle_torus(), rng))
    obj = make_object(soup)
    before = read(obj)
    bpy.ops.object.framelet_denoise(preset=preset)
    after = read(obj)
    assert (after != before).any(axis=1).mean() > 0.9
    assert all(len(np.unique(after[vertex == each], axis=0)) == 1 for each in np.unique(vertex))
    assert last_report().welded_vertices == soup.n_vertices - len(np.unique(vertex))


def test_the_switch_turns_it_off(make_object, rng):
    soup, _ = exploded(noisy(triangle_torus(), rng))
    obj = make_object(soup)
    expected = denoise(mesh_bridge.read_surface(obj), PRESETS["TRI_1"].settings).vertices
    bpy.ops.object.framelet_denoise(preset="TRI_1", weld=False)
    assert read(obj).tobytes() == expected.tobytes() and last_report().welded_vertices == 0


def test_only_borders_are_welded(rng):
    """Two closed tori that touch in a vertex each stay two."""
    mesh = noisy(triangle_torus(), rng)
    other = mesh.with_vertices(mesh.vertices + mesh.vertices[5] - mesh.vertices[70])
    faces = mesh.corner_vertex.reshape(-1, 3)
    other.vertices[70] = mesh.vertices[5]
    both = SurfaceMesh.from_faces(
        np.concatenate((mesh.vertices, other.vertices)), np.concatenate((faces, faces + mesh.n_vertices))
    )
    assert make_weld(both, 0.0).n_merged > 0 and not border_vertices(both).any()
    settings = PRESETS["TRI_2"].settings
    region = Region(weld_distance=0.0, weldable=border_vertices(both))
    expected = denoise(both, settings).vertices
    assert denoise(both, settings, region=region).vertices.tobytes() == expected.tobytes()


def test_the_mask_of_weldable_vertices_is_checked():
    mesh = triangle_grid()
    with pytest.raises(ValueError, match=r"has 3 entries for .* vertices; give one for each"):
        denoise(mesh, region=Region(weld_distance=0.0, weldable=np.ones(3, bool)))
    with pytest.raises(ValueError, match="is int64 of shape"):
        Region(weldable=np.ones(3, int))


# Mirrors ---------------------------------------------------------------------------------------------------


@pytest.fixture(params=[(0,), (0, 2)], ids=["one plane", "two planes"])
def mirrored(request, make_object, rng):
    """A noisy part of a ball with a Mirror modifier, the whole ball, and the vertices of it in the part."""
    axes = request.param
    whole = ball()
    is_kept = (whole.vertices[:, axes] >= 0.0).all(axis=1)
    part, used = part_of(whole, is_kept)
    points = add_noise(part, 0.2, 1)
    for axis in axes:
        points[part.vertices[:, axis] == 0.0, axis] = 0.0
    part = part.with_vertices(points)
    obj = make_object(part)
    modifier = obj.modifiers.new("Mirror", "MIRROR")
    modifier.use_clip = True
    for axis in range(3):
        modifier.use_axis[axis] = axis in axes
    images = whole.vertices.copy()
    images[used] = points
    for number in np.flatnonzero(~is_kept):
        place = whole.vertices[number].copy()
        sign = np.ones(3)
        sign[list(axes)] = np.where(place[list(axes)] < 0, -1.0, 1.0)
        image = np.flatnonzero(lengths(whole.vertices - place * sign) < 1e-6)[0]
        images[number] = images[image] * sign
    return obj, whole.with_vertices(images.astype(np.float32)), used, axes


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2", "BILATERAL"])
def test_a_half_is_cleaned_as_the_whole(mirrored, preset):
    obj, whole, used, axes = mirrored
    noisy_part = read(obj)
    bpy.ops.object.framelet_denoise(preset=preset)
    expected = denoise(whole, PRESETS[preset].settings).vertices
    assert lengths(read(obj) - expected[used]).max() < 2e-3 and lengths(read(obj) - noisy_part).max() > 0.01
    for axis in axes:
        in_plane = noisy_part[:, axis] == 0.0
        assert in_plane.sum() > 10 and (read(obj)[in_plane, axis] == 0.0).all()
    report = last_report()
    assert report.n_vertices == len(noisy_part) and report.n_moved <= len(noisy_part)
    moved = read(obj).astype(float) - noisy_part
    assert report.displacement_rms == pytest.approx(np.sqrt((moved**2).sum(axis=1).mean()), rel=1e-3)


def test_the_evaluated_mesh_stays_closed(mirrored):
    obj, _, _, _ = mirrored

    def open_vertices():
        graph = bpy.context.evaluated_depsgraph_get()
        surface = mesh_bridge.read_arrays(obj.evaluated_get(graph).data, None)
        return int(border_vertices(surface).sum())

    before = open_vertices()
    bpy.ops.object.framelet_denoise()
    assert open_vertices() == before == 0
    bpy.ops.object.framelet_denoise(output="MODIFIER", strength=2.0)
    assert open_vertices() == 0


def test_without_the_modifier_the_seam_opens(mirrored):
    """So that the tests above mean something."""
    obj, _, _, axes = mirrored
    obj.modifiers.clear()
    in_plane = read(obj)[:, axes[0]] == 0.0
    bpy.ops.object.framelet_denoise()
    assert np.abs(read(obj)[in_plane, axes[0]]).max() > 1e-3


def test_the_plane_may_be_that_of_another_object(mirrored):
    obj, _, _, axes = mirrored
    bpy.ops.object.framelet_denoise()
    expected = read(obj)
    bpy.ops.object.framelet_before_after()
    helper = bpy.data.objects.new("Plane", None)
    bpy.context.collection.objects.link(helper)
    turn = {"rotation_euler": (0.2, 0.4, 0.8), "location": (1.0, 2.0, 3.0)}
    for each in (obj, helper):
        for name, value in turn.items():
            setattr(each, name, value)
    obj.modifiers[0].mirror_object = helper
    bpy.context.view_layer.update()
    select_only(obj)
    bpy.ops.object.framelet_denoise()
    assert lengths(read(obj) - expected).max() < 1e-4
    in_plane = np.abs(expected[:, axes[0]]) == 0.0
    assert np.abs(read(obj)[in_plane, axes[0]]).max() < 1e-6


@pytest.mark.usefixtures("no_thread_stays")
def test_the_preview_shows_it_too(mirrored, settings):
    obj, _, _, _ = mirrored
    before = read(obj)
    session = turn_on()
    settle(session)
    shown = read(obj)
    bpy.ops.object.framelet_preview()
    assert read(obj).tobytes() == before.tobytes()
    bpy.ops.object.framelet_denoise(preset="POSITIONS")
    assert read(obj).tobytes() == shown.tobytes()


def test_a_mirror_without_joining_is_no_seam(mirrored):
    obj, _, _, _ = mirrored
    obj.modifiers[0].use_clip = obj.modifiers[0].use_mirror_merge = False
    expected = denoise(mesh_bridge.read_surface(obj), PRESETS["TRI_2"].settings).vertices
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert read(obj).tobytes() == expected.tobytes()


# Arrays and welds ------------------------------------------------------------------------------------------


def open_vertices(obj):
    """Return how many vertices of borders there are with all modifiers."""
    graph = bpy.context.evaluated_depsgraph_get()
    return int(border_vertices(mesh_bridge.read_arrays(obj.evaluated_get(graph).data, None)).sum())


def periodic(rng, axes=(0,)):
    """Return a noisy grid whose opposite borders along some axes are alike, and its sizes."""
    flat = triangle_grid(16, 12)
    noise = rng.normal(0, 0.2, flat.vertices.shape)
    low, high = flat.vertices.min(axis=0), flat.vertices.max(axis=0)
    vertices = flat.vertices + noise
    for axis in axes:
        first = np.flatnonzero(np.isclose(flat.vertices[:, axis], low[axis]))
        last = np.flatnonzero(np.isclose(flat.vertices[:, axis], high[axis]))
        other = 1 - axis
        first, last = (each[np.argsort(flat.vertices[each, other])] for each in (first, last))
        vertices[last] = vertices[first]
        vertices[last, axis] += high[axis] - low[axis]
    return flat.with_vertices(vertices.astype(np.float32)), high - low


def add_array(obj, **values):
    modifier = obj.modifiers.new("Array", "ARRAY")
    modifier.use_merge_vertices, modifier.merge_threshold, modifier.count = True, 1e-3, 3
    for name, value in values.items():
        setattr(modifier, name, value)
    return modifier


@pytest.mark.parametrize("axes", [(0,), (0, 1)], ids=["a row", "a field"])
@pytest.mark.parametrize("output", ["IN_PLACE", "MODIFIER"])
def test_copies_of_an_array_stay_joined(make_object, rng, axes, output):
    surface, size = periodic(rng, axes)
    obj = make_object(surface)
    modifiers = []
    for axis in axes:
        offset = np.where(np.arange(3) == axis, size, 0.0)
        modifiers.append(
            add_array(
                obj, use_relative_offset=False, use_constant_offset=True, constant_offset_displace=offset
            )
        )
    before, closed = read(obj), open_vertices(obj)
    bpy.ops.object.framelet_denoise(preset="TRI_2", output=output)
    assert open_vertices(obj) == closed
    moved = read(obj) if output == "IN_PLACE" else before + offset_of(obj, DISPLACEMENT)
    assert lengths(moved - before)[border_vertices(surface)].max() > 0.05
    # So that this means something:
    mesh_bridge.write_vertices(obj, surface, before)
    for modifier in modifiers:
        modifier.use_merge_vertices = False
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    for modifier in modifiers:
        modifier.use_merge_vertices = True
    assert open_vertices(obj) > closed


def test_a_step_that_is_as_long_as_the_mesh_stays(make_object, rng):
    surface, size = periodic(rng)
    vertices = surface.vertices.copy()
    vertices[:, 0] = np.clip(vertices[:, 0], *triangle_grid(16, 12).vertices[[0, -1], 0])
    ends = [np.flatnonzero(triangle_grid(16, 12).vertices[:, 0] == each) for each in (0.0, size[0])]
    for vertex, end in zip(ends, (0.0, size[0]), strict=True):
        vertices[vertex, 0] = end
    obj = make_object(surface.with_vertices(vertices))
    add_array(obj, relative_offset_displace=(1.0, 0.0, 0.0))
    closed = open_vertices(obj)
    bpy.ops.object.framelet_denoise()
    after = read(obj)
    assert open_vertices(obj) == closed
    assert (after[ends[0], 0] == 0.0).all() and np.ptp(after[ends[0], 2]) < np.ptp(vertices[ends[0], 2])


def test_copies_around_an_axis_stay_joined(make_object, rng):
    flat, size = periodic(rng)
    angle = np.pi / 3.0
    turned = np.empty_like(flat.vertices)
    for number, (x, y, z) in enumerate(flat.vertices):
        way, radius = angle * x / size[0], 8.0 + y
        turned[number] = radius * np.cos(way), radius * np.sin(way), z
    obj = make_object(flat.with_vertices(turned.astype(np.float32)))
    helper = bpy.data.objects.new("Step", None)
    bpy.context.collection.objects.link(helper)
    helper.rotation_euler = (0.0, 0.0, angle)
    bpy.context.view_layer.update()
    add_array(
        obj,
        use_relative_offset=False,
        use_object_offset=True,
        offset_object=helper,
        count=6,
        use_merge_vertices_cap=True,
    )
    before, closed = read(obj), open_vertices(obj)
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert open_vertices(obj) == closed and lengths(read(obj) - before).max() > 0.05


def test_what_a_weld_modifier_joins_stays_joined(make_object, rng):
    whole = noisy(triangle_grid(16, 12), rng)
    soup, _ = exploded(whole)
    gaps = soup.with_vertices(
        soup.vertices + rng.uniform(-2e-3, 2e-3, soup.vertices.shape).astype(np.float32)
    )
    obj = make_object(gaps)
    obj.modifiers.new("Weld", "WELD").merge_threshold = 0.02
    before, closed = read(obj), open_vertices(obj)
    assert closed == border_vertices(whole).sum()
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert open_vertices(obj) == closed and lengths(read(obj) - before).max() > 0.05
    mesh_bridge.write_vertices(obj, gaps, before)
    bpy.ops.object.framelet_denoise(preset="TRI_2", weld=False)
    assert lengths(read(obj) - before).max() < 1e-6 or open_vertices(obj) > closed


# Several objects -------------------------------------------------------------------------------------------


@pytest.fixture(params=list(PLACES))
def tiles(request, make_object, rng):
    """Two halves of a noisy grid as objects, the vertices of the grid that they have, and the whole grid."""
    whole = noisy(triangle_grid(14, 20), rng)
    middle = np.median(whole.vertices[:, 0])
    flat = triangle_grid(14, 20).vertices[:, 0]
    middle = np.unique(flat)[len(np.unique(flat)) // 2]
    objects, parts = [], []
    for number, is_kept in enumerate((flat <= middle, flat >= middle)):
        part, used = part_of(whole, is_kept)
        obj = make_object(part, f"Tile {number}")
        for name, value in PLACES[request.param].items():
            setattr(obj, name, value)
        # Its own place, with the vertices where they are.
        from mathutils import Matrix

        obj.data.transform(Matrix.Translation((-number, -2.0 * number, 0)))
        obj.matrix_world = obj.matrix_basis @ Matrix.Translation((number, 2.0 * number, 0))
        objects.append(obj)
        parts.append(used)
    bpy.context.view_layer.update()
    select_only(*objects)
    return objects, parts, whole


def in_scene(obj):
    matrix = np.array(obj.matrix_world)
    return read(obj).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]


@pytest.mark.parametrize("preset", ["AUTO", "TRI_2"])
def test_objects_together_are_cleaned_as_one(tiles, preset):
    objects, parts, whole = tiles
    before = [in_scene(obj) for obj in objects]
    motion = denoise(whole, PRESETS[preset].settings).vertices - whole.vertices
    bpy.ops.object.framelet_denoise(preset=preset, together=True)
    turn = np.array(objects[0].matrix_world)[:3, :3]
    for obj, used, start in zip(objects, parts, before, strict=True):
        assert lengths(in_scene(obj) - start - motion[used] @ turn.T).max() < 2e-3
    _, first, second = np.intersect1d(*parts, return_indices=True)
    assert len(first) > 10
    gap = lengths(in_scene(objects[0])[first] - in_scene(objects[1])[second])
    assert gap.max() < 2e-5, "closed up to the rounding of two objects"
    report = last_report()
    assert report.n_objects == 2 and report.n_vertices == sum(map(len, parts))
    assert report.welded_vertices == len(first)


def test_alone_their_borders_part(tiles):
    objects, parts, _ = tiles
    bpy.ops.object.framelet_denoise(preset="AUTO")
    _, first, second = np.intersect1d(*parts, return_indices=True)
    gap = lengths(in_scene(objects[0])[first] - in_scene(objects[1])[second])
    assert gap.max() > 1e-3


def test_scaled_objects_and_limits(tiles):
    objects, parts, _ = tiles
    for obj, size in zip(objects, (2.0, 0.5), strict=True):
        obj.data.transform(((1 / size, 0, 0, 0), (0, 1 / size, 0, 0), (0, 0, 1 / size, 0), (0, 0, 0, 1)))
        obj.matrix_world = obj.matrix_world @ obj.matrix_world.Scale(size, 4)
    bpy.context.view_layer.update()
    before = [in_scene(obj) for obj in objects]
    bpy.ops.object.framelet_denoise(preset="TRI_2", together=True, limit="LENGTH", max_length=0.05)
    largest = max(lengths(in_scene(obj) - at).max() for obj, at in zip(objects, before, strict=True))
    assert largest == pytest.approx(0.05, rel=1e-3)
    _, first, second = np.intersect1d(*parts, return_indices=True)
    assert lengths(in_scene(objects[0])[first] - in_scene(objects[1])[second]).max() < 2e-5


def test_a_vertex_group_of_one_object_counts_for_it(tiles):
    objects, parts, _ = tiles
    before = [read(obj) for obj in objects]
    objects[0].vertex_groups.new(name="Part").add(list(range(40)), 1.0, "REPLACE")
    objects[1].vertex_groups.new(name="Part").add(list(range(len(parts[1]))), 1.0, "REPLACE")
    bpy.ops.object.framelet_denoise(preset="TRI_2", together=True, vertex_group="Part")
    moved = [(read(obj) != at).any(axis=1) for obj, at in zip(objects, before, strict=True)]
    assert not moved[0][40:].any() and moved[0][:40].any() and moved[1].mean() > 0.8


# Custom normals --------------------------------------------------------------------------------------------


def smooth_normals(obj):
    surface = mesh_bridge.read_surface(obj)
    return vertex_normals(surface)[surface.corner_vertex]


def degrees(first, second):
    return np.degrees(np.arccos(np.clip((first * second).sum(axis=1), -1, 1))).mean()


@pytest.fixture
def shaded(make_object, rng):
    """A noisy torus, and the normals of the corners of the clean one."""
    clean = triangle_torus()
    obj = make_object(noisy(clean, rng))
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    return obj, vertex_normals(clean)[clean.corner_vertex]


def test_clean_normals_stay(shaded, capfd):
    obj, clean = shaded
    custom_normals.write_normals(obj.data, clean)
    bpy.ops.object.framelet_denoise()
    assert degrees(custom_normals.read_normals(obj.data), clean) < 0.1
    assert "; clean custom normals stay as they are" in capfd.readouterr().out
    bpy.ops.object.framelet_before_after()
    assert degrees(custom_normals.read_normals(obj.data), clean) < 0.1
    bpy.ops.object.framelet_before_after()
    assert degrees(custom_normals.read_normals(obj.data), clean) < 0.1


def test_normals_of_the_noisy_mesh_follow(shaded, capfd):
    obj, _ = shaded
    custom_normals.write_normals(obj.data, smooth_normals(obj))
    bpy.ops.object.framelet_denoise()
    assert degrees(custom_normals.read_normals(obj.data), smooth_normals(obj)) < 0.2
    assert "; custom normals, which were those of the noisy surface, are those of" in capfd.readouterr().out


def test_a_split_seam_stays_invisible(make_object, rng):
    """Every GLB is split along the seams of its UV map, and shaded as if it was not."""
    whole = noisy(triangle_torus(), rng)
    soup, vertex = exploded(whole)
    obj = make_object(soup)
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    custom_normals.write_normals(obj.data, vertex_normals(whole)[vertex])
    bpy.ops.object.framelet_denoise()
    positions = np.empty_like(whole.vertices)
    positions[vertex] = read(obj)
    smooth = vertex_normals(whole.with_vertices(positions))[vertex]
    assert degrees(custom_normals.read_normals(obj.data), smooth) < 0.2


def test_edges_split_to_be_sharp_stay_sharp(make_object):
    """Copies with normals of their own, as those of flat faces in a GLB, are no seam of a smooth surface."""
    from framelet.core.mesh.geometry import face_normals

    mesh, _ = box(8)
    soup, _ = exploded(mesh.with_vertices(add_noise(mesh, 0.05, 1)))
    obj = make_object(soup)
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    custom_normals.write_normals(obj.data, face_normals(soup).repeat(3, axis=0))
    bpy.ops.object.framelet_denoise()
    flat = face_normals(mesh_bridge.read_surface(obj)).repeat(3, axis=0)
    assert degrees(custom_normals.read_normals(obj.data), flat) < 0.2


def test_creases_made_by_normals_follow(make_object):
    """Normals of faces on a smooth cube: its edges look sharp, and go on to do so."""
    mesh, _ = box(8)
    from framelet.core.mesh.geometry import face_normals

    obj = make_object(mesh.with_vertices(add_noise(mesh, 0.05, 1)))
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    sharp = face_normals(mesh).repeat(3, axis=0)
    noisy_sides = sharp + np.random.default_rng(0).normal(0, 0.03, sharp.shape)
    custom_normals.write_normals(obj.data, noisy_sides / lengths(noisy_sides)[:, None])
    bpy.ops.object.framelet_denoise()
    after = custom_normals.read_normals(obj.data)
    assert degrees(after, sharp) < 8.0 < degrees(smooth_normals(obj), sharp)


def test_normals_that_are_kept_as_directions_follow_too(shaded):
    obj, _ = shaded
    old = smooth_normals(obj)
    attribute = obj.data.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER")
    attribute.data.foreach_set("vector", old.astype(np.float32).reshape(-1))
    if not obj.data.has_custom_normals:
        pytest.skip("this Blender has no custom normals that are directions")
    bpy.ops.object.framelet_denoise()
    assert degrees(custom_normals.read_normals(obj.data), smooth_normals(obj)) < 0.5
    assert degrees(old, smooth_normals(obj)) > 2.0


@pytest.mark.parametrize("output", ["MODIFIER", "SHAPE_KEY"])
def test_where_noisy_normals_of_a_split_seam_stay_it_is_said(make_object, rng, output, capfd):
    whole = noisy(triangle_torus(), rng)
    soup, vertex = exploded(whole)
    obj = make_object(soup)
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    custom_normals.write_normals(obj.data, vertex_normals(whole)[vertex])
    bpy.ops.object.framelet_denoise(output=output)
    said = capfd.readouterr().out
    assert "; custom normals are noisy; with the output In Place they become those of the result" in said
    if output == "MODIFIER":
        bpy.ops.object.framelet_apply_modifier()
        positions = np.empty_like(whole.vertices)
        positions[vertex] = read(obj)
        smooth = vertex_normals(whole.with_vertices(positions))[vertex]
        assert degrees(custom_normals.read_normals(obj.data), smooth) < 0.2


@pytest.mark.parametrize("output", ["MODIFIER", "SHAPE_KEY"])
def test_where_clean_normals_cannot_stay_it_is_said(shaded, output, capfd):
    obj, clean = shaded
    custom_normals.write_normals(obj.data, clean)
    bpy.ops.object.framelet_denoise(output=output)
    assert (
        "; custom normals are cleaner than the mesh; with the output In Place they" in capfd.readouterr().out
    )
    if output == "MODIFIER":
        assert offset_of(obj, DISPLACEMENT).any()
        bpy.ops.object.framelet_apply_modifier()
        assert degrees(custom_normals.read_normals(obj.data), clean) < 0.1
