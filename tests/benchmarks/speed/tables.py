# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The results as a CSV file and as Markdown tables, and the targets that they are held against."""

import csv

STAGES = ("read", "check", "reorder", "connectivity", "normalize", "stencils", "solve", "report", "write")
COLUMNS = (
    *("what", "order", "asked", "n_vertices", "n_faces", "all", "rerun", "peak", "estimate"),
    *("iteration", "floor", *STAGES),
)
WORDS = ("what", "order")
PAGE_RUNS = (
    "Automatic",
    "Tri-2",
    "Tri-2, one thread",
    "Tri-2, shuffled",
    "Adaptive, 3 levels",
    "Tri-2 in Blender",
    "Tri-2 in plain numpy",
    "MeshLab, Taubin",
    "MeshLab, two-step",
)
"""What the page shows."""


def write_rows(rows, path):
    """Write the rows as a CSV file."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in row.items()})


def read_rows(path):
    """Read the rows of a CSV file."""
    with open(path, newline="", encoding="utf-8") as file:
        return [
            {k: v if k in WORDS or v == "" else float(v) for k, v in r.items()} for r in csv.DictReader(file)
        ]


def markdown(header, lines):
    """Return a Markdown table whose first column is text."""
    rows = [header, ["---"] + ["--:"] * (len(header) - 1), *lines]
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def seconds(value):
    """Return seconds for a table."""
    return "" if value in ("", None) else f"{value:.2f}" if value >= 0.095 else f"{value:.3f}"


def megabytes(value):
    """Return bytes in megabytes for a table."""
    return "" if value in ("", None) else f"{value / 1e6:,.0f}"


def count(value):
    """Return a number of vertices for a table."""
    return f"{int(value):,}"


def full_table(rows):
    """Return all runs with all their stages."""
    header = ["run", "vertices", "faces", "all, s", "again, s", *(f"{stage}, s" for stage in STAGES)]
    header += ["peak, MB", "estimate, MB"]
    lines = []
    for row in rows:
        line = [row["what"], count(row["n_vertices"]), count(row["n_faces"])]
        line += [seconds(row[name]) for name in ("all", "rerun", *STAGES)]
        lines.append([*line, megabytes(row["peak"]), megabytes(row["estimate"])])
    return markdown(header, lines)


def seconds_table(rows, names=()):
    """Return seconds and peak memory by size, a line for each kind of run, or for those that are named."""
    measured = dict.fromkeys(row["what"] for row in rows if row["asked"])
    names = [name for name in names if name in measured] or list(measured)
    sizes = sorted({row["asked"] for row in rows if row["what"] in names and row["asked"]})
    header = ["seconds (peak in MB)", *(f"{int(size):,}" for size in sizes)]
    lines = []
    for name in names:
        cells = []
        for size in sizes:
            row = find(rows, name, size)
            cells.append(f"{seconds(row['all'])} ({megabytes(row['peak'])})" if row else "")
        lines.append([name, *cells])
    return markdown(header, lines)


def find(rows, what, size):
    """Return the run of a name on a mesh of a size; None if there is none."""
    return next((row for row in rows if row["what"] == what and row["asked"] == size), None)


def target_table(rows):
    """Return what was asked of Framelet and what was measured; lines that need missing runs are left out."""
    million, live = 1_000_000, 50_000

    def value(what, size, column):
        row = find(rows, what, size)
        return None if row is None or row[column] == "" else row[column]

    def ratio(first, second):
        a, b = value(*first), value(*second)
        return None if a is None or not b else a / b

    tri, blender = "Tri-2", "Tri-2 in Blender"
    adaptive = "Adaptive, 3 levels"
    candidates = [
        ("Tri-2 in Blender, 1M vertices, s", 5.0, value(blender, million, "all")),
        ("the same, vertices shuffled, s", 5.0, value(f"{blender}, shuffled", million, "all")),
        ("connectivity of it, s", 1.0, value(tri, million, "connectivity")),
        ("stencils of it, s", 1.0, value(tri, million, "stencils")),
        (
            "one iteration over the triad floor",
            4.0,
            ratio((tri, million, "iteration"), (tri, million, "floor")),
        ),
        ("Adaptive with 3 levels, 1M vertices, s", 15.0, value(adaptive, million, "all")),
        ("stencils of it, dilated up to distance 4, s", 10.0, value(adaptive, million, "stencils")),
        ("Automatic, 1M vertices, s", 20.0, value("Automatic", million, "all")),
        ("the same in Blender, s", 20.0, value("Automatic in Blender", million, "all")),
        (
            "a changed value over the first run, 1M",
            0.5,
            ratio((tri, million, "rerun"), (tri, million, "all")),
        ),
        ("the same in Blender", 0.5, ratio((blender, million, "rerun"), (blender, million, "all"))),
        ("value to mesh in Blender, 50,000 vertices, s", 0.1, value(blender, live, "rerun")),
        ("seconds of 4M over 1M", 4.5, ratio((tri, 4 * million, "all"), (tri, million, "all"))),
        ("seconds of 1M over 100,000", 11.0, ratio((tri, million, "all"), (tri, 100_000, "all"))),
        ("all threads over one", 0.6, ratio((tri, million, "all"), (f"{tri}, one thread", million, "all"))),
        (
            "shuffled over natural order",
            1.6,
            ratio((f"{tri}, shuffled", million, "all"), (tri, million, "all")),
        ),
        ("peak of Tri-2 in Blender, 1M, MB", 700.0, scaled(value(blender, million, "peak"))),
        ("peak of Adaptive with 3 levels, 1M, MB", 700.0, scaled(value(adaptive, million, "peak"))),
        ("peak of Automatic, 1M, MB", 1200.0, scaled(value("Automatic", million, "peak"))),
        ("the same in Blender, MB", 1200.0, scaled(value("Automatic in Blender", million, "peak"))),
        *(
            (
                f"Automatic over {other}, 1M",
                1.0,
                ratio(("Automatic", million, "all"), (other, million, "all")),
            )
            for other in ("MeshLab, two-step", "MeshLib, via normals")
        ),
        ("Tri-2 over plain numpy, the solver alone", 1.0, plain_ratio(value, million)),
    ]
    lines = [
        [name, f"{limit:g}", f"{found:.3g}", "yes" if found <= limit else "no"]
        for name, limit, found in candidates
        if found is not None
    ]
    return markdown(["what", "at most", "measured", "met"], lines)


def scaled(n_bytes):
    """Return bytes in megabytes; None stays."""
    return None if n_bytes is None else n_bytes / 1e6


def plain_ratio(value, size):
    """Return the solver's seconds over those of plain numpy."""
    plain, ours = value("Tri-2 in plain numpy", size, "solve"), value("Tri-2", size, "solve")
    return None if plain is None or ours is None else ours / plain
