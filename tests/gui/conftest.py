# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Starts one Blender for each scale, and gives every test a fresh scene in it."""

import os
from pathlib import Path

import pytest
from blender_window.pixels import write_png
from blender_window.programs import ROOT, NoWindow, find_programs
from blender_window.session import Session
from blender_window.sidebar import add_ball, start_fresh

SIZES = {1: (1280, 800), 2: (1920, 1440)}
IS_REQUIRED = os.environ.get("FRAMELET_REQUIRE_GUI") == "1"
PICTURES = os.environ.get("FRAMELET_PICTURES")


def pytest_itemcollected(item):
    """Mark every test below this folder."""
    item.add_marker("gui")


def give_up(reason):
    """Skip, or fail where a window is required."""
    if IS_REQUIRED:
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.fixture(scope="session", params=[1, 2], ids=["scale1", "scale2"])
def session(request):
    """A Blender with a window and the extension, at one scale."""
    try:
        programs = find_programs()
    except NoWindow as reason:
        give_up(str(reason))
    given = os.environ.get("FRAMELET_ZIP")
    built = [Path(given)] if given else sorted((ROOT / "build").glob("framelet-*.zip"))
    if not built or not built[0].is_file():
        give_up("needs the extension's zip: run `make extension`, or `make gui`, which does it")
    session = Session(programs, built[0].resolve(), SIZES[request.param], request.param)
    yield session
    session.close()


@pytest.fixture
def desk(session, request):
    """The session with an empty scene and the sidebar open at our tab.

    A test leaves a picture in the folder that the variable FRAMELET_PICTURES names.
    """
    start_fresh(session)
    yield session
    if PICTURES:
        Path(PICTURES).mkdir(parents=True, exist_ok=True)
        write_png(Path(PICTURES) / f"{request.node.name}.png", session.picture())


@pytest.fixture
def ball(desk):
    """The session with a noisy ball of 2,562 vertices, named Ball, in the middle of the viewport."""
    add_ball(desk)
    return desk
