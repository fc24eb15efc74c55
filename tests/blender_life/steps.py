# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What people do with a file, each step with its name and how often it comes.

A step returns what it may have done to the meshes that were there; `World.step` checks that it did no more.
"""

import bpy
import framelet
import numpy as np

# isort: split
# This module exists once bpy was imported.
import bmesh
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.preview import current_preview
from framelet.operators.properties.region_values import to_region_options
from framelet.operators.properties.setting_values import to_settings
from framelet.operators.run import current_run
from framelet.operators.run.denoise_run import begin_run

from .world import MOVED, OTHER, SAME, SECONDS, assert_same_shapes

OUTPUTS = ("IN_PLACE", "MODIFIER", "SHAPE_KEY", "NEW_OBJECT")
MODES = ("OBJECT", "OBJECT", "EDIT", "SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT")
MOST = {"iterations": 12, "levels": 3, "passes": 2, "threads": 2}
"""Larger values only take longer."""
MOST_OBJECTS = 6


def _targets(world, number=None):
    """Select some objects; an object without faces is among them now and then."""
    objects = world.objects(with_faces=world.dice.random() < 0.8) or world.objects()
    if bpy.context.mode != "OBJECT" or not objects:
        return []
    count = number or world.dice.choice((1, 1, 1, 2, 3))
    chosen = world.dice.sample(objects, min(count, len(objects)))
    world.select(*chosen)
    world.log[-1] += f" {[obj.name for obj in chosen]}"
    return chosen


# Objects come and go


def make(world):
    if bpy.context.mode != "OBJECT" or len(bpy.data.objects) >= MOST_OBJECTS:
        return SAME
    kinds = ("ball", "ball", "monkey", "grid", "keys", "mirror", "wire", "empty", "curve")
    kind = world.dice.choice(kinds if world.objects(with_faces=True) else kinds[:6])
    world.log[-1] += f" {kind}"
    if kind == "curve":
        bpy.ops.curve.primitive_bezier_circle_add()
        return OTHER
    if kind in ("wire", "empty"):
        mesh = bpy.data.meshes.new(kind)
        if kind == "wire":
            mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1), (1, 2)], [])
        bpy.context.collection.objects.link(bpy.data.objects.new(kind, mesh))
        return OTHER
    place = {"location": [world.dice.uniform(-2, 2) for _ in range(3)]}
    if kind == "monkey":
        bpy.ops.mesh.primitive_monkey_add(**place)
    elif kind == "ball":
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, **place)
    else:
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=12, y_subdivisions=9, **place)
    obj = bpy.context.object
    obj.scale = [world.dice.choice((1, 1, 0.5, -1)) for _ in range(3)]
    surface = mesh_bridge.read_surface(obj)
    noise = np.random.default_rng(len(world.log)).normal(scale=0.02, size=surface.vertices.shape)
    mesh_bridge.write_vertices(obj, surface, surface.vertices + noise)
    obj.vertex_groups.new(name="Group").add(list(range(0, surface.n_vertices, 2)), 0.5, "REPLACE")
    if kind == "mirror":
        obj.modifiers.new("Mirror", "MIRROR")
    if kind == "keys":
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Key").value = 0.5
        obj.active_shape_key_index = world.dice.choice((0, 1))
    return OTHER


def delete(world):
    _targets(world, 1)
    world.call(bpy.ops.object.delete)
    return OTHER


def duplicate(world):
    if len(bpy.data.objects) < MOST_OBJECTS:
        _targets(world, 1)
        world.call(bpy.ops.object.duplicate, linked=world.dice.random() < 0.3)
    return SAME


def join(world):
    _targets(world, 2)
    world.call(bpy.ops.object.join)
    return OTHER


def instance(world):
    """Show an object once more: by a second object of its mesh, by a collection, or in a second scene."""
    chosen = _targets(world, 1)
    if not chosen or len(bpy.data.objects) >= MOST_OBJECTS:
        return SAME
    kind = world.dice.choice(("twin", "collection", "scene"))
    world.log[-1] += f" {kind}"
    if kind == "twin":
        bpy.context.collection.objects.link(bpy.data.objects.new("Twin", chosen[0].data))
    elif kind == "collection":
        collection = bpy.data.collections.new("Instanced")
        collection.objects.link(chosen[0])
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        bpy.context.collection.objects.link(empty)
    elif len(bpy.data.scenes) < 3:
        bpy.data.scenes.new("Second").collection.objects.link(chosen[0])
    return SAME


def link(world):
    """Link the meshes of a file that was saved; override some."""
    if not world.saved or bpy.context.mode != "OBJECT" or len(bpy.data.objects) >= MOST_OBJECTS:
        return SAME
    path = world.dice.choice(sorted(world.saved))
    if path == bpy.data.filepath:
        return SAME
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = source.objects[:1]
    for obj in target.objects:
        if obj is not None and obj.name not in bpy.context.collection.objects:
            bpy.context.collection.objects.link(obj)
            if world.dice.random() < 0.5:
                obj.override_create(remap_local_usages=True)
    return OTHER


def blender(world):
    """Use what Blender has for objects."""
    chosen = _targets(world)
    if not chosen:
        return SAME
    for obj in chosen:
        obj.data.remesh_voxel_size = min(max(*obj.dimensions, 1e-3) / 8, 1e4)  # a few hundred faces
    operator, arguments = world.dice.choice(
        (
            (bpy.ops.object.modifier_apply, {"modifier": "Framelet Denoise"}),
            (bpy.ops.object.modifier_apply, {"modifier": "Framelet Equalizer"}),
            (bpy.ops.object.modifier_copy, {"modifier": "Framelet Denoise"}),
            (bpy.ops.object.convert, {"target": "MESH"}),
            (bpy.ops.object.make_single_user, {"object": True, "obdata": True}),
            (bpy.ops.object.shade_smooth, {}),
            (bpy.ops.object.voxel_remesh, {}),
            (bpy.ops.object.shape_key_add, {}),
            (bpy.ops.object.shape_key_remove, {"all": True}),
            (bpy.ops.object.make_links_data, {"type": "OBDATA"}),
            (bpy.ops.object.make_links_data, {"type": "MODIFIERS"}),
            (bpy.ops.outliner.orphans_purge, {}),
            (bpy.ops.mesh.customdata_custom_splitnormals_add, {}),
            (bpy.ops.object.make_local, {"type": "ALL"}),
        )
    )
    world.log[-1] += f" {operator.idname_py()} {arguments}"
    world.call(operator, **arguments)
    return OTHER


def subdivide(world):
    if bpy.context.mode == "EDIT_MESH" and len(bpy.context.object.data.polygons) < 2000:
        bpy.ops.mesh.select_all(action="SELECT")
        world.call(bpy.ops.mesh.subdivide)
        return OTHER
    return SAME


def grab(world):
    """Move a vertex, or apply the scale of an object."""
    if bpy.context.mode == "EDIT_MESH":
        edit_mesh = bmesh.from_edit_mesh(bpy.context.object.data)
        for vert in edit_mesh.verts[:3] if len(edit_mesh.verts) > 3 else ():
            vert.co.z += 0.1
        bmesh.update_edit_mesh(bpy.context.object.data)
        return MOVED
    chosen = _targets(world, 1)
    if chosen and world.dice.random() < 0.5:
        world.call(bpy.ops.object.transform_apply, location=False)
        return OTHER  # a negative scale turns the faces
    if chosen and len(chosen[0].data.vertices) and chosen[0].data.shape_keys is None:
        chosen[0].data.vertices[0].co.x += 0.1
        chosen[0].data.update()
    return MOVED


def rename(world):
    for obj in world.objects()[:1]:
        obj.name = f"Name{len(world.log)}"
        return OTHER
    return SAME


def select_vertices(world):
    if bpy.context.mode == "EDIT_MESH":
        for obj in bpy.context.objects_in_mode:
            edit_mesh = bmesh.from_edit_mesh(obj.data)
            for vert in edit_mesh.verts:
                vert.select = world.dice.random() < 0.5
                vert.hide = world.dice.random() < 0.1
            bmesh.update_edit_mesh(obj.data)
    return SAME


def mode(world):
    wanted = world.dice.choice(MODES)
    if bpy.context.mode == "OBJECT":
        _targets(world)
    if bpy.context.object is None or bpy.context.object.type != "MESH":
        return SAME
    world.log[-1] += f" {wanted}"
    world.call(bpy.ops.object.mode_set, mode=wanted)
    return SAME


def active_key(world):
    for obj in world.objects():
        if obj.data.shape_keys is not None and obj.mode == "OBJECT":
            obj.active_shape_key_index = world.dice.randrange(len(obj.data.shape_keys.key_blocks))
            return OTHER
    return SAME


# Framelet


def settings(world):
    """Change some values in the sidebar, any to anything that it takes."""
    properties = bpy.context.scene.framelet
    for item in world.dice.sample(list(properties.bl_rna.properties), 3):
        if item.identifier in ("rna_type", "name", "vertex_group"):
            continue
        if item.type == "ENUM":
            value = world.dice.choice([each.identifier for each in item.enum_items if each.identifier])
        elif item.type == "BOOLEAN":
            value = world.dice.random() < 0.5
        elif item.type == "FLOAT":
            value = world.dice.uniform(item.soft_min, item.soft_max)
        else:
            most = MOST.get(item.identifier, item.soft_max)
            value = world.dice.randint(item.soft_min, min(most, item.soft_max))
        setattr(properties, item.identifier, value)
        world.log[-1] += f" {item.identifier}={value}"
    properties.vertex_group = world.dice.choice(("", "", "Group", "nowhere"))
    return SAME


def _arguments(world):
    """Return arguments as the sidebar hands them over, or none, or a preset."""
    properties = bpy.context.scene.framelet
    known = bpy.ops.object.framelet_denoise.get_rna_type().properties
    names = [item.identifier for item in properties.bl_rna.properties if item.identifier in known]
    if world.dice.random() < 0.5:
        found = {each: getattr(properties, each) for each in names if each not in ("rna_type", "name")}
        if properties.preset != "CUSTOM":  # a preset and the values beside it are set in turn
            found = {"preset": properties.preset}
    else:
        found = {"preset": world.dice.choice(("AUTO", "POSITIONS", "TRI_2", "QUAD_1", "BILATERAL"))}
    return {**found, "output": world.dice.choice(OUTPUTS), "from_original": world.dice.random() < 0.5}


def denoise(world):
    _targets(world)
    arguments = _arguments(world)
    world.log[-1] += f" {arguments}"
    before = world.look()
    is_whole = bpy.context.mode == "OBJECT" and not arguments["from_original"]
    is_done = world.call(bpy.ops.object.framelet_denoise, **arguments)
    if not is_done:
        return SAME
    if is_whole and arguments["output"] in ("MODIFIER", "NEW_OBJECT"):
        assert_same_shapes(before, world.look())
    return MOVED


def preview(world):
    if current_preview.current_preview() is None:
        _targets(world, 1)
    world.call(bpy.ops.object.framelet_preview)
    return SAME


def apply_preview(world):
    session = current_preview.current_preview()
    if session is not None and session.wait(SECONDS):
        current_preview.tick_preview()
    return MOVED if world.call(bpy.ops.object.framelet_apply_preview) else SAME


def start_run(world):
    """Press the button, and go on while a thread computes."""
    chosen = _targets(world) or [obj for obj in world.objects() if obj.mode != "OBJECT"]
    current_preview.end_preview()
    properties = bpy.context.scene.framelet
    world.gate.clear()
    try:
        run = begin_run(
            chosen,
            to_settings(properties),
            properties.output,
            to_region_options(properties),
            from_original=world.dice.random() < 0.5,
        )
        current_run.set_current(run)
    except ValueError as error:
        world.log[-1] += f" [{error}]"
        return SAME
    run.start()
    return SAME


def end_run(world):
    """Let the thread compute to its end, or cancel it."""
    run = current_run.current_run()
    world.gate.set()
    if run is None:
        return SAME
    if world.dice.random() < 0.3:
        bpy.ops.object.framelet_cancel()
    assert run.wait(SECONDS)
    return SAME


def equalize(world):
    _targets(world)
    gains = {f"gain_{level}": world.dice.choice((0.0, 0.5, 1.0, 2.0)) for level in (1, 2, 3)}
    if world.dice.random() < 0.5:
        return SAME if not world.call(bpy.ops.object.framelet_equalize, **gains) else MOVED
    before = world.look()
    levels = world.dice.randint(1, 3)
    if world.call(bpy.ops.object.framelet_live_equalizer, levels=levels, **gains):
        assert_same_shapes(before, world.look())
    return SAME


def bands(world):
    _targets(world)
    frame = world.dice.choice(("AUTO", "AUTO", "PAIRWISE", "B_SPLINE_2", "BOX_SPLINE_111"))
    world.log[-1] += f" {frame}"
    world.call(bpy.ops.object.framelet_analyze, levels=world.dice.randint(1, 2), frame=frame)
    world.call(bpy.ops.object.framelet_show_band, content=world.dice.choice(("BAND", "LEVEL", "LOW")))
    return SAME


def rebuild(world):
    _targets(world)
    return MOVED if world.call(bpy.ops.object.framelet_synthesize) else SAME


def clear(world):
    _targets(world)
    world.call(bpy.ops.object.framelet_clear)
    return SAME


def end_modifier(world):
    """Apply or remove a modifier; without it the vertices are where they were."""
    kind = world.dice.choice(("displacement", "equalizer"))
    _targets(world)
    if world.dice.random() < 0.6:
        return MOVED if world.call(bpy.ops.object.framelet_apply_modifier, kind=kind) else SAME
    world.call(bpy.ops.object.framelet_remove_modifier, kind=kind)
    return SAME


def sides(world):
    """Show before and after; twice is where it was."""
    chosen = _targets(world)
    before = world.look()
    if not world.call(bpy.ops.object.framelet_before_after, side="TOGGLE"):
        return SAME
    if world.dice.random() < 0.5:
        return MOVED
    # Several may show different sides, and all are turned to one.
    if world.call(bpy.ops.object.framelet_before_after, side="TOGGLE") and len(chosen) == 1:
        assert world.look() == before, "before and after differ from what was there"
    return MOVED


def heat(world):
    _targets(world)
    world.call(
        bpy.ops.object.framelet_heat_map,
        quantity=world.dice.choice(("NORMAL", "LENGTH", "ANGLE", "NOISE", "WIDTH")),
    )
    world.call(bpy.ops.object.framelet_hide_colors)
    return SAME


def measure(world):
    _targets(world, 2)
    world.call(bpy.ops.object.framelet_estimate_noise)
    world.call(bpy.ops.object.framelet_compare)
    return SAME


def noise(world):
    _targets(world)
    return MOVED if world.call(bpy.ops.object.framelet_add_noise, seed=len(world.log)) else SAME


def spikes(world):
    _targets(world)
    if world.call(bpy.ops.object.framelet_flatten_spikes):
        return MOVED
    if bpy.context.mode == "OBJECT":
        world.call(bpy.ops.object.framelet_select_spikes)
        world.call(bpy.ops.object.framelet_select_islands)
    return SAME


# The file


def undo(world):
    return world.go(-1)


def redo(world):
    return world.go(1)


def save(world):
    path = str(world.folder / f"{len(world.log)}.blend")
    now = world.look()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    world.saved[path] = now
    return SAME


def load(world):
    """Open a file that was saved; what it has is what there was."""
    if not world.saved:
        return SAME
    path = world.dice.choice(sorted(world.saved))
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    now = world.look()
    # Blender writes no object that nothing uses.
    assert now.items() <= world.saved[path].items(), path
    world.start_over()
    return OTHER


def new_file(world):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    make(world)
    world.start_over()
    return OTHER


def render(world):
    """Render a picture of a few pixels."""
    scene = bpy.context.scene
    if scene.camera is None:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(camera)
        scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.device = 1, "CPU"
    scene.render.resolution_x = scene.render.resolution_y = 8
    world.call(bpy.ops.render.render)
    return SAME


def enable_again(world):
    """Disable the extension and enable it."""
    framelet.unregister()
    try:
        found = [mesh.name for mesh in bpy.data.meshes if ".framelet_original" in mesh.attributes]
        assert not found, "a disabled extension leaves nothing of its preview"
    finally:
        framelet.register()
    return SAME


STEPS = {
    make: 9,
    delete: 2,
    duplicate: 3,
    instance: 3,
    link: 2,
    blender: 8,
    join: 3,
    subdivide: 1,
    grab: 4,
    rename: 1,
    select_vertices: 2,
    mode: 7,
    active_key: 1,
    settings: 9,
    denoise: 12,
    preview: 9,
    apply_preview: 4,
    start_run: 5,
    end_run: 6,
    equalize: 5,
    bands: 4,
    rebuild: 2,
    clear: 2,
    end_modifier: 5,
    sides: 4,
    heat: 2,
    measure: 2,
    noise: 2,
    spikes: 2,
    undo: 10,
    redo: 5,
    save: 4,
    load: 2,
    new_file: 1,
    render: 1,
    enable_again: 1,
}
"""What can be done, and how often."""


def live(world, n_steps):
    """Do as many random things."""
    for _ in range(3):
        world.step("make", make)
    for act in world.dice.choices(list(STEPS), list(STEPS.values()), k=n_steps):
        world.step(act.__name__, act)
    world.end()
