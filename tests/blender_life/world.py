# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The file as it is, apart from what a preview shows, and what must hold after every step."""

import hashlib
import random
from collections import Counter
from types import SimpleNamespace
from typing import NamedTuple

import bpy
import numpy as np
from framelet.operators import denoise_report, handlers, registration
from framelet.operators.mesh_io import kept_original, mesh_bridge
from framelet.operators.modifier.inputs import input_values
from framelet.operators.modifier.node_groups import KIND
from framelet.operators.modifier.stack import find_modifier
from framelet.operators.preview import current_preview
from framelet.operators.run import current_run
from framelet.operators.run.denoise_run import State
from run_steps import framelet_threads

SECONDS = 60
SAME, MOVED, OTHER = "same", "moved", "other"
"""What a step may do to meshes that were there before: nothing, move vertices, or whatever it likes."""


class Seen(NamedTuple):
    """Digests of one object's faces, of its active shape and of all shape keys, and Framelet's modifiers.

    Empty is what cannot be read: in Edit Mode the keys, and which of them a twin of the edited object shows.
    """

    faces: str
    shape: str
    keys: str
    modifiers: tuple

    def is_shaped_as(self, other):
        """Return whether faces and positions are the same bits."""
        pairs = ((self.shape, other.shape), (self.keys, other.keys))
        return self.faces == other.faces and all(a == b or not a or not b for a, b in pairs)


class World:
    """A file in which steps happen.

    Attributes
    ----------
    dice : random.Random
        Where all choices come from.
    log : list of str
        What was done, for the one who looks for a bug.
    """

    def __init__(self, seed, folder):
        self.dice = random.Random(seed)
        self.folder = folder
        self.log = []
        self.saved = {}
        self.gate = None
        self.start_over()

    def start_over(self):
        """Begin the history of undo steps."""
        bpy.ops.ed.undo_push(message="Start")
        self.history, self.at = [self.look()], 0

    # Looking

    def objects(self, *, with_faces=False):
        """Return the mesh objects of the scene, by name."""
        found = [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH"]
        if with_faces:
            found = [obj for obj in found if len(obj.data.polygons)]
        return sorted(found, key=lambda obj: obj.name)

    def look(self):
        """Return what there is, without what a preview shows: what a file would hold."""
        session = current_preview.current_preview()
        if session is not None:
            session.suspend()
        found = {obj.name_full: seen(obj) for obj in bpy.data.objects if obj.type == "MESH"}
        if session is not None:
            session.resume()
        return found

    # Acting

    def call(self, operator, **arguments):
        """Call an operator; return whether it did something. A refusal is a sentence and no traceback."""
        try:
            return operator(**arguments) == {"FINISHED"}
        except RuntimeError as error:
            sentence = str(error)
            assert "Traceback" not in sentence, sentence
            self.log[-1] += f" [{sentence.strip()}]"
            return False

    def select(self, *objects):
        """Select these alone, in Object Mode; the first becomes active."""
        for obj in bpy.context.view_layer.objects:
            obj.select_set(obj in objects)
        bpy.context.view_layer.objects.active = objects[0] if objects else None

    def step(self, name, act):
        """Do one thing, let Blender and Framelet look at it, and check."""
        self.log.append(name)
        before = self.look()
        allowed = act(self)
        bpy.context.view_layer.update()
        current_preview.tick_preview()
        session = current_preview.current_preview()
        if session is not None and self.dice.random() < 0.8:
            assert session.wait(SECONDS)
            current_preview.tick_preview()
        allowed = self._tick_run(allowed)
        after = self.look()
        if allowed == SAME:
            assert_same_shapes(before, after)
        if allowed == MOVED:
            gone = [key for key in before if key in after and after[key].faces != before[key].faces]
            assert not gone, f"{gone} got other faces"
        self.check()
        if name not in ("undo", "redo"):
            self._push(after)

    def _push(self, after):
        """Store an undo step, as Blender does after an operator that a button called."""
        if bpy.context.mode != "OBJECT":
            return  # steps of edit sessions are Blender's own
        bpy.ops.ed.undo_push(message=self.log[-1][:60])
        self.history[self.at + 1 :] = [after]
        self.at += 1

    def go(self, by):
        """Undo or redo; the file is what it was then."""
        if bpy.context.mode != "OBJECT" or not 0 <= self.at + by < len(self.history):
            return SAME
        self.call(bpy.ops.ed.undo if by < 0 else bpy.ops.ed.redo)
        self.at += by
        now, then = self.look(), self.history[self.at]
        assert now == then, [key for key in {*now, *then} if now.get(key) != then.get(key)]
        return OTHER

    def _tick_run(self, allowed):
        """Look at a run as the operator does that is in charge of it, and write what it came to."""
        run = current_run.current_run()
        if run is None:
            return allowed
        if run.tick() is State.READY:
            operator = SimpleNamespace(report=lambda _kind, _text: None)
            denoise_report.report_written(operator, bpy.context, run.finish())
            return OTHER if allowed == OTHER else MOVED
        return allowed

    # Checking

    def check(self):
        """What always holds."""
        session = current_preview.current_preview()
        shown = None if session is None else session.mesh_uid
        for mesh in bpy.data.meshes:
            names = [item.name for item in mesh.attributes]
            traces = {name for name in names if name.startswith(kept_original.NAMES)}
            assert mesh.session_uid == shown or not traces, f"{mesh.name} has {traces}"
            twice = [name for name in names if name.startswith("framelet") and name[-4:-3] == "."]
            assert not twice, f"{mesh.name} has {twice}"
            assert not mesh.name.startswith(".framelet"), f"the temporary mesh {mesh.name} is left"
            if not mesh.is_editmode:
                assert_finite(mesh)
        check_registration()
        threads = framelet_threads()
        assert len(threads) <= 3, f"{len(threads)} threads"

    def end(self):
        """End all that goes on, and check that nothing of it stays."""
        self.log.append("end")
        before = self.look()
        current_preview.stop_preview()
        current_run.stop_current()
        assert_same_shapes(before, self.look())
        self.check()
        assert framelet_threads() == []


def seen(obj):
    """Return the digests of an object."""
    surface = mesh_bridge.read_surface(obj)
    faces = (surface.corner_vertex, surface.face_offset, surface.edges)
    keys = []
    if obj.data.shape_keys is not None and not obj.data.is_editmode:
        for key in obj.data.shape_keys.key_blocks:
            points = np.empty(3 * len(key.points), np.float32)
            key.points.foreach_get("co", points)
            keys.append(points)
    modifiers = []
    for kind in ("displacement", "equalizer"):
        modifier = find_modifier(obj, kind)
        if modifier is not None:
            modifiers.append((kind, *sorted(map(str, input_values(modifier).items()))))
    is_edited = obj.data.is_editmode
    shape = "" if is_edited and obj.mode != "EDIT" else digest([surface.vertices])
    return Seen(digest(faces), shape, "" if is_edited else digest(keys), tuple(modifiers))


def assert_same_shapes(before, after):
    """All that was there has the faces and the positions that it had."""
    changed = [key for key in before if key in after and not after[key].is_shaped_as(before[key])]
    assert not changed, f"{changed} changed"


def digest(arrays):
    """Return a short text for the bits of arrays."""
    found = hashlib.blake2b(digest_size=8)
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()


def assert_finite(mesh):
    """No position and no vector of ours is NaN or infinite."""
    for item in mesh.attributes:
        ours = item.name == "position" or "framelet" in item.name
        if ours and item.data_type == "FLOAT_VECTOR" and len(item.data):
            values = np.empty(3 * len(item.data), np.float32)
            item.data.foreach_get("vector", values)
            assert np.isfinite(values).all(), f"{item.name} of {mesh.name}"


def check_registration():
    """Nothing of Framelet is in Blender twice."""
    for name, handler in handlers._HANDLERS.items():
        assert getattr(bpy.app.handlers, name).count(handler) == 1, name
        ours = [each for each in getattr(bpy.app.handlers, name) if "framelet" in each.__module__]
        assert len(ours) == 1, f"{name}: {ours}"
    groups = Counter(group[KIND] for group in bpy.data.node_groups if KIND in group and not group.library)
    assert not [kind for kind, number in groups.items() if number > 1], groups
    assert all(each.is_registered for each in registration.classes)
