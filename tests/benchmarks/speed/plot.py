# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The plot of seconds and peak memory over the number of vertices."""

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt

OTHERS = ("numpy", "Mesh")


def draw(rows, path):
    """Draw the results into a PNG file: Framelet in solid lines, others in broken ones."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), constrained_layout=True)
    names = list(dict.fromkeys(row["what"] for row in rows if row["asked"]))
    names = [name for name in names if "Blender" not in name and "thread" not in name]
    for number, name in enumerate(names):
        points = sorted((row for row in rows if row["what"] == name), key=lambda row: row["n_vertices"])
        style = "--" if any(word in name for word in OTHERS) else "-"
        look = {
            "marker": "o",
            "markersize": 3.5,
            "linestyle": style,
            "color": f"C{number % 10}",
            "label": name,
        }
        n_vertices = [row["n_vertices"] for row in points]
        axes[0].loglog(n_vertices, [row["all"] for row in points], **look)
        axes[1].loglog(n_vertices, [max(row["peak"], 1e6) / 1e6 for row in points], **look)
    for axis, title in zip(axes, ("Seconds", "Peak memory above the mesh, MB"), strict=True):
        axis.set_title(title)
        axis.set_xlabel("Vertices")
        axis.grid(visible=True, which="major", alpha=0.4)
    axes[1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)
