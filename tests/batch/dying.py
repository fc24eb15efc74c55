# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a worker does in tests in place of denoising: some jobs end its process, some of them once only."""

import os
import time
from pathlib import Path


def carry_out(job):
    """Write down that the job was begun, and end the process if its name says so."""
    log = Path(job["log"])
    with log.open("a") as file:
        file.write(job["source"] + "\n")
    kind = job["source"].partition("-")[0]
    begun = log.read_text().split().count(job["source"])
    if kind == "killer" or (kind == "once" and begun == 1):
        time.sleep(job.get("seconds", 0.3))  # so that others wait behind it, if any do
        os._exit(9)
    if kind == "broken":
        raise RuntimeError("no such thing")
    return {"did": job["source"], "pid": os.getpid()}
