# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drafts lie between known results, and know when nothing is known."""

import threading
from dataclasses import replace

import bpy
import numpy as np
import pytest
from framelet.core import PRESETS
from framelet.operators import current_preview, mesh_bridge, preview_session
from framelet.operators.denoise_job import DenoiseJob, compute
from framelet.operators.preview_drafts import MOST, StrengthDrafts
from meshes import noisy, triangle_torus

AUTO = PRESETS["AUTO"].settings
SECONDS = 60


@pytest.fixture
def job(rng):
    surface = noisy(triangle_torus(), rng)
    return DenoiseJob("Torus", surface.with_vertices(surface.vertices.astype(np.float32)), AUTO, np.eye(3))


def at(job, strength):
    return replace(job, settings=job.settings.with_changes(strength=strength))


def result(job, amount):
    return (job.surface.vertices + np.float32([0, 0, amount])).astype(np.float32)


def test_between_two_strengths(job):
    drafts = StrengthDrafts()
    assert drafts.draft(at(job, 1.0)) is None
    drafts.note(at(job, 1.0), result(job, 10.0))
    drafts.note(at(job, 2.0), result(job, 14.0))
    for strength, amount in ((0.0, 0.0), (0.5, 5.0), (1.0, 10.0), (1.25, 11.0), (2.0, 14.0), (9.0, 14.0)):
        draft = drafts.draft(at(job, strength))
        assert draft.dtype == np.float32
        assert np.allclose(draft, result(job, amount), atol=1e-5)
    assert drafts.draft(at(job, 0.0)).tobytes() == job.surface.vertices.tobytes()
    assert drafts.draft(at(job, 2.0)).tobytes() == result(job, 14.0).tobytes()


def test_vertices_that_stay_keep_their_bits(job):
    drafts = StrengthDrafts()
    moved = job.surface.vertices.copy()
    moved[:10] += 1.0
    drafts.note(at(job, 1.0), moved)
    draft = drafts.draft(at(job, 0.3))
    assert draft[10:].tobytes() == job.surface.vertices[10:].tobytes()


def test_other_settings_and_regions_know_nothing_of_it(job):
    drafts = StrengthDrafts()
    drafts.note(job, result(job, 1.0))
    fixed = replace(job, settings=job.settings.with_changes(boundary="FIXED"))
    assert drafts.draft(fixed) is None
    assert drafts.draft(replace(job, region=object())) is None
    assert drafts.draft(replace(job, settings=PRESETS["TRI_2"].settings)) is None
    drafts.note(fixed, result(job, 2.0))
    assert drafts.draft(job) is None and drafts.draft(fixed) is not None


def test_the_oldest_are_dropped(job):
    drafts = StrengthDrafts()
    for strength in range(1, MOST + 3):
        drafts.note(at(job, float(strength)), result(job, strength))
    assert np.allclose(drafts.draft(at(job, 1.0)), result(job, 1.0), atol=1e-5), "halfway from 0, by chance"
    assert len(drafts._known) == MOST and min(drafts._known) == 3.0


def test_a_preview_shows_a_draft_until_the_result_is_there(monkeypatch):
    go = threading.Event()
    go.set()

    def gated(job, callback=None, should_stop=None):
        while not go.wait(0.005):
            if should_stop():
                break
        return compute(job, callback, should_stop)

    monkeypatch.setattr(preview_session, "compute", gated)
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    surface = mesh_bridge.read_surface(obj)
    values = bpy.context.scene.framelet
    assert values.method == "AUTO"
    bpy.ops.object.framelet_preview()
    session = current_preview.current_preview()
    try:
        assert session.wait(SECONDS)
        current_preview.tick_preview()
        full = mesh_bridge.read_positions(obj.data)
        go.clear()
        values.strength = 0.5
        current_preview.tick_preview()
        draft = mesh_bridge.read_positions(obj.data)
        assert np.allclose(draft, (surface.vertices + full) / 2, atol=1e-6)
        assert not session.is_current and not bpy.ops.object.framelet_apply_preview.poll()
        go.set()
        assert session.wait(SECONDS)
        current_preview.tick_preview()
        assert session.is_current
    finally:
        go.set()
        current_preview.stop_preview()
    assert mesh_bridge.read_positions(obj.data).tobytes() == surface.vertices.tobytes()
