# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Reading the virtual screen, and writing pictures of it; no window is needed."""

import struct
import zlib

import numpy as np
import pytest
from blender_window.pixels import changed, changed_box, read_screen, saturated, to_palette, write_png


def read_palette_png(content):
    """Return the picture of a PNG file with a palette and without filters."""
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, place = {}, 8
    while place < len(content):
        (length,) = struct.unpack(">I", content[place : place + 4])
        name, body = content[place + 4 : place + 8], content[place + 8 : place + 8 + length]
        (check,) = struct.unpack(">I", content[place + 8 + length : place + 12 + length])
        assert check == zlib.crc32(name + body)
        chunks[name] = body
        place += 12 + length
    width, height, *kind = struct.unpack(">2I5B", chunks[b"IHDR"])
    assert kind == [8, 3, 0, 0, 0]
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, width + 1)
    assert (rows[:, 0] == 0).all()
    return np.frombuffer(chunks[b"PLTE"], np.uint8).reshape(-1, 3)[rows[:, 1:]]


def test_few_colors_are_kept_exactly(rng, tmp_path):
    colors = rng.integers(0, 256, (200, 3), dtype=np.uint8)
    picture = colors[rng.integers(0, 200, (40, 61))]
    write_png(tmp_path / "picture.png", picture)
    assert np.array_equal(read_palette_png((tmp_path / "picture.png").read_bytes()), picture)


def test_many_colors_become_close_ones(rng):
    ramp = np.linspace(0, 255, 300)
    picture = np.stack(np.broadcast_arrays(ramp[:, None], ramp[None, :], 90.0), -1).astype(np.uint8)
    palette, indices = to_palette(picture)
    assert len(palette) <= 256
    error = np.abs(palette[indices].astype(int) - picture.astype(int)).max(axis=2)
    assert error.max() <= 20
    assert error.mean() < 9


def test_screen_is_read(rng, tmp_path):
    picture = rng.integers(0, 256, (5, 7, 3), dtype=np.uint8)
    pixels = np.zeros((5, 8, 4), np.uint8)  # rows are padded to 32 bytes
    pixels[:, :7, 2::-1] = picture
    header = [0] * 25
    header[0], header[4], header[5], header[7], header[11], header[12], header[19] = 104, 7, 5, 0, 32, 32, 2
    content = struct.pack(">25I", *header) + b"\0" * (4 + 2 * 12) + pixels.tobytes()
    (tmp_path / "screen").write_bytes(content)
    assert np.array_equal(read_screen(tmp_path / "screen"), picture)


def test_screen_of_another_depth_is_refused(tmp_path):
    header = [0] * 25
    header[11] = 16
    (tmp_path / "screen").write_bytes(struct.pack(">25I", *header))
    with pytest.raises(ValueError, match="16 bits"):
        read_screen(tmp_path / "screen")


def test_what_has_changed():
    before = np.full((100, 200, 3), 60, np.uint8)
    after = before.copy()
    assert changed(before, after) == 0.0
    assert changed_box(before, after)[2:] == (0, 0)
    after[20:60, 50:130] = 200
    after[90, 10] = 255  # a single pixel is no menu
    assert changed(before, after) == pytest.approx((40 * 80 + 1) / 20000)
    assert changed_box(before, after) == (50, 40, 80, 40)


def test_gray_is_not_saturated():
    picture = np.full((10, 10, 3), 180, np.uint8)
    assert saturated(picture) == 0.0
    picture[:5] = (200, 40, 40)
    assert saturated(picture) == 0.5
