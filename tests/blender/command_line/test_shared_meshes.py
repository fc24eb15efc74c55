# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Scans and malformed meshes go through, or are refused with a sentence."""

import numpy as np
import pytest

REFUSED = {
    "all_coincident.obj",
    "empty.obj",
    "nan_vertex.ply",
    "one_edge.ply",
    "single_vertex.ply",
    "wire_polyline.ply",
}


@pytest.mark.parametrize(
    ("name", "preset"),
    [
        ("scan/angel25k.ply", "auto"),
        ("scan/iron86k.ply", "positions"),
        ("tri/bunny_scan35k.ply", "free-form"),
    ],
)
def test_scans(command, shared_meshes, read_ply, tmp_path, name, preset):
    result = command("denoise", shared_meshes / name, tmp_path / "out.ply", "--preset", preset)
    assert (result.code, result.err) == (0, "")
    before, after = read_ply(shared_meshes / name), read_ply(tmp_path / "out.ply")
    assert after.vertices.shape == before.vertices.shape
    assert np.isfinite(after.vertices).all()
    assert not np.array_equal(after.vertices, before.vertices)
    assert after.faces == before.faces


@pytest.mark.parametrize("folder", ["nonmanifold", "bad"])
def test_malformed_meshes(command, shared_meshes, read_ply, tmp_path, folder):
    target = tmp_path / "out.ply"
    for source in sorted((shared_meshes / folder).iterdir()):
        target.unlink(missing_ok=True)
        result = command("denoise", source, target)
        assert "Traceback" not in result.err, source.name
        if source.name in REFUSED:
            assert result.code == 1 and result.err.count("\n") == 1, source.name
            assert not target.exists()
        else:
            assert result.code == 0, (source.name, result.err)
            assert np.isfinite(read_ply(target).vertices).all(), source.name
            assert all(line.startswith("framelet: warning: ") for line in result.err.splitlines())


@pytest.mark.parametrize("folder", ["nonmanifold", "bad"])
@pytest.mark.parametrize("name", ["bands", "equalize"])
def test_malformed_meshes_in_other_commands(command, shared_meshes, read_ply, tmp_path, name, folder):
    target = tmp_path / ("out.npz" if name == "bands" else "out.ply")
    words = ["--out", target] if name == "bands" else [target, "--gains", "0.5"]
    for source in sorted((shared_meshes / folder).iterdir()):
        target.unlink(missing_ok=True)
        result = command(name, source, *words)
        assert "Traceback" not in result.err, source.name
        assert target.exists() == (result.code == 0), source.name
        if result.code:
            assert result.code == 1 and result.err.count("\n") == 1, (source.name, result.err)
            # Loose triangles and single faces have nothing to pair.
            assert source.name in REFUSED or "too small" in result.err, (source.name, result.err)
        elif name == "equalize":
            assert np.isfinite(read_ply(target).vertices).all(), source.name
        else:
            with np.load(target, allow_pickle=False) as arrays:
                assert np.isfinite(arrays["low"]).all() and np.isfinite(arrays["L1"]).all(), source.name


@pytest.mark.parametrize("name", ["tiny_1e-6", "offset_1e7", "anisotropic_1e4", "flat_quads"])
def test_extreme_sizes_as_obj(command, shared_meshes, read_obj, tmp_path, name):
    source = shared_meshes / "bad" / f"{name}.obj"
    assert command("denoise", source, tmp_path / "out.obj").code == 0
    before, after = read_obj(source), read_obj(tmp_path / "out.obj")
    size = np.ptp(before.vertices, axis=0).max()
    assert after.vertices.shape == before.vertices.shape
    assert np.abs(after.vertices - before.vertices).max() < 0.5 * size
    assert len(np.unique(after.vertices, axis=0)) > 0.5 * len(before.vertices)
