# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Of many requests the latest is answered: no pile-up, and nothing outdated after it."""

import threading

import pytest
from framelet.operators.preview import latest
from framelet.operators.preview.latest import Latest

SECONDS = 30


class Gated:
    """A computation that waits until it is let go or told to stop, and notes what it did."""

    def __init__(self):
        self.began, self.go = threading.Event(), threading.Event()
        self.done, self.stopped = [], []

    def __call__(self, request, should_stop, _show):
        self.began.set()
        while not self.go.wait(0.001):
            if should_stop():
                self.stopped.append(request)
                return "useless"
        self.done.append(request)
        return request * 10


@pytest.fixture
def gated():
    return Gated()


@pytest.fixture
def server(gated):
    made = Latest(gated)
    yield made
    made.close()
    made.join()


def test_requests_that_come_meanwhile_are_skipped_but_for_the_last(server, gated, monkeypatch):
    monkeypatch.setattr(latest, "PATIENCE", 1000.0)
    server.request(1)
    assert gated.began.wait(SECONDS)
    for number in range(2, 100):
        server.request(number)
    assert server.is_busy and server.take() is None
    gated.go.set()
    assert server.wait(SECONDS)
    assert gated.done == [1, 99]
    assert server.take() == (99, 990, None)
    assert server.take() is None and not server.is_busy


def test_a_slow_one_is_stopped_for_a_newer_one(server, gated, monkeypatch):
    monkeypatch.setattr(latest, "PATIENCE", 0.0)
    server.request(1)
    assert gated.began.wait(SECONDS)
    gated.began.clear()
    server.request(2)
    assert gated.began.wait(SECONDS)
    assert gated.stopped == [1] and server.take() is None
    gated.go.set()
    assert server.wait(SECONDS)
    assert server.take().result == 20


def test_a_slow_one_is_left_alone_if_nothing_newer_waits(server, gated, monkeypatch):
    monkeypatch.setattr(latest, "PATIENCE", 0.0)
    server.request(1)
    assert not server.wait(0.1)
    gated.go.set()
    assert server.wait(SECONDS)
    assert gated.stopped == [] and server.take().result == 10


def test_errors_are_answers():
    def fail(request, *_):
        raise ValueError(f"no {request}")

    server = Latest(fail)
    server.request(4)
    assert server.wait(SECONDS)
    answer = server.take()
    assert answer.request == 4 and answer.result is None and str(answer.error) == "no 4"
    server.close()
    server.join()


def test_closing_stops_and_answers_nothing(gated):
    server = Latest(gated)
    server.request(1)
    assert gated.began.wait(SECONDS)
    server.request(2)
    server.close()
    server.join()
    assert gated.stopped == [1] and gated.done == [] and server.take() is None


def test_what_is_shown_before_the_answer_is_taken_once(monkeypatch):
    shown, go = threading.Event(), threading.Event()

    def compute(request, _should_stop, show):
        show(request * 2)
        shown.set()
        assert go.wait(SECONDS)
        return request * 10

    server = Latest(compute)
    try:
        server.request(3)
        assert shown.wait(SECONDS)
        assert server.take() == (3, 6, None) and server.take() is None and server.is_busy
        go.set()
        assert server.wait(SECONDS)
        assert server.take() == (3, 30, None)
    finally:
        server.close()
        server.join()
