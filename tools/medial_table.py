#!/usr/bin/env python3
"""Computes the medial axes of all shapes of `blum make`, and writes their certificates as a table.

    tools/medial_table.py BLUM_PROGRAM [-o OUT.md] [--data FOLDER] [--resolution N] [--only SHAPE ...]

OUT.md is docs/generated/medial-axes.md by default. With --data, the meshes below a folder follow the catalogue's
shapes. Takes about twenty minutes on two cores, and prints a line on standard error for each shape.
"""

import argparse
import datetime
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
THETAS = [0, 20, 60, 90, 120, 170]
SIZES_AT = 60  # degrees, theta for the numbers of vertices, triangles and sheets
COVER_AT = 20  # degrees, theta for solid_to_balls
CERTIFIED, FAILED, UNCERTIFIED = 0, 1, 3  # exit statuses of `blum medial`
HEADER = ["shape", "solid", "axis", "certified", "vertices", "triangles", "sheets", "seconds", "radius error",
          "uncovered"]


def catalogue(blum):
    """Names and kinds (mesh, image) of all shapes."""
    listed = subprocess.run([blum, "make", "--list"], check=True, capture_output=True, text=True).stdout
    return re.findall(r"^(\w+) \((mesh|image)\)", listed, re.MULTILINE)


def made(blum, name, kind, folder):
    path = folder / f"{name}.{'ply' if kind == 'mesh' else 'nrrd'}"
    subprocess.run([blum, "make", name, "-o", path, "--quiet"], check=True)
    return path


def meshes_below(folder):
    found = [path for path in sorted(folder.rglob("*")) if path.suffix.lower() in {".obj", ".off", ".stl", ".ply"}]
    if not found:
        sys.exit(f"{folder}: no mesh below it")
    return found


def measure(blum, path, resolution, folder):
    """The summary of `blum medial`, or one sentence with the reason for its absence."""
    summary = folder / "summary.json"
    summary.unlink(missing_ok=True)
    command = [blum, "medial", path, "-o", folder / "axis.npz", "--theta", ",".join(map(str, THETAS)),
               "--json", summary, "--quiet", "--allow-uncertified"]
    if path.suffix.lower() in {".obj", ".off", ".stl", ".ply"}:
        command += ["--resolution", str(resolution)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in {CERTIFIED, UNCERTIFIED}:
        text = done.stderr.strip().splitlines()[-1:] or [f"exit status {done.returncode}"]
        return text[0].removeprefix("blum: error: ").replace(f"'{path}': ", "")
    return json.loads(summary.read_text())


def betti(numbers):
    return ", ".join(map(str, numbers))


def rule_of(certificate):
    return "" if certificate["against"] == "polyhedron" else " (voxels)"


def axis_text(solid):
    """The Betti numbers of the axis; once if they are the same at all angles."""
    told = {axis["theta"]: betti(axis["certificate"]["axis_betti"]) for axis in solid["axes"]}
    if len(set(told.values())) == 1:
        return next(iter(told.values()))
    return "; ".join(f"{text} at {theta:g}" for theta, text in told.items())


def seconds(value):
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}"


def diagonal_of(solid):
    """The diagonal of the smallest voxel."""
    body = min(solid["bodies"], key=lambda body: body["spacing"])
    spacing = solid["grid"]["spacing"]
    scale = body["spacing"] / min(spacing)
    return scale * sum(side * side for side in spacing) ** 0.5


def row(name, summary):
    if isinstance(summary, str):
        return [name, "-", "-", "refused: " + summary] + ["-"] * (len(HEADER) - 4)
    solid = summary["solids"][0]
    at = {axis["theta"]: axis for axis in solid["axes"]}
    certificate = at[SIZES_AT]["certificate"]
    counts = at[SIZES_AT]["counts"]
    error = max(axis["certificate"]["geometry"]["radius_error"] for axis in solid["axes"])
    diagonal = 1e6 * certificate["geometry"]["tolerance"]
    uncovered = at[COVER_AT]["certificate"]["balls"]["solid_to_balls"] / diagonal_of(solid)
    verdict = "yes" + rule_of(certificate) if summary["certified"] else "NO: " + "; ".join(summary["mismatches"])
    making = sum(time for phase, time in summary["seconds"].items() if phase != "certificate")
    return [name, betti(certificate["solid_betti"]), axis_text(solid), verdict, f"{counts['vertices']:,}",
            f"{counts['triangles']:,}", f"{counts['sheets']:,}",
            f"{seconds(making)} + {seconds(summary['seconds']['certificate'])}", f"{error / diagonal:.0e}", f"{uncovered:.2f}"]


def commit_now():
    done = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def machine(loads, commit):
    model = next((line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), "unknown processor")
    now = datetime.datetime.now().isoformat(timespec="minutes")
    return (f"{now}, {model}, {os.cpu_count()} cores, load average {min(loads):.1f} to {max(loads):.1f} before the "
            f"shapes, commit {commit}.")


def page(rows, loads, resolution, commit):
    lines = ["# Certificates of medial axes", "",
             "Written by tools/medial_table.py; do not edit.", "", machine(loads, commit), "",
             f"Every shape of `blum make --list` with its defaults, `blum medial --resolution {resolution} --theta "
             f"{','.join(map(str, THETAS))}`; images at their own resolution. One certificate for each theta.", "",
             "- *solid*, *axis*: Betti numbers (components, tunnels, voids); of the axis as the files hold it, one "
             "triple where it is the same at all angles.",
             "- *certified*: at all angles. *voxels*: the mesh bounds no polyhedron, or is an image, so that the "
             "solid is known as voxels.",
             f"- *vertices*, *triangles*, *sheets*: at theta {SIZES_AT}.",
             f"- *seconds*: making and writing all {len(THETAS)} axes, and all their certificates. Where other work "
             "shares the machine, they are inflated.",
             "- *radius error*: the largest |radius - exact distance| of all vertices at all angles, in diagonals of "
             "the solid's box. The tolerance is 1e-06.",
             f"- *uncovered*: how far the solid's surface is at most from the union of the balls at theta {COVER_AT}, "
             "in diagonals of a voxel.", ""]
    lines.append("| " + " | ".join(HEADER) + " |")
    lines.append("|" + "---|" * len(HEADER))
    lines += ["| " + " | ".join(cells) + " |" for cells in rows]
    certified = sum(cells[3].startswith("yes") for cells in rows)
    refused = sum(cells[3].startswith("refused") for cells in rows)
    lines += ["", f"{certified} of {len(rows)} certified, {refused} refused: what has no triangles, or no inside, has "
              "no axis.", ""]
    return "\n".join(lines)


def parse():
    parser = argparse.ArgumentParser(description="Writes the certificates of many medial axes as a table.")
    parser.add_argument("blum", type=pathlib.Path, help="the program")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "docs/generated/medial-axes.md")
    parser.add_argument("--data", type=pathlib.Path, help="a folder with meshes")
    parser.add_argument("--resolution", type=int, default=256, help="of meshes")
    parser.add_argument("--only", nargs="+", help="names of shapes")
    return parser.parse_args()


def main():
    options = parse()
    blum = options.blum.resolve()
    rows, loads, commit = [], [], commit_now()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        inputs = [(name, lambda name=name, kind=kind: made(blum, name, kind, folder))
                  for name, kind in catalogue(blum) if not options.only or name in options.only]
        if options.data:
            inputs += [(path.name, lambda path=path: path) for path in meshes_below(options.data)]
        for name, path in inputs:
            loads.append(os.getloadavg()[0])
            rows.append(row(name, measure(blum, path(), options.resolution, folder)))
            print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    options.output.write_text(page(rows, loads, options.resolution, commit))
    return 0 if all(not cells[3].startswith("NO") for cells in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
