#!/usr/bin/env python3
"""Draws charts of culling from results of proximity_bench:

    build/bench/bin/proximity_bench --benchmark_filter=culling/ --benchmark_out=culling.json --benchmark_out_format=json
    bench/culling_charts.py culling.json -o docs/pictures/culling.svg

The charts show exact tests per primitive and the seconds of each stage, for each scene. They compare culling by the
hierarchy with Voronoi culling for several cell sizes.
"""

import argparse
import json
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "blum"})
import matplotlib.pyplot as plt

TITLES = {"body": "a body with itself", "bodies": "two bodies in each other", "soup": "a soup"}
STAGES = {"objects": "boxes of objects", "diagram": "second-order diagram", "primitives": "hierarchy and exact tests",
          "exact tests": "exact tests"}  # fmt: skip
COLORS = ["#888888", "#4477aa", "#228833", "#ee6677"]


def rows(path):
    """{scene: [(label, cell size or None, counters)]}"""
    out = {}
    for one in json.loads(path.read_text())["benchmarks"]:
        parts = one["name"].split("/")
        if parts[0] != "culling":
            continue
        size = float(parts[2].removeprefix("voronoi-")) if parts[2] != "bvh" else None
        out.setdefault(parts[1], []).append((size, one))
    return out


def draw_tests(axes, scene, cases):
    cells = [(size, one) for size, one in cases if size is not None]
    for name, style, label in (("candidates_per_primitive", "--", "candidates"),
                               ("exact_tests_per_primitive", "-", "exact tests")):  # fmt: skip
        axes.plot([size for size, _ in cells], [one[name] for _, one in cells], style, marker="o", ms=3,
                  color=COLORS[1], label=f"Voronoi: {label}")  # fmt: skip
        for size, one in cases:
            if size is None:
                axes.axhline(one[name], linestyle=style, color=COLORS[3], label=f"hierarchy: {label}")
    axes.set(title=TITLES.get(scene, scene), xscale="log", yscale="log", ylabel="per primitive")
    axes.set_xlabel("side of a cell, mean extents of a primitive")
    sizes = [size for size, _ in cells]
    axes.set_xticks(sizes, [f"{size:g}" for size in sizes])
    axes.set_xticks([], minor=True)
    axes.set_yticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
    axes.set_yticks([], minor=True)
    axes.legend(fontsize=7)


def draw_stages(axes, cases):
    labels = ["hierarchy" if size is None else f"{size:g}" for size, _ in cases]
    bottom = [0.0] * len(cases)
    for color, (stage, label) in zip(COLORS, STAGES.items(), strict=True):
        seconds = [one.get(f"phase {stage}", 0.0) for _, one in cases]
        if any(seconds):
            axes.bar(labels, seconds, bottom=bottom, color=color, label=label)
        bottom = [b + s for b, s in zip(bottom, seconds, strict=True)]
    axes.set(ylabel="seconds, one thread", xlabel="culling: hierarchy, or cells of that size")
    axes.legend(fontsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    given = parser.parse_args()
    scenes = rows(given.results)
    figure, axes = plt.subplots(2, len(scenes), figsize=(4.2 * len(scenes), 6.4), squeeze=False)
    for column, (scene, cases) in enumerate(scenes.items()):
        draw_tests(axes[0][column], scene, cases)
        draw_stages(axes[1][column], cases)
    figure.tight_layout()
    figure.savefig(given.output, metadata={"Date": None})
    return 0


if __name__ == "__main__":
    sys.exit(main())
