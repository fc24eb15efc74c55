# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks and threads: the same bits for any number of threads, and no Python loop over the vertices."""

import cProfile
import pstats
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from checks import TRIANGLE_PRESETS, assert_same_bits, preset_settings
from framelet.core import SurfaceMesh, add_noise, compare, denoise, prepare
from framelet.core.blocks import BLOCK_SIZE, Blocks
from framelet.core.mesh.connectivity import connect
from framelet.core.mesh.distance_rings import CENTERS_AT_ONCE
from framelet.core.mesh.geometry import mean_edge_length
from framelet.core.processors import default_threads
from framelet.core.stencils import make_stencil
from framelet.operators.machine import available_processors
from meshes import flipped, mixed_sheet, noisy, pyramid, triangle_grid, triangle_torus, turned_over, union

ROOT = Path(__file__).resolve().parents[2]
SMALL = 2048
CALLS_OF_A_SEARCH = 400
COLUMNS = 65


def in_small_blocks(mesh, settings, **given):
    """Return the result of a run in blocks so small that meshes of thousands of vertices have several."""
    dtype = given.get("dtype", np.float32)
    return denoise(mesh, settings, prepared=prepare(mesh, settings, dtype=dtype, block_size=SMALL), **given)


@pytest.fixture(scope="module")
def large():
    """A noisy mesh of more than two blocks, open, with irregular vertices and two that are not manifold."""
    mesh = triangle_grid(75, COLUMNS)
    rng = np.random.default_rng(5)
    faces = mesh.corner_vertex.reshape(-1, 3)[rng.random(mesh.n_faces) > 0.01]
    return noisy(SurfaceMesh.from_faces(mesh.vertices, faces), rng)


@pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
def test_threads_do_not_change_a_bit(preset, large):
    assert large.n_vertices > 2 * SMALL
    settings = preset_settings(preset, iterations=2, delta=0.1, sigma_c=0.5)
    changes, results = [], []
    for threads in (1, 2, 4):
        seen = []
        result = in_small_blocks(
            large, settings.with_changes(threads=threads), callback=lambda *s, seen=seen: seen.append(s)
        )
        changes.append(seen)
        results.append(result.vertices)
    assert_same_bits(results[0], results[1])
    assert_same_bits(results[0], results[2])
    assert changes[0] == changes[1] == changes[2]


@pytest.mark.parametrize("preset", ["TRI_1", "TRI_2"])
def test_nothing_happens_at_block_borders(preset, large):
    """A patch around a border, cut out and solved alone, has the same inside: it reaches one hop a step."""
    settings = preset_settings(preset, iterations=5, boundary="FREE")
    result = in_small_blocks(large, settings, dtype=np.float64)
    for border in (SMALL, 2 * SMALL):
        near = np.arange(border - 10 * COLUMNS, min(border + 10 * COLUMNS, large.n_vertices))
        faces = large.corner_vertex.reshape(-1, 3)
        faces = faces[np.isin(faces, near).all(axis=1)]
        patch = SurfaceMesh.from_faces(large.vertices[near], faces - near[0])
        ratio = result.report.mean_edge_length / mean_edge_length(patch)  # lambda is in units of it
        local = denoise(
            patch, settings.with_changes(lambda_=settings.lambda_ * ratio), dtype=np.float64
        ).vertices
        inside = np.abs(near - border) < 4 * COLUMNS
        assert np.abs(local[inside] - result.vertices[near][inside]).max() < 1e-9


def calls(function):
    """Return the number of Python function calls, those into numpy included."""
    profile = cProfile.Profile()
    profile.runcall(function)
    return pstats.Stats(profile).total_calls


def work(preset, mesh):
    """Return a function that does all that a run does."""
    settings = preset_settings(preset, threads=1, iterations=3)

    def run():
        result = denoise(mesh, settings)
        compare(mesh.with_vertices(result.vertices), mesh)
        add_noise(mesh)

    denoise(triangle_grid(), settings)  # imports and caches
    return run


@pytest.mark.parametrize("preset", TRIANGLE_PRESETS)
def test_python_calls_do_not_grow_with_the_mesh(preset, rng):
    """One block either way: four copies of a mesh have the same kinds of vertices and cost the same calls."""
    one = noisy(
        union(
            flipped(triangle_torus()), turned_over(mixed_sheet()), flipped(triangle_grid()), pyramid(40, True)
        ),
        rng,
    )
    four = union(*[one.with_vertices(one.vertices)] * 4)
    assert 4 * one.n_vertices == four.n_vertices < BLOCK_SIZE
    small, large = calls(work(preset, one)), calls(work(preset, four))
    assert small > 100
    # A few rounds more of pointer doubling; the bilateral filter looks for neighbors of 512 vertices at once.
    n_searches = four.n_vertices // CENTERS_AT_ONCE if preset == "BILATERAL" else 0
    assert large <= small + 20 + CALLS_OF_A_SEARCH * n_searches


@pytest.mark.parametrize("preset", ["AUTO", "FREE_FORM"])
def test_python_calls_of_learned_shrinkage_grow_with_its_blocks_only(preset, rng):
    """A call for each face or vertex would be four times as many, and tens of thousands."""
    one, four = (noisy(triangle_torus(*size), rng) for size in ((40, 48), (80, 96)))
    assert 4 * one.n_faces == four.n_faces
    small, large = calls(work(preset, one)), calls(work(preset, four))
    assert small > 100 and large < 3 * small


def test_python_calls_grow_with_the_number_of_blocks_only(rng):
    small_mesh, large_mesh = triangle_grid(128, 256), triangle_grid(256, 512)
    small_mesh, large_mesh = noisy(small_mesh, rng), noisy(large_mesh, rng)
    assert (small_mesh.n_vertices, large_mesh.n_vertices) == (BLOCK_SIZE, 4 * BLOCK_SIZE)
    assert calls(work("TRI_2", large_mesh)) <= 4 * calls(work("TRI_2", small_mesh))


def test_results_come_in_the_order_of_the_blocks():
    for n_threads in (1, 3):
        with Blocks(n_threads, block_size=4) as blocks:
            assert blocks.run(lambda start, stop: (start, stop), 10) == [(0, 4), (4, 8), (8, 10)]
            assert blocks.run(lambda start, stop: (start, stop), 0) == []
            assert blocks.with_block_size(7).run(lambda start, stop: stop - start, 10) == [7, 3]


def test_threads_may_be_entered_again():
    """What was made from them, other block sizes too, works before, in between and after."""
    blocks = Blocks(2, block_size=4)
    other = blocks.with_block_size(7).with_block_size(3)
    for _ in range(2):
        assert other.run(lambda start, stop: stop - start, 10) == [3, 3, 3, 1]
        with blocks:
            assert other.run(lambda start, stop: stop - start, 10) == [3, 3, 3, 1]


def test_an_error_in_a_kernel_comes_out():
    def kernel(start, stop):
        raise ArithmeticError(f"at {start}")

    with Blocks(2, block_size=4) as blocks, pytest.raises(ArithmeticError, match="at 0"):
        blocks.run(kernel, 10)


def test_of_several_errors_that_of_the_lowest_block_comes_out():
    """Whichever thread is first: here block 0 fails long after block 1 has."""
    failed = threading.Event()

    def kernel(start, stop):
        if start == 0:
            assert failed.wait(10)
        failed.set()
        raise ArithmeticError(f"at {start}")

    for _ in range(20):
        failed.clear()
        with Blocks(2, block_size=4) as blocks, pytest.raises(ArithmeticError, match="at 0"):
            blocks.run(kernel, 40)


def test_after_an_error_no_block_is_begun():
    """Those that have begun are waited for, so that no thread writes to arrays any more."""
    begun, ended = [], []
    is_second = threading.Event()

    def kernel(start, stop):
        begun.append(start)
        if start == 0:
            assert is_second.wait(10)
            raise ArithmeticError
        is_second.set()
        for _ in range(1000):
            sum(range(100))
        ended.append(start)

    with Blocks(2, block_size=1) as blocks:
        with pytest.raises(ArithmeticError):
            blocks.run(kernel, 10_000)
        assert sorted(begun) == [0, *sorted(ended)]
        assert len(begun) < 10_000
        assert blocks.run(lambda start, stop: start, 3) == [0, 1, 2]


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_questions_are_asked_once_for_each_block_on_the_calling_thread(threads):
    asked, worked = [], []

    def should_stop():
        asked.append(threading.current_thread())
        return False

    def kernel(start, stop):
        worked.append(start)

    with Blocks(threads, block_size=1).entered(should_stop) as blocks:
        blocks.run(kernel, 50)
        blocks.with_block_size(20).run(kernel, 50)
    assert asked == [threading.current_thread()] * 53
    assert sorted(worked) == sorted([*range(50), 0, 20, 40])


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_all_threads_take_part(threads):
    """Each block waits until as many threads as there are have begun one."""
    barrier = threading.Barrier(threads, timeout=10)
    with Blocks(threads, block_size=1) as blocks:
        names = blocks.run(lambda start, stop: (barrier.wait(), threading.get_ident())[1], 3 * threads)
    assert len(set(names)) == threads
    assert threading.get_ident() in names


@pytest.mark.parametrize("threads", [1, 3])
def test_indices_are_those_of_the_whole_in_order(threads, rng):
    is_wanted = rng.random(1000) < 0.1
    with Blocks(threads, block_size=7) as blocks:
        found = blocks.indices(lambda start, stop: is_wanted[start:stop], 1000)
        none = blocks.indices(lambda start, stop: is_wanted[start:stop], 0)
    assert found.tolist() == np.flatnonzero(is_wanted).tolist()
    assert none.tolist() == [] and none.dtype == np.intp


def test_zero_threads_means_all_cores():
    assert Blocks(0).n_threads == default_threads() >= 1
    assert Blocks(3).n_threads == 3


def test_stencils_do_not_depend_on_blocks(large):
    connectivity = connect(large)
    plain = make_stencil(large, connectivity)
    with Blocks(2, block_size=1000) as blocks:
        blocked = make_stencil(large, connect(large, blocks), blocks=blocks)
    assert np.array_equal(plain.slots, blocked.slots)
    assert np.array_equal(plain.virtual_vertex, blocked.virtual_vertex)


@pytest.mark.parametrize("threads", [1, 2])
def test_tasks_run_together_and_results_keep_their_order(threads):
    with Blocks(threads) as blocks:
        assert blocks.together(lambda: "first", lambda: "second", lambda: "third") == [
            "first",
            "second",
            "third",
        ]


def test_every_block_is_taken_once():
    """By whatever threads, which here are changed as often as Python can."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-7)
    try:
        for _ in range(20):
            taken = []
            with Blocks(8, block_size=1) as blocks:
                blocks.run(lambda start, _, own=taken: own.append(start), 2000)
            assert sorted(taken) == list(range(2000))
    finally:
        sys.setswitchinterval(interval)


def test_no_block_is_taken_after_an_error():
    taken = []

    def kernel(start, _):
        taken.append(start)
        if start == 2:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Blocks(1, block_size=1).run(kernel, 10)
    assert taken == [0, 1, 2]


def test_the_package_says_how_many_processors_there_are():
    """In a process of its own, as other tests change the number."""
    program = f"import runpy; runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r}); "
    program += "from framelet.core.blocks import Blocks; print(Blocks().n_threads)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert int(done.stdout) == available_processors()
