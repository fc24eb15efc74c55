# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison of two checkouts: what it takes for the same, and what for different."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

SCRIPT = Path(__file__).with_name("run.py")


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("golden", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def results(**cases):
    return {"edge": np.array(2.0)} | cases


def test_distances_are_in_mean_edge_lengths(script):
    old, new = np.zeros((3, 3), np.float32), np.zeros((3, 3), np.float32)
    new[1, 2] = 0.5
    ((case, distances, is_same),) = script.differences(results(AUTO=old, GONE=old), results(AUTO=new))
    assert case == "AUTO" and distances.tolist() == [0.0, 0.25, 0.0] and not is_same


def test_bits_are_compared_and_not_values(script):
    zero = np.zeros((1, 3), np.float32)
    ((_, distances, is_same),) = script.differences(results(AUTO=zero), results(AUTO=-zero))
    assert distances.tolist() == [0.0] and not is_same
    ((_, _, is_same),) = script.differences(results(AUTO=zero), results(AUTO=zero.copy()))
    assert is_same


def test_what_one_refuses_is_different(script):
    moved, refused = np.zeros((1, 3), np.float32), np.array("no")
    for old, new, distance in ((refused, refused, 0.0), (moved, refused, np.inf), (refused, moved, np.inf)):
        ((_, distances, is_same),) = script.differences(results(QUAD_1=old), results(QUAD_1=new))
        assert distances.tolist() == [distance] and is_same == (distance == 0.0)
