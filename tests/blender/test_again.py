# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run after a run starts from the original while the mesh still is the result; amounts cost nothing."""

import bpy
import numpy as np
import pytest
from blender_objects import edit, noisy_monkey, read, select_only
from drawing import draw
from framelet.operators.denoise import OBJECT_OT_framelet_denoise as Denoise
from framelet.operators.mesh_io.mesh_bridge import read_positions
from framelet.operators.modifier.inputs import set_input
from framelet.operators.modifier.node_groups import ON
from framelet.operators.modifier.recipes import DISPLACEMENT
from framelet.operators.modifier.stack import find_modifier
from framelet.operators.run import denoise_run, run_memory
from framelet.operators.run.denoise_object import denoise_object
from framelet.ui.panels import panel, see_panel
from run_steps import QUICK, expected_for, settle, turn_on

WEAK, STRONG = 0.1, 0.5


def denoised(obj):
    """Return the vertices that an object shows, with its modifiers."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return read_positions(evaluated.data)


def run(**options):
    assert bpy.ops.object.framelet_denoise(**({"preset": "POSITIONS"} | options)) == {"FINISHED"}


def again(**options):
    run(from_original=True, **options)


def expected(lambda_, name="Expected"):
    """Return the positions of the noisy monkey after one run."""
    active = bpy.context.object
    obj = noisy_monkey(name)
    denoise_object(obj, QUICK.with_changes(lambda_=lambda_))
    found = read(obj)
    bpy.data.objects.remove(obj)
    select_only(active)
    return found


@pytest.fixture
def monkey():
    return noisy_monkey()


@pytest.fixture
def forbid_computing(monkeypatch):
    """Give a function after which nothing may be computed any more."""
    return lambda: monkeypatch.setattr(denoise_run, "compute", lambda *_: pytest.fail("it was computed"))


@pytest.mark.parametrize("lambdas", [(STRONG, WEAK), (WEAK, STRONG)])
def test_again_starts_from_the_original(monkey, lambdas):
    noisy = read(monkey)
    run(lambda_=lambdas[0])
    again(lambda_=lambdas[1])
    assert read(monkey).tobytes() == expected(lambdas[1]).tobytes()
    bpy.ops.object.framelet_before_after()
    assert read(monkey).tobytes() == noisy.tobytes()


def test_scripts_go_on_from_what_is_there(monkey):
    run(lambda_=WEAK)
    first = read(monkey)
    run(lambda_=WEAK)
    assert read(monkey).tobytes() != first.tobytes() == expected(WEAK).tobytes()
    bpy.ops.object.framelet_before_after()
    assert read(monkey).tobytes() == first.tobytes()


def test_an_edited_mesh_is_an_original(monkey):
    run(lambda_=STRONG)
    monkey.data.vertices[0].co.x += 1
    edited = read(monkey)
    again(lambda_=STRONG)
    bpy.ops.object.framelet_before_after()
    assert read(monkey).tobytes() == edited.tobytes()


@pytest.mark.parametrize("options", [{"strength": 0.0, "preset": "AUTO"}, {"lambda_": 0.0}])
def test_a_run_that_moves_nothing_keeps_the_original(monkey, options):
    noisy = read(monkey)
    run(lambda_=STRONG)
    result = read(monkey)
    run(**options)
    assert read(monkey).tobytes() == result.tobytes()
    bpy.ops.object.framelet_before_after()
    assert read(monkey).tobytes() == noisy.tobytes()


def test_again_with_nothing_to_do_gives_the_original(monkey):
    noisy = read(monkey)
    run(lambda_=STRONG)
    again(lambda_=0.0)
    assert read(monkey).tobytes() == noisy.tobytes()
    again(lambda_=WEAK)
    assert read(monkey).tobytes() == expected(WEAK).tobytes()


def test_undo_and_again(monkey):
    bpy.ops.ed.undo_push(message="Noisy")
    run(lambda_=STRONG)
    bpy.ops.ed.undo_push(message="First")
    first = read(monkey)
    again(lambda_=WEAK)
    bpy.ops.ed.undo_push(message="Again")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Monkey"]
    select_only(obj)
    assert read(obj).tobytes() == first.tobytes()


def test_in_edit_mode(monkey):
    noisy = read(monkey)
    edit(monkey, select=np.arange(507) < 100)
    run(lambda_=STRONG)
    once = read(monkey)
    again(lambda_=STRONG)
    assert read(monkey).tobytes() == once.tobytes()
    again(lambda_=0.0)
    assert read(monkey).tobytes() == noisy.tobytes()


def test_keys_that_follow_go_back_too(monkey):
    monkey.shape_key_add(name="Basis")
    wide = monkey.shape_key_add(name="Wide")
    monkey.active_shape_key_index = 0

    def points():
        return np.array([point.co[:] for point in wide.points])

    run(lambda_=WEAK)
    weak = points()
    again(lambda_=STRONG)
    assert not np.array_equal(points(), weak)
    again(lambda_=WEAK)
    assert np.array_equal(points(), weak)


def test_limits_in_edges_are_those_of_the_original(monkey):
    run(lambda_=2.0)
    again(lambda_=2.0, limit="EDGES", max_edges=0.1)
    once = read(monkey)
    other = noisy_monkey("Other")
    run(lambda_=2.0, limit="EDGES", max_edges=0.1)
    assert once.tobytes() == read(other).tobytes()


# Outputs ---------------------------------------------------------------------------------------------------


def keys_of(obj):
    """Return the values of the keys but the first, whose value means nothing."""
    return {key.name: round(key.value, 3) for key in obj.data.shape_keys.key_blocks[1:]}


@pytest.mark.parametrize("is_basis_active", [False, True])
def test_a_second_shape_key_replaces_the_first(monkey, is_basis_active, capfd):
    noisy = read(monkey)
    run(lambda_=STRONG, output="SHAPE_KEY")
    if is_basis_active:
        monkey.active_shape_key_index = 0
    monkey.data.shape_keys.key_blocks["Denoised"].value = 0.5
    again(lambda_=WEAK, output="SHAPE_KEY")
    assert keys_of(monkey) == {"Denoised": 0.5} and monkey.active_shape_key.name == "Denoised"
    assert read(monkey).tobytes() == expected(WEAK).tobytes()
    assert "; the shape key ‘Denoised’ was replaced" in capfd.readouterr().out
    monkey.active_shape_key_index = 0
    assert read(monkey).tobytes() == noisy.tobytes()


def test_results_relative_to_other_keys_are_set_to_zero(monkey, capfd):
    run(lambda_=STRONG, output="SHAPE_KEY")
    other = monkey.shape_key_add(name="Other", from_mix=False)
    other.points[0].co.x += 1
    monkey.active_shape_key_index = 2
    run(lambda_=STRONG, output="SHAPE_KEY")
    assert keys_of(monkey)["Denoised"] == 0.0 and keys_of(monkey)["Denoised.001"] == 1.0
    assert "; the shape key ‘Denoised’ was set to 0" in capfd.readouterr().out


def test_from_a_shape_key_to_the_mesh(monkey):
    run(lambda_=STRONG, output="SHAPE_KEY")
    again(lambda_=WEAK)
    assert keys_of(monkey) == {"Denoised": 0.0} and monkey.active_shape_key.name == "Basis"
    assert read(monkey).tobytes() == expected(WEAK).tobytes()


def test_a_new_object_takes_the_next_result(monkey):
    noisy = read(monkey)
    run(lambda_=STRONG, output="NEW_OBJECT")
    for lambda_ in (WEAK, STRONG):
        again(lambda_=lambda_, output="NEW_OBJECT")
        assert {obj.name for obj in bpy.data.objects} == {"Monkey", "Monkey.denoised"}
        assert read(bpy.context.object).tobytes() == expected(lambda_).tobytes()
    assert read(monkey).tobytes() == noisy.tobytes()


def test_continuing_goes_on_from_a_modifier(monkey):
    """What the arrow beside the button does is the same wherever the result is."""
    noisy = read(monkey)
    other = noisy_monkey("Other")
    run(lambda_=WEAK)
    run(lambda_=STRONG)
    twice = read(other)
    select_only(monkey)
    again(lambda_=WEAK, output="MODIFIER")
    once = denoised(monkey)
    run(lambda_=STRONG, output="MODIFIER", from_original=False)
    assert read(monkey).tobytes() == noisy.tobytes()
    assert np.allclose(denoised(monkey), twice, atol=1e-6) and not np.allclose(once, twice, atol=1e-3)
    # Before and after are the original and what both runs made.
    assert run_memory.known_side(monkey) == "AFTER"
    bpy.ops.object.framelet_before_after(side="BEFORE")
    assert np.allclose(denoised(monkey), noisy)
    # A result that is not shown is none to continue from.
    run(lambda_=WEAK, output="MODIFIER", from_original=False)
    assert np.allclose(denoised(monkey), once, atol=1e-6)
    run(lambda_=STRONG, from_original=False)
    assert find_modifier(monkey, DISPLACEMENT) is None and np.allclose(read(monkey), twice, atol=1e-6)


def test_a_modifier_from_a_file_can_be_continued_from(monkey):
    run(lambda_=WEAK, output="MODIFIER")
    run_memory.forget_runs()
    assert run_memory.known_side(monkey) == "" and run_memory.shows_result(monkey)
    record = draw(panel.VIEW3D_PT_framelet)
    assert record["operator"].count("object.framelet_denoise") == 2
    set_input(find_modifier(monkey, DISPLACEMENT), ON, False)
    assert draw(panel.VIEW3D_PT_framelet)["operator"].count("object.framelet_denoise") == 1


def test_from_the_mesh_to_a_modifier(monkey):
    noisy = read(monkey)
    run(lambda_=STRONG)
    again(lambda_=WEAK, output="MODIFIER")
    assert read(monkey).tobytes() == noisy.tobytes()
    bpy.ops.object.framelet_apply_modifier()
    assert np.allclose(read(monkey), expected(WEAK), atol=1e-6)


# Amount ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("output", ["IN_PLACE", "NEW_OBJECT", "SHAPE_KEY", "MODIFIER"])
def test_the_amount_is_a_share_of_the_motion(monkey, output, forbid_computing):
    noisy, full = read(monkey), expected(STRONG)
    run(lambda_=STRONG, output=output, amount=0.25)
    obj = bpy.context.object
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    shown = np.array([vertex.co[:] for vertex in mesh.vertices])
    assert np.allclose(shown, noisy + 0.25 * (full - noisy), atol=1e-6)
    report = bpy.context.window_manager.framelet_report
    assert report.displacement_max == pytest.approx(
        0.25 * np.linalg.norm(full.astype(float) - noisy, axis=1).max(), rel=1e-3
    )
    forbid_computing()
    again(lambda_=STRONG, output=output, amount=1.5)


def test_the_same_run_is_not_computed_again(monkey, forbid_computing):
    noisy, full = read(monkey), expected(STRONG)
    run(lambda_=STRONG)
    forbid_computing()
    again(lambda_=STRONG, amount=0.5)
    assert np.allclose(read(monkey), noisy + 0.5 * (full - noisy), atol=1e-6)
    again(lambda_=STRONG)
    assert read(monkey).tobytes() == full.tobytes()


@pytest.mark.parametrize(
    "options",
    [
        {"lambda_": 0.4},
        {"limit": "EDGES", "max_edges": 0.01},
        {"vertex_group": "Half"},
        {"tolerance": 0.1},
    ],
)
def test_another_run_is_computed(monkey, options):
    monkey.vertex_groups.new(name="Half").add(list(range(250)), 1.0, "REPLACE")
    run(lambda_=STRONG)
    first = read(monkey).tobytes()
    again(**({"lambda_": STRONG} | options))
    assert read(monkey).tobytes() != first


def test_weights_that_were_painted_count(monkey):
    group = monkey.vertex_groups.new(name="Half")
    group.add(list(range(250)), 1.0, "REPLACE")
    run(lambda_=STRONG, vertex_group="Half")
    first = read(monkey).tobytes()
    group.add(list(range(250)), 0.5, "REPLACE")
    again(lambda_=STRONG, vertex_group="Half")
    assert read(monkey).tobytes() != first


def test_adjusting_the_last_operation_is_instant():
    """Blender stands still meanwhile, so that the box has what needs no computing."""
    shown = draw(lambda drawn, context: Denoise.draw(_Shown(drawn.layout), context))
    assert shown["prop"] == ["amount", "output"]


class _Shown:
    """An operator as its box draws it."""

    def __init__(self, layout):
        self.layout = layout
        self.bl_rna = bpy.ops.object.framelet_denoise.get_rna_type()


# What the sidebar says -------------------------------------------------------------------------------------


def test_the_button_says_what_it_does(monkey):
    def buttons():
        record = draw(panel.VIEW3D_PT_framelet)
        return record["operator"].count("object.framelet_denoise")

    assert buttons() == 1 and run_memory.known_side(monkey) == ""
    run(lambda_=STRONG)
    assert buttons() == 2 and run_memory.known_side(monkey) == "AFTER"
    assert draw(panel.VIEW3D_PT_framelet)["object.framelet_denoise"].from_original is False
    bpy.ops.object.framelet_before_after()
    bpy.context.view_layer.update()
    assert buttons() == 1 and run_memory.known_side(monkey) == "BEFORE"
    monkey.data.vertices[0].co.x += 1
    monkey.data.update()
    bpy.context.view_layer.update()
    assert buttons() == 1 and run_memory.known_side(monkey) == ""


def test_the_sides_are_buttons_of_which_one_is_pressed(monkey):
    def sides():
        return draw(see_panel.VIEW3D_PT_framelet_see)["pressed"]

    assert sides() == []
    run(lambda_=STRONG)
    assert sides() == ["object.framelet_before_after"]
    result = read(monkey)
    bpy.ops.object.framelet_before_after(side="AFTER")
    assert read(monkey).tobytes() == result.tobytes()
    bpy.ops.object.framelet_before_after(side="BEFORE")
    assert read(monkey).tobytes() != result.tobytes()


@pytest.mark.usefixtures("no_thread_stays")
def test_the_preview_starts_from_the_original_and_restores_the_result(monkey, settings):
    from framelet.operators.mesh_io import mesh_bridge
    from framelet.operators.preview import current_preview

    noisy = mesh_bridge.read_surface(monkey)
    run(lambda_=STRONG)
    result = read(monkey)
    settings.lambda_ = WEAK
    session = turn_on()
    settle(session)
    assert read(monkey).tobytes() == expected_for(noisy, settings).tobytes()
    current_preview.end_preview()
    assert read(monkey).tobytes() == result.tobytes()
    session = turn_on()
    settle(session)
    bpy.ops.object.framelet_apply_preview()
    assert read(monkey).tobytes() == expected(WEAK).tobytes()
    bpy.ops.object.framelet_before_after()
    assert read(monkey).tobytes() == noisy.vertices.tobytes()
