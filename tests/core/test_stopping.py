# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that is asked to stop stops at once, wherever it is, and leaves everything as it was."""

import threading

import pytest
from checks import assert_same_bits, preset_settings, read_only
from framelet.core import PRESETS, PreparationCache, denoise
from framelet.core.blocks import Blocks, Stopped
from meshes import noisy, triangle_torus

METHODS = ("AUTO", "TRI_1", "TRI_2", "BILATERAL")
"""A preset of each method, and of both kinds of stencils."""


def asked(limit=None):
    """Return a function that says True from its `limit`-th call on, and the list of its calls."""
    calls = []

    def should_stop():
        calls.append(threading.current_thread())
        return limit is not None and len(calls) >= limit

    return should_stop, calls


@pytest.fixture
def mesh(rng):
    return read_only(noisy(triangle_torus(24, 12), rng))


def counted(mesh, settings, **more):
    should_stop, calls = asked()
    denoise(mesh, settings, should_stop=should_stop, **more)
    return len(calls)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("preset", METHODS)
def test_stops_at_any_question(preset, threads, mesh, rng):
    settings = preset_settings(preset, threads=threads)
    total = counted(mesh, settings)
    assert total > 10
    before = threading.active_count()
    for limit in {1, total, *rng.integers(2, total, 5).tolist()}:
        should_stop, calls = asked(limit)
        result = denoise(mesh, settings, should_stop=should_stop)
        assert len(calls) == limit, "no question after the answer"
        assert result.report.is_stopped
        assert result.report.n_moved == 0
        assert_same_bits(result.vertices, mesh.vertices)
        assert threading.active_count() == before
    assert {thread.name for thread in calls} == {threading.current_thread().name}


@pytest.mark.parametrize("preset", METHODS)
def test_questions_do_not_change_the_result(preset, mesh):
    settings = PRESETS[preset].settings
    should_stop, _ = asked()
    result = denoise(mesh, settings, should_stop=should_stop)
    assert not result.report.is_stopped
    assert_same_bits(result.vertices, denoise(mesh, settings).vertices)


@pytest.mark.parametrize("preset", METHODS)
def test_a_cache_is_as_good_after_a_stop(preset, mesh, rng):
    """What a stopped run left in the arrays of the cache does not show in the next one."""
    settings = PRESETS[preset].settings
    expected = denoise(mesh, settings).vertices
    cache = PreparationCache()
    total = counted(mesh, settings, prepared=cache)
    for limit in rng.integers(1, total, 3 if preset == "AUTO" else 6).tolist():
        denoise(mesh, settings, should_stop=asked(limit)[0], prepared=cache)
        assert_same_bits(denoise(mesh, settings, prepared=cache).vertices, expected)


def test_a_stop_in_preparing_keeps_nothing_of_it(mesh):
    cache = PreparationCache()
    denoise(mesh, PRESETS["TRI_2"].settings, should_stop=asked(1)[0], prepared=cache)
    assert len(cache) == 0


@pytest.mark.parametrize("n_threads", [1, 2, 4])
def test_blocks_ask_before_each_block(n_threads):
    done = []
    should_stop, calls = asked(4)
    with pytest.raises(Stopped), Blocks(n_threads, block_size=10).entered(should_stop) as blocks:
        blocks.with_block_size(5).run(lambda start, stop: done.append(start), 50)
    assert len(calls) == 4
    assert set(done) >= {0, 5, 10}
    if n_threads == 1:
        assert done == [0, 5, 10]


def test_blocks_forget_the_question_on_leaving():
    blocks = Blocks(2, block_size=10)
    with pytest.raises(Stopped), blocks.entered(lambda: True):
        blocks.check()
    blocks.check()
    with blocks:
        assert blocks.run(lambda start, stop: stop - start, 25) == [10, 10, 5]
