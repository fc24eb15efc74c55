# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a worker does in tests in place of denoising: some jobs end its process, one of them once only."""

import os
import time
from pathlib import Path


def carry_out(job):
    """Write down that the job was begun, and end the process if its name says so."""
    log = Path(job["log"])
    with log.open("a") as file:
        file.write(job["source"] + "\n")
    begun = log.read_text().split().count(job["source"])
    if job["source"] == "killer" or (job["source"] == "once" and begun == 1):
        time.sleep(0.3)  # so that others wait behind it, if any do
        os._exit(9)
    if job["source"] == "broken":
        raise RuntimeError("no such thing")
    return {"did": job["source"], "pid": os.getpid()}
