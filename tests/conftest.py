# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Make the repository root importable as `framelet`, and give fixtures to all tests."""

import importlib.util
import os
import signal
import sys
import zlib
from pathlib import Path

# Before NumPy is loaded: test processes share the cores, and threads of its matrix library that wait for one
# another keep them busy. Framelet's own threads are as ever.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent


def load_package() -> None:
    """Load the root as the package `framelet`, whatever the name of the checkout folder."""
    spec = importlib.util.spec_from_file_location(
        "framelet", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["framelet"] = package
    spec.loader.exec_module(package)


# A shell starts what runs in its background deaf to Ctrl-C, and processes that tests start would inherit it.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Before the test modules are imported, since they import from `framelet`.
load_package()


def pytest_collection_modifyitems(items):
    """Mark the tests that use the development meshes, so `-m "not shared"` leaves them out."""
    for item in items:
        if "shared_meshes" in getattr(item, "fixturenames", ()):
            item.add_marker("shared")


@pytest.fixture
def rng(request):
    """Random numbers that are the same in every run of a test, and different between tests."""
    return np.random.default_rng(zlib.crc32(request.node.name.encode()))


@pytest.fixture
def one_thread():
    """One thread unless told: more only cost time on meshes as small as those of tests."""
    from framelet.core.processors import default_threads, set_default_threads

    before = default_threads()
    set_default_threads(1)
    yield
    set_default_threads(before)


@pytest.fixture
def exact(monkeypatch):
    """Whole series of means over rings, and none that were cut off before or after."""
    from framelet.core.averages import ring_means

    series = (ring_means._low_pass_series, ring_means._power_series)
    for each in series:
        each.cache_clear()
    monkeypatch.setattr(ring_means, "LEFT_OUT", 1e-14)
    yield
    for each in series:
        each.cache_clear()


@pytest.fixture(scope="session")
def shared_meshes():
    """Folder of the development meshes, which are too large for the repository."""
    folder = Path(os.environ.get("FRAMELET_MESHES") or ROOT.parent / "shared" / "meshes")
    if not folder.is_dir():
        pytest.skip(f"development meshes not found at {folder}")
    return folder
