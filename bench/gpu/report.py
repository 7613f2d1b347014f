#!/usr/bin/env python3
"""Writes docs/generated/gpu.md and plots in docs/pictures from the figures of bench/gpu.sh.

    bench/gpu/report.py [TIMES.json]      default: out/gpu/times.json

The floor is the time to write a field, 8 bytes per node, at the device's memory bandwidth.
"""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPS = ("upload", "trees", "tiles")


def floor_ms(case, bandwidth):
    return case["resolution"] ** 3 * 8 / (bandwidth * 1e6)


def row(case, bandwidth):
    shares = [f"{100 * case[f'{step}_ms'] / case['ms']:.0f} %" for step in STEPS]
    goal = [f"{case[name]:g}" if case[name] else "" for name in ("must_ms", "aim_ms")]
    query = case["query_per_node_ms"]
    return [case["name"], f"{case['ms']:.3g}", *goal, *shares, f"{case['signs_ms']:.3g}",
            f"{case['ms'] / floor_ms(case, bandwidth):.3g}x", f"{query / case['ms']:.3g}x" if query else ""]


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows]) + "\n"


def plot(path, title, label, points, floors):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), dpi=120)
    axes.loglog([x for x, _ in points], [case["ms"] for _, case in points], "o-", label="whole field")
    for step in STEPS:
        axes.loglog([x for x, _ in points], [case[f"{step}_ms"] for _, case in points], ".--", label=step, alpha=0.7)
    axes.loglog([x for x, _ in points], floors, ":", color="black", label="floor: write 8 bytes a node")
    axes.set(title=title, xlabel=label, ylabel="milliseconds")
    axes.grid(True, which="both", alpha=0.2)
    axes.legend(fontsize=7)
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    pyplot.close(figure)


def main(source, root=ROOT):
    content = json.loads(pathlib.Path(source).read_text())
    bandwidth = content["bandwidth_gb_per_s"]
    images = [case for case in content["cases"] if case["name"].startswith("image")]
    cases = [case for case in content["cases"] if case not in images]
    for name, key, keep in (
        ("nodes", lambda case: case["resolution"] ** 3, lambda case: case["name"].startswith("69 k")),
        ("triangles", lambda case: case["triangles"], lambda case: case["name"].endswith(" triangles, 256^3")),
    ):
        points = sorted(((key(case), case) for case in cases if keep(case)), key=lambda point: point[0])
        plot(root / f"docs/pictures/gpu-{name}.png", f"Distance and closest site: time against {name}", name, points,
             [floor_ms(case, bandwidth) for _, case in points])
    header = ["case", "ms", "must", "aim", *STEPS, "signs, ms", "over the floor", "query per node"]
    parts = [
        "# Measured figures: CUDA\n\nWritten by bench/gpu/report.py; do not edit. `bench/gpu.sh` measures anew.\n",
        f"{content['device']}, {bandwidth:.0f} GB/s. Medians of warm runs, results left on the device.\n",
        table(header, [row(case, bandwidth) for case in cases]),
        table(["image", "ms", "must", "aim"],
              [[case["name"], f"{case['ms']:.3g}", f"{case['must_ms']:g}", f"{case['aim_ms']:g}"] for case in images]),
        "![Time against nodes](../pictures/gpu-nodes.png)\n",
        "![Time against triangles](../pictures/gpu-triangles.png)\n",
    ]
    target = root / "docs/generated/gpu.md"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("\n".join(parts))
    print(f"report: wrote {target}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else ROOT / "out/gpu/times.json")
