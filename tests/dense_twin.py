# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Slow twin of the multi-level solver: W and its inverse as matrices, (4.10) line by line."""

import numpy as np


class DenseFrame:
    """A transform written out as matrices, column by column.

    The coefficients of one coordinate are one long vector: the low-pass, then the bands of each level, finest
    first, each as (H, n_sites).
    """

    def __init__(self, transform, n):
        shapes = [
            found.shape[:2]
            for found in map(transform.analyze(np.zeros((n, 3))).details, range(len(transform.levels)))
        ]
        self.shapes = [(1, n), *shapes]
        self.ends = np.cumsum([h * s for h, s in self.shapes])
        self.analysis = np.concatenate([self.flat(transform.analyze(unit)) for unit in units(n)], axis=1)[
            :, :n
        ]
        empty = transform.analyze(np.zeros((n, 3)))
        columns = []
        for unit in units(self.ends[-1]):
            low, *details = self.parts(unit)
            columns.append(transform.synthesize(empty.with_details(details, low[0])))
        self.synthesis = np.concatenate(columns, axis=1)[:, : self.ends[-1]]

    def flat(self, coefficients):
        """Return coefficients as rows of numbers, shape (sum of all bands, 3)."""
        details = [coefficients.details(level) for level in range(len(self.shapes) - 1)]
        return np.concatenate([coefficients.low, *(bands.reshape(-1, 3) for bands in details)])

    def parts(self, rows):
        """Return low-pass and details as (H, n_sites, 3) each."""
        cut = np.split(rows, self.ends[:-1])
        return [part.reshape(*shape, 3) for part, shape in zip(cut, self.shapes, strict=True)]


def units(n):
    """Return the unit vectors of R^n, three at a time, as (n, 3); the last ones may be zero."""
    columns = np.eye(n, n + (-n) % 3)
    return [columns[:, k : k + 3] for k in range(0, n, 3)]


def shrunk(bands, nu, kind, groups):
    """Return T_nu of one level, (H, n_sites, 3), by loops.

    `groups` gives for each site the lists of bands that VECTOR shrinks as one; bands in none stay.
    """
    result = bands.copy()
    for site in range(bands.shape[1]):
        for group in groups(site):
            blocks = {
                "VECTOR": [(group, site)],
                "SCALAR": [([band], site, [axis]) for band in group for axis in range(3)],
                "BANDS": [(group, site, [axis] * len(group)) for axis in range(3)],
            }[kind]
            for block in blocks:
                norm = np.linalg.norm(bands[block])
                result[block] *= max(norm - nu, 0.0) / norm if norm > 0 else 0.0
    return result


def split_bregman(noisy, frame, settings, groups, hold=()):
    """Return S after the iteration of (4.10) with matrices; `groups` has one function for each level."""
    s, w, v = noisy.copy(), frame.analysis, frame.synthesis
    d = w @ noisy
    b, c = np.zeros_like(d), np.zeros_like(noisy)
    nu = settings.lambda_ / settings.mu
    for _ in range(settings.iterations):
        s = (noisy - c + settings.mu * v @ (d - b)) / (1.0 + settings.mu)
        s[list(hold)] = noisy[list(hold)]
        low, *details = frame.parts(w @ s + b)
        kept = [
            shrunk(bands, nu, settings.shrinkage, own) for bands, own in zip(details, groups, strict=True)
        ]
        d = np.concatenate([part.reshape(-1, 3) for part in (low, *kept)])
        b = b + w @ s - d
        c = c + settings.delta * (s - noisy)
    return s
