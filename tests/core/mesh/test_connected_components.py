# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components against a search that goes from item to item."""

from time import process_time

import numpy as np
import pytest
from framelet.core.mesh.connected_components import connected_components


def searched(n_items, pairs):
    """Return the lowest item that each item is linked to, by a search from each."""
    linked = [[] for _ in range(n_items)]
    for a, b in pairs:
        linked[a].append(b)
        linked[b].append(a)
    label = [-1] * n_items
    for start in range(n_items):
        waiting = [start] if label[start] < 0 else []
        while waiting:
            item = waiting.pop()
            if label[item] < 0:
                label[item] = start
                waiting += linked[item]
    return label


@pytest.mark.parametrize("n_pairs", [0, 1, 20, 45, 200])
def test_they_are_those_of_a_search(n_pairs, rng):
    pairs = rng.integers(60, size=(n_pairs, 2))
    assert connected_components(60, *pairs.T).tolist() == searched(60, pairs.tolist())


@pytest.mark.parametrize("hub", [0, 50_000, 100_000])
def test_stars_and_chains_are_no_work(hub):
    """A star whose middle has the highest number was joined by one of its arms in a round, in minutes."""
    arms = np.delete(np.arange(100_001), hub)
    began = process_time()
    assert not connected_components(100_001, arms, np.full(len(arms), hub)).any()
    assert not connected_components(100_001, np.arange(100_000), np.arange(1, 100_001)).any()
    assert process_time() - began < 2.0
