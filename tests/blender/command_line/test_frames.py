# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""`denoise` with every frame, stencil, number of levels and preset, on triangles, quads and mixtures."""

import numpy as np
import pytest
from framelet.core import PRESETS, DenoiseSettings, SurfaceMesh, denoise
from framelet.core.settings.choices import FRAMES, STENCILS
from framelet.core.settings.effects import replaced_by
from framelet.operators.command_line.arguments import as_word

TOLERANCE = 1e-5  # another order of edges and faces changes the rounding


@pytest.fixture
def sheets(grid, write_ply, tmp_path):
    """The grid as it is, with triangles only and with quads only: paths and surfaces by kind."""
    triangles = [part for f in grid.faces for part in ([f] if len(f) == 3 else [f[:3], (f[0], f[2], f[3])])]
    number = np.arange(49).reshape(7, 7)
    number[number >= 10] += 1
    corners = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    quads = np.stack(corners, -1).reshape(-1, 4).tolist()
    found = {}
    for kind, faces in (("mixed", grid.faces), ("triangles", triangles), ("quads", quads)):
        path = write_ply(tmp_path / f"{kind}.ply", grid.vertices, faces)
        found[kind] = path, SurfaceMesh.from_faces(grid.vertices, faces)
    return found


@pytest.mark.parametrize("frame", [choice.identifier for choice in FRAMES])
@pytest.mark.parametrize("stencil", [choice.identifier for choice in STENCILS])
def test_every_frame_and_stencil(command, sheets, read_ply, tmp_path, frame, stencil):
    path, surface = sheets["mixed"]
    words = [
        "--preset",
        "positions",
        "--frame",
        as_word(frame),
        "--stencil",
        as_word(stencil),
        "--levels",
        "2",
    ]
    result = command("denoise", path, tmp_path / "out.ply", *words)
    settings = DenoiseSettings(method="POSITIONS", frame=frame, stencil=stencil, levels=2)
    if replaced_by(settings, "frame") or replaced_by(settings, "stencil"):
        # One of them alone says which masks these are; who names the other would wait for its effect in vain.
        assert result.code == 2 and "no effect" in result.err and not (tmp_path / "out.ply").exists()
        return
    assert (result.code, result.err) == (0, "")
    expected = denoise(surface, settings).vertices
    vertices = read_ply(tmp_path / "out.ply").vertices
    np.testing.assert_allclose(vertices, expected, atol=TOLERANCE)
    assert not np.array_equal(vertices, surface.vertices)


def test_levels_change_the_result(command, sheets, read_ply, tmp_path):
    results = []
    for levels in "123":
        words = ["--preset", "positions", "--levels", levels]
        assert command("denoise", sheets["quads"][0], tmp_path / "out.ply", *words).code == 0
        results.append(read_ply(tmp_path / "out.ply").vertices)
    assert np.abs(results[1] - results[0]).max() > 1e-3
    assert np.abs(results[2] - results[1]).max() > 1e-3


@pytest.mark.parametrize("kind", ["mixed", "triangles", "quads"])
@pytest.mark.parametrize("key", PRESETS)
def test_every_preset(command, fails, sheets, read_ply, tmp_path, kind, key):
    path, surface = sheets[kind]
    words = ["denoise", path, tmp_path / "out.ply", "--preset", as_word(key)]
    if key.startswith("QUAD") and kind == "triangles":
        assert "is a frame for quads, but the mesh has none" in fails(*words)
        assert not (tmp_path / "out.ply").exists()
        return
    result = command(*words)
    assert (result.code, result.err) == (0, "")
    single = surface.with_vertices(surface.vertices.astype(np.float32))  # as in the file
    expected = denoise(single, PRESETS[key].settings).vertices
    # Blender numbers edges in its own way, and the net works in single precision.
    tolerance = 1e-3 if PRESETS[key].settings.method == "AUTO" else TOLERANCE
    np.testing.assert_allclose(read_ply(tmp_path / "out.ply").vertices, expected, atol=tolerance)


@pytest.mark.parametrize(
    ("kind", "frame"),
    [("triangles", "box-spline-111"), ("quads", "linear-spline"), ("mixed", "adaptive")],
)
def test_auto_is_the_frame_that_fits(command, sheets, read_ply, tmp_path, kind, frame):
    results = []
    for words in ([], ["--frame", "auto"], ["--frame", frame]):
        options = ["--preset", "positions", *words]
        assert command("denoise", sheets[kind][0], tmp_path / "out.ply", *options).code == 0
        results.append(read_ply(tmp_path / "out.ply").vertices)
    np.testing.assert_array_equal(results[1], results[0])
    np.testing.assert_array_equal(results[2], results[0])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--levels", "6"], "The mesh is too small for"),
        (["--levels", "6", "--frame", "adaptive"], "The mesh is too small for"),
        (["--frame", "b-spline-4"], "B_SPLINE_4 is a frame for quads, but the mesh has none"),
    ],
)
@pytest.mark.parametrize("name", ["denoise", "bands", "equalize"])
def test_what_does_not_fit_is_refused(fails, sheets, tmp_path, name, words, message):
    path, _surface = sheets["triangles"]
    before = sorted(tmp_path.iterdir())
    if name == "bands":
        command = [name, path, "--out", tmp_path / "out.npz"]
    else:
        command = [name, path, tmp_path / "out.ply"]
    if name == "denoise":
        words = ["--preset", "positions", *words]
    if name == "equalize":
        n_levels = int(words[1]) if words[0] == "--levels" else 1
        command += ["--gains", ",".join(["0.5"] * n_levels)]
        words = words[2:] if words[0] == "--levels" else words
    sentence = fails(*command, *words)
    assert message in sentence and "triangles" in sentence
    assert sorted(tmp_path.iterdir()) == before
