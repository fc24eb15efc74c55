# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""λ, μ and the number of iterations of the position engine, from the noise of the mesh."""

from __future__ import annotations

from ..noise import NoiseEstimate
from ..settings import DenoiseSettings

FACTORS = {
    ("BANDS", "TRIANGLES"): 4.0,
    ("VECTOR", "TRIANGLES"): 1.75,
    ("SCALAR", "QUADS"): 0.65,
    ("VECTOR", "QUADS"): 0.85,
    ("VECTOR", "ADAPTIVE"): 3.0,
}
"""λ in units of the noise, by shrinkage and kind of frame: where the geometric mean of the angle errors of
development models with noise of 0.1, 0.2 and 0.5 edge lengths was lowest or no longer fell much, with the
preset of that shrinkage: on four models of triangles and two of quads. The last one was not fitted so: its
best λ was seen between 0.5 and 1 at noise of 0.2 edge lengths."""

OTHER_FACTOR = 1.0
MU = 1.0
ITERATIONS = 10


def tuned(settings: DenoiseSettings, frame: str, noise: NoiseEstimate) -> DenoiseSettings:
    """Return settings with λ, μ and the number of iterations for a noise.

    Parameters
    ----------
    settings : DenoiseSettings
        Shrinkage and stencil count.
    frame : str
        The frame that is used, not AUTO.
    noise : NoiseEstimate
        Of the mesh; of impulsive noise the root mean square counts.

    Returns
    -------
    DenoiseSettings
        A mesh without noise gets λ = 0, so that nothing moves.
    """
    frame = getattr(frame, "name", frame)  # of a bank of one's own
    sigma = noise.sigma_edges
    if noise.is_impulsive and noise.sigma > 0:
        sigma *= noise.rms / noise.sigma
    if settings.stencil == "ADAPTIVE" or frame in ("ADAPTIVE", "PAIRWISE"):
        kind = "ADAPTIVE"
    else:
        kind = "TRIANGLES" if frame.startswith("BOX_SPLINE_111") else "QUADS"
    factor = FACTORS.get((settings.shrinkage, kind), OTHER_FACTOR)
    return settings.with_changes(lambda_=min(factor * sigma, 100.0), mu=MU, iterations=ITERATIONS)
