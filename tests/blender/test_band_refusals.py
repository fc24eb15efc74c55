# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands that are wrong, missing, altered or outdated are refused with one sentence, and the mesh stays."""

import operator

import bpy
import meshes
import numpy as np
import pytest
from framelet.operators.mesh_io import mesh_bridge


def read(obj):
    return mesh_bridge.read_surface(obj).vertices


@pytest.fixture
def analyzed(make_object, rng):
    """Give an object with the bands of two levels, whose vertices moved since."""
    obj = make_object(meshes.noisy(meshes.quad_torus(), rng), "Torus")
    bpy.ops.object.framelet_analyze(levels=2)
    surface = mesh_bridge.read_surface(obj)
    mesh_bridge.write_vertices(obj, surface, surface.vertices * np.float32(2))
    return obj


def replace(mesh, name, kind, domain):
    mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, domain)


def set_first(mesh, name, value):
    mesh.attributes[name].data[0].vector = value


def turn_a_face(mesh):
    """Change the faces and none of the counts."""
    mesh.polygons[0].flip()


def with_note(**changes):
    def change(mesh):
        note = mesh["framelet_bands"].to_dict() | changes
        mesh["framelet_bands"] = {key: value for key, value in note.items() if value is not None}

    return change


NOTE_ALTERED = "The custom property framelet_bands of ‘Torus’ was altered; analyze it again."
ALTERATIONS = {
    "no note": (lambda mesh: mesh.pop("framelet_bands"), "Analyze a selected mesh first"),
    "note of text": (
        lambda mesh: operator.setitem(mesh, "framelet_bands", "x"),
        "The bands of ‘Torus’ have format None, but this version reads format 1; analyze it again.",
    ),
    "later format": (with_note(format=2), "The bands of ‘Torus’ have format 2"),
    "no frame": (with_note(frame=None), NOTE_ALTERED),
    "unknown frame": (with_note(frame="WRONG"), NOTE_ALTERED),
    "no real frame": (with_note(frame="AUTO"), NOTE_ALTERED),
    "frame that does not fit": (with_note(frame="B_SPLINE_3"), "framelet_L1_B1 .* instead of"),
    "other frame": (with_note(frame="BOX_SPLINE_111"), "The stored bands are not those of their frame"),
    "more levels": (with_note(levels=3), NOTE_ALTERED),
    "too many levels": (with_note(levels=100, n_bands=[8] * 100), NOTE_ALTERED),
    "more bands": (with_note(n_bands=[9, 8]), "The attribute framelet_L1_B9 of ‘Torus’ is missing"),
    "numbers that are none": (with_note(n_bands=["a", "b"]), "altered|format"),
    "missing band": (
        lambda mesh: mesh.attributes.remove(mesh.attributes["framelet_L2_B3"]),
        "The attribute framelet_L2_B3 of ‘Torus’ is missing; analyze it again.",
    ),
    "missing low-pass": (
        lambda mesh: mesh.attributes.remove(mesh.attributes["framelet_low"]),
        "The attribute framelet_low of ‘Torus’ is missing",
    ),
    "missing positions": (
        lambda mesh: mesh.attributes.remove(mesh.attributes["framelet_rest"]),
        "The attribute framelet_rest of ‘Torus’ is missing",
    ),
    "wrong type": (
        lambda mesh: replace(mesh, "framelet_L1_B3", "FLOAT", "POINT"),
        "The attribute framelet_L1_B3 of ‘Torus’ is FLOAT on POINT instead of FLOAT_VECTOR on POINT",
    ),
    "wrong domain": (
        lambda mesh: replace(mesh, "framelet_L1_B3", "FLOAT_VECTOR", "FACE"),
        "The attribute framelet_L1_B3 of ‘Torus’ is FLOAT_VECTOR on FACE instead of",
    ),
    "not finite": (
        lambda mesh: set_first(mesh, "framelet_L1_B3", (0, float("nan"), 0)),
        "The attribute framelet_L1_B3 of ‘Torus’ has numbers that are not finite",
    ),
    "too large": (
        lambda mesh: [set_first(mesh, f"framelet_L1_B{band}", (3e38, 3e38, 3e38)) for band in (3, 5, 8)],
        "The bands of ‘Torus’ are too large to give positions",
    ),
    "altered positions": (
        lambda mesh: set_first(mesh, "framelet_rest", (1, 2, 3)),
        "The attribute framelet_rest of ‘Torus’, the analyzed positions, was altered",
    ),
    "other faces": (turn_a_face, "‘Torus’ has other faces than when its bands were stored"),
}


@pytest.mark.parametrize("name", ALTERATIONS)
def test_altered_bands_get_a_sentence_and_the_mesh_stays(analyzed, name):
    change, sentence = ALTERATIONS[name]
    change(analyzed.data)
    before = read(analyzed)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.object.framelet_synthesize()
    assert read(analyzed).tobytes() == before.tobytes()
    if name not in ("other frame", "too large"):
        with pytest.raises(RuntimeError, match=sentence):
            bpy.ops.object.framelet_show_band()
        assert "framelet_band" not in analyzed.data.attributes
    assert bpy.ops.object.framelet_clear() == {"FINISHED"}
    left = [item.name for item in analyzed.data.attributes if item.name.startswith("framelet")]
    assert left == (["framelet_L1_B3"] if name == "wrong type" else [])  # which is somebody else's now


def test_a_subdivided_mesh_is_outdated(analyzed):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(RuntimeError, match="‘Torus’ has other faces than when"):
        bpy.ops.object.framelet_synthesize()
    assert bpy.ops.object.framelet_analyze() == {"FINISHED"}
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}


def test_bands_stay_readable_in_edit_mode_and_back(analyzed):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.object.framelet_synthesize() == {"FINISHED"}


BAD_ANALYSES = {
    "too large": ({"max_megabytes": 0.005}, r"‘Torus’: The bands take 8 kB, more than the 0\.005 MB"),
    "too many levels": ({"levels": 6}, "‘Torus’: The mesh is too small for"),
}


@pytest.mark.parametrize("name", BAD_ANALYSES)
def test_bad_analyses_get_a_sentence_and_the_mesh_stays(make_object, name):
    obj = make_object(meshes.quad_torus(), "Torus")
    names = [item.name for item in obj.data.attributes]
    values, sentence = BAD_ANALYSES[name]
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.object.framelet_analyze(**values)
    assert [item.name for item in obj.data.attributes] == names
    assert "framelet_bands" not in obj.data


def test_a_failed_analysis_keeps_the_old_bands(analyzed):
    before = sorted(item.name for item in analyzed.data.attributes)
    with pytest.raises(RuntimeError, match="more than the 0 MB"):
        bpy.ops.object.framelet_analyze(max_megabytes=0)
    assert sorted(item.name for item in analyzed.data.attributes) == before


def test_a_frame_for_quads_needs_quads(make_object):
    obj = make_object(meshes.triangle_torus(), "Torus")
    for name in ("analyze", "equalize"):
        with pytest.raises(RuntimeError, match="‘Torus’: LINEAR_SPLINE is a frame for quads"):
            getattr(bpy.ops.object, f"framelet_{name}")(frame="LINEAR_SPLINE")
    assert "framelet_bands" not in obj.data


def test_bands_are_for_object_mode(analyzed):
    bpy.ops.object.mode_set(mode="EDIT")
    for name in ("analyze", "show_band", "synthesize", "clear"):
        with pytest.raises(RuntimeError, match="Switch to Object Mode"):
            getattr(bpy.ops.object, f"framelet_{name}")()


def test_linked_meshes_are_refused(analyzed, tmp_path):
    path = str(tmp_path / "torus.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = ["Torus"]
    obj = bpy.data.objects["Torus"]
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    for name in ("analyze", "show_band", "synthesize", "clear", "equalize"):
        with pytest.raises(RuntimeError, match="‘Torus’ uses a mesh linked from"):
            getattr(bpy.ops.object, f"framelet_{name}")()
