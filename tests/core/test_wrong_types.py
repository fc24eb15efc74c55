# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of another type are refused in one sentence, and not by what stumbles over them deep inside."""

import numpy as np
import pytest
from framelet import core
from framelet.core import PRESETS, MeshError, SettingError, denoise
from framelet.core.denoise import denoise as walk
from framelet.core.mesh.connectivity import connect
from framelet.core.preparation_cache import PreparationCache
from framelet.core.prepared import prepare
from meshes import faces_of, mixed_sheet, triangle_torus

WRONG = [5, "x", [1, 2], {}, True, b"1", np.zeros((2, 2)), [[0.5] * 40] * 40, 10**400, 10**5000, object()]
"""What is no mesh, no settings, no function, nothing that is prepared, and no neighborhoods."""


@pytest.mark.parametrize(
    "name", ["settings", "connectivity", "callback", "should_stop", "prepared", "region", "dtype", "movable"]
)
def test_arguments_of_another_type_are_refused_in_one_line(name):
    mesh = triangle_torus()
    vertices, faces = mesh.vertices, faces_of(mesh)
    for value in WRONG:
        calls = [
            lambda value=value: denoise(vertices, faces, **{name: value}),
            lambda value=value: walk(mesh, **{name: value}),
        ]
        if name in ("settings", "connectivity", "should_stop", "dtype"):
            calls.append(lambda value=value: prepare(mesh, **{name: value}))
        if name in ("settings", "should_stop", "dtype"):
            given = {"settings": PRESETS["TRI_2"].settings, name: value}
            calls.append(lambda given=given: PreparationCache().prepare(mesh, **given))
        if name == "connectivity":
            calls.append(lambda value=value: core.estimate_noise(vertices, faces, connectivity=value))
        for call in calls:
            with pytest.raises(core.FrameletError) as caught:
                call()
            sentence = str(caught.value)
            assert "\n" not in sentence and sentence.endswith(".") and len(sentence) < 200, sentence


def test_what_is_no_mesh_is_refused_in_one_line():
    for value in [*WRONG, None]:
        for call in (
            lambda value=value: walk(value),
            lambda value=value: prepare(value),
            lambda value=value: PreparationCache().prepare(value, PRESETS["TRI_2"].settings),
            lambda value=value: denoise(value, [[0, 1, 2]]),
            lambda value=value: core.estimate_noise(value, [[0, 1, 2]]),
        ):
            with pytest.raises(MeshError) as caught:
                call()
            assert "\n" not in str(caught.value) and len(str(caught.value)) < 200


def test_prepared_before_is_what_prepare_returned():
    mesh = triangle_torus()
    with pytest.raises(SettingError, match="What was prepared before is 5; give what `prepare` returned"):
        prepare(mesh, previous=5)
    with pytest.raises(SettingError, match="The size of a block is 0"):
        prepare(mesh, block_size=0)


def test_neighborhoods_of_another_mesh_are_refused():
    mesh, other = triangle_torus(), mixed_sheet()
    fewer = core.SurfaceMesh.from_faces(mesh.vertices, faces_of(mesh)[1:])
    for each in (other, fewer):
        for call in (denoise, core.estimate_noise, prepare):
            with pytest.raises(MeshError, match=r"The connectivity is of a mesh with .* connect it again"):
                call(mesh, connectivity=connect(each))
    known = denoise(mesh, preset="tri-2", connectivity=connect(mesh)).vertices
    np.testing.assert_array_equal(known, denoise(mesh, preset="tri-2").vertices)


@pytest.mark.parametrize("name", ["preset", "settings", "full_output"])
def test_the_bilateral_filter_says_what_it_does_not_take(name):
    mesh = triangle_torus()
    with pytest.raises(SettingError, match=f"The bilateral filter has no {name}; call denoise"):
        core.bilateral_filter(mesh, **{name: None})


def test_noise_beyond_all_numbers_is_refused():
    mesh = triangle_torus()
    with pytest.raises(SettingError, match="The noise level is a huge number; it must be a finite number"):
        core.add_noise(mesh, 10**400)
    with pytest.raises(SettingError, match="full_output is array"):
        denoise(mesh, full_output=np.zeros(3))


NO_NUMBER = [None, "x", [1, 2], {}, True, b"1", np.zeros((2, 2)), [[1.0], [1.0, 2.0]], object(), 1j]
"""What is neither a number nor a word that is known."""


def calls_with(mesh, W):
    """Return the public functions, each with the names of its arguments, and a call of it with one wrong."""
    coefficients = W.analyze(mesh.vertices)
    prox, bank = core.SoftThreshold(0.1), core.BANKS["B_SPLINE_1"]
    frame, threads = "frame stencil boundary", "threads"
    transform = f"{frame} levels connectivity {threads} dtype"
    banks = {"name": "MINE", "lattice": "ANY", "offsets": bank.offsets, "masks": bank.masks}
    return {
        "add_noise": ("sigma seed", lambda **wrong: core.add_noise(mesh, **wrong)),
        "analyze": ("frame stencil levels", lambda **wrong: core.analyze(mesh, **wrong)),
        "bilateral_filter": (
            "iterations tolerance sigma_c sigma_s boundary threads",
            lambda **wrong: core.bilateral_filter(mesh, **wrong),
        ),
        "compare": ("reference", lambda **wrong: core.compare(mesh, **wrong)),
        "connect": (threads, lambda **wrong: core.connect(mesh, **wrong)),
        "denoise": (
            "method strength noise passes boundary threads",
            lambda **wrong: denoise(mesh, **wrong),
        ),
        "equalize": (
            f"gains {frame} {threads} dtype",
            lambda **wrong: core.equalize(mesh, **{"gains": [0.5], **wrong}),
        ),
        "estimate_noise": (f"connectivity {threads}", lambda **wrong: core.estimate_noise(mesh, **wrong)),
        "make_stencil": (
            "stencil boundary bank level threads",
            lambda **wrong: core.make_stencil(mesh, **wrong),
        ),
        "make_transform": (transform, lambda **wrong: core.make_transform(mesh, **wrong)),
        "FrameTransform": (
            transform.replace("connectivity ", ""),
            lambda **wrong: core.FrameTransform(mesh, **wrong),
        ),
        "noise_field": ("after", lambda **wrong: core.noise_field(mesh, **wrong)),
        "prepare": ("settings dtype previous block_size", lambda **wrong: core.prepare(mesh, **wrong)),
        "PreparationCache": ("max_bytes", core.PreparationCache),
        "split_bregman": (
            "vertices transform prox penalty mu delta iterations tolerance callback",
            lambda **wrong: core.split_bregman(
                **{"vertices": mesh.vertices, "transform": W, "prox": prox, **wrong}
            ),
        ),
        "SoftThreshold": ("weight kind", lambda **wrong: core.SoftThreshold(**{"weight": 1.0, **wrong})),
        "HardThreshold": ("weight kind", lambda **wrong: core.HardThreshold(**{"weight": 1.0, **wrong})),
        "FirmThreshold": (
            "weight limit kind",
            lambda **wrong: core.FirmThreshold(**{"weight": 1.0, "limit": 2.0, **wrong}),
        ),
        "FilterBank": ("lattice offsets masks", lambda **wrong: core.FilterBank(**{**banks, **wrong})),
        "synthesize": ("coefficients", core.synthesize),
        "adjoint": ("coefficients", core.adjoint),
        "W.analyze": ("vertices", W.analyze),
        "W.synthesize": ("coefficients", W.synthesize),
        "W.weighted_adjoint": ("coefficients", W.weighted_adjoint),
        "W.frame_bounds": ("steps", W.frame_bounds),
        "coefficients": ("given", lambda given: W.adjoint([coefficients[0], given])),
    }


OPTIONAL = {"connectivity", "settings", "previous", "penalty", "callback", "bank", "dtype"}
"""Arguments for which None is what was not given."""


@pytest.mark.parametrize("name", calls_with(triangle_torus(), core.FrameTransform(triangle_torus())))
def test_every_argument_of_every_public_function_is_checked(name):
    mesh = triangle_torus()
    names, call = calls_with(mesh, core.FrameTransform(mesh))[name]
    for argument in names.split():
        for value in NO_NUMBER:
            is_right = value is None and argument in OPTIONAL
            if is_right or (argument == "gains" and type(value) in (list, bytes)):  # which are gains
                continue
            with pytest.raises(core.FrameletError) as caught:
                call(**{argument: value})
            sentence = str(caught.value)
            assert "\n" not in sentence and sentence.endswith(".") and len(sentence) < 400, sentence
