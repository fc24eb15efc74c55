# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which frame serves which mesh, and that a frame entered in the catalog is a choice everywhere."""

import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import framelet.core as core
import numpy as np
import pytest
from framelet.core import BANKS, PRESETS, DenoiseSettings, connect, denoise, make_transform
from framelet.core.frames.valence_masks import FAMILIES
from framelet.core.settings.choices import FRAMES
from framelet.core.settings.frame_catalog import FRAME_CATALOG
from framelet.core.transform import choose_frame
from framelet.core.transform.make import check_fit
from meshes import (
    MESHES,
    noisy,
    prism,
    pyramid,
    quad_grid,
    quad_torus,
    soup,
    triangle_grid,
    triangle_torus,
    union,
)

CHOICES = {
    "triangle torus": "BOX_SPLINE_111",
    "irregular grid": "BOX_SPLINE_111",
    "moebius strip": "BOX_SPLINE_111",
    "bow tie": "BOX_SPLINE_111",
    "three pages": "BOX_SPLINE_111",
    "single triangle": "BOX_SPLINE_111",
    "quad torus": "LINEAR_SPLINE",
    "quad grid": "LINEAR_SPLINE",
    "single quad": "LINEAR_SPLINE",
    "prism": "ADAPTIVE",
    "mixed sheet": "ADAPTIVE",
    "soup": "ADAPTIVE",
}


@pytest.mark.parametrize("name", CHOICES)
def test_automatic_takes_what_fits_the_faces(name, rng):
    mesh = noisy(MESHES[name](), rng)
    connectivity = connect(mesh)
    assert choose_frame("AUTO", connectivity) == CHOICES[name]
    for entry in FRAME_CATALOG:
        assert choose_frame(entry.identifier, connectivity) == entry.identifier
    own, auto = (
        denoise(mesh, DenoiseSettings(method="POSITIONS", frame=frame)).vertices
        for frame in (CHOICES[name], "AUTO")
    )
    assert np.array_equal(own, auto)


def test_loose_vertices_do_not_count():
    torus = triangle_torus()
    stray = core.SurfaceMesh.from_faces(
        np.concatenate((torus.vertices, np.eye(3))), torus.corner_vertex.reshape(-1, 3), [(192, 193)]
    )
    assert choose_frame("AUTO", connect(stray)) == "BOX_SPLINE_111"


def test_one_other_face_makes_a_mesh_mixed():
    assert choose_frame("AUTO", connect(union(quad_torus(), pyramid(3)))) == "ADAPTIVE"
    assert choose_frame("AUTO", connect(union(triangle_torus(), quad_grid(2, 2)))) == "ADAPTIVE"


def test_the_catalog_lists_every_bank_and_family():
    names = [entry.identifier for entry in FRAME_CATALOG]
    assert len(set(names)) == len(names)
    assert names == [*BANKS, *FAMILIES]
    for entry in FRAME_CATALOG:
        assert bool(entry.module) == (entry.identifier in BANKS)
        expected = BANKS[entry.identifier].lattice if entry.module else "ANY"
        assert entry.lattice == expected
        assert not entry.module or BANKS[entry.identifier].name == entry.identifier
        assert entry.label and len(entry.description) > 20
        assert not entry.description.endswith(".")
    assert len({entry.label for entry in FRAME_CATALOG}) == len(names)


def test_settings_offer_automatic_and_the_catalog():
    assert [choice.identifier for choice in FRAMES] == [
        "AUTO",
        *(entry.identifier for entry in FRAME_CATALOG),
    ]
    (info,) = [item.metadata["info"] for item in fields(DenoiseSettings) if item.name == "frame"]
    assert info.choices == FRAMES
    for choice, entry in zip(FRAMES[1:], FRAME_CATALOG, strict=True):
        assert (choice.label, choice.description) == (entry.label, entry.description)
        assert DenoiseSettings(method="POSITIONS", frame=entry.identifier).frame == entry.identifier
    assert {preset.settings.frame for preset in PRESETS.values()} <= {choice.identifier for choice in FRAMES}


NEW_ENTRY = """
import importlib.util, sys, types
spec = importlib.util.spec_from_file_location("framelet", {init!r}, submodule_search_locations=[{root!r}])
sys.modules["framelet"] = importlib.util.module_from_spec(spec)
name = "framelet.core.settings.frame_catalog"  # before the choices are made of it
spec = importlib.util.spec_from_file_location(name, {root!r} + "/core/settings/frame_catalog.py")
frame_catalog = sys.modules[name] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(frame_catalog)
assert "numpy" not in sys.modules, "the list of frames must not cost numpy"
entry = frame_catalog.FrameEntry("MINE", "Mine", "Quads: made for this test", "QUADS", "mine")
frame_catalog.FRAME_CATALOG += (entry,)

class Late(types.ModuleType):
    def __getattr__(self, name):
        if name != "MINE":
            raise AttributeError(name)
        from framelet.core.frames.filter_bank import FilterBank
        from framelet.core.frames.linear_spline import LINEAR_SPLINE as own
        return FilterBank("MINE", "QUADS", own.offsets, own.masks)
sys.modules["framelet.core.frames.mine"] = Late("framelet.core.frames.mine")
"""
NEW_BANK = """
import numpy as np
from framelet.core import BANKS, DenoiseSettings, SurfaceMesh, denoise, equalize, make_transform
grid = np.arange(36).reshape(6, 6)
faces = np.stack((grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]), -1).reshape(-1, 4)
points = np.random.default_rng(0).normal(size=(36, 3))
mesh = SurfaceMesh.from_faces(points, faces)
assert BANKS["MINE"].n_bands == 9
transform = make_transform(mesh, "MINE", levels=2)
assert np.abs(transform.synthesize(transform.analyze(points)) - points).max() < 1e-12
same = DenoiseSettings(method="POSITIONS", frame="LINEAR_SPLINE", levels=2)
assert np.array_equal(denoise(mesh, same.with_changes(frame="MINE")).vertices, denoise(mesh, same).vertices)
assert np.array_equal(equalize(mesh, [2], frame="MINE"), equalize(mesh, [2], frame="LINEAR_SPLINE"))
sys.stdout.write("works")
"""


def test_a_new_bank_is_one_entry_and_one_module():
    """With an entry in the catalog and a module that holds the bank, every function takes its name."""
    root = Path(core.__file__).resolve().parent.parent
    program = NEW_ENTRY.format(init=str(root / "__init__.py"), root=str(root)) + NEW_BANK
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "works"


@pytest.mark.parametrize("name", BANKS)
def test_frames_for_quads_say_so_on_meshes_without(name):
    bank = BANKS[name]
    for mesh in (triangle_torus(), MESHES["moebius strip"](), pyramid(3)):
        if bank.lattice == "QUADS":
            message = (
                f"^{name} is a frame for quads, but the mesh has none; use a box spline frame or ADAPTIVE\\.$"
            )
            with pytest.raises(ValueError, match=message):
                check_fit(bank, connect(mesh))
        else:
            check_fit(bank, connect(mesh))
    for mesh in (quad_grid(2, 2), prism(), union(triangle_torus(), quad_grid(2, 2))):
        check_fit(bank, connect(mesh))


@pytest.mark.parametrize("name", BANKS)
def test_frames_on_cells_say_so_on_meshes_without(name):
    bank = BANKS[name]
    hexagons = core.SurfaceMesh.from_faces(np.random.default_rng(0).normal(size=(6, 3)), [range(6)])
    for mesh in (MESHES["single triangle"](), hexagons):
        if bank.is_cell_centered:
            message = f"^{name} needs quads or pairs of triangles, but the mesh has none; use ADAPTIVE\\.$"
            with pytest.raises(ValueError, match=message):
                make_transform(mesh, name)
        elif bank.lattice == "TRIANGLES":
            make_transform(mesh, name)


@pytest.mark.parametrize(
    "frame", ["BOX_SPLINE_111", "LINEAR_SPLINE", "B_SPLINE_1", "B_SPLINE_6", "ADAPTIVE", "PAIRWISE"]
)
def test_too_many_levels_are_refused_with_the_largest_number_that_works(frame):
    """The number in the sentence works, and one more does not."""
    mesh = triangle_grid(6, 7) if frame == "BOX_SPLINE_111" else quad_grid(6, 7)
    with pytest.raises(
        ValueError, match=r"^The mesh is too small for \d levels: nothing is \d+ edges apart; use"
    ) as error:
        make_transform(mesh, frame, levels=6)
    text = str(error.value)
    assert text.endswith("or fewer.")
    works = int(text.split("use ")[1].split()[0])
    make_transform(mesh, frame, levels=works)
    assert f"too small for {works + 1} levels: nothing is {2**works} edges apart" in text
    assert f"use {works} level{'s' if works > 1 else ''} or fewer." in text
    with pytest.raises(ValueError, match="too small"):
        make_transform(mesh, frame, levels=works + 1)
    with pytest.raises(ValueError, match="too small"):
        denoise(mesh, DenoiseSettings(method="POSITIONS", frame=frame, levels=works + 1))


@pytest.mark.parametrize("frame", [entry.identifier for entry in FRAME_CATALOG])
def test_a_soup_of_polygons_is_served_or_refused(frame):
    """No frame and level may crash on rubbish, or give numbers that are not finite."""
    for seed in range(2):
        mesh = soup(seed, shortest=1 + 2 * (seed % 2))
        try:
            result = denoise(mesh, DenoiseSettings(method="POSITIONS", frame=frame, levels=1 + seed))
        except ValueError as error:
            assert any(words in str(error) for words in ("too small", "but the mesh has none"))
            continue
        assert np.isfinite(result.vertices).all()
