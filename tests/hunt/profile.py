# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many examples a property is tried on.

In `make test` there are 100, always the same. `FRAMELET_HUNT=2000` tries so many new ones; `make hunt` does
so. A failure prints a line `@reproduce_failure(...)`, to be put above the test.
"""

import os

from hypothesis import HealthCheck, Phase, settings

HUNT = int(os.environ.get("FRAMELET_HUNT", "0"))
USUAL = 100


def examples(share=1.0):
    """Return a decorator: so many examples, or a share of them where each one takes long."""
    return settings(
        max_examples=max(int((HUNT or USUAL) * share), 1),
        derandomize=not HUNT,
        database=None,
        deadline=None,
        print_blob=True,
        phases=[Phase.explicit, Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )
