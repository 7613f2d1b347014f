"""Writes made solids for the command-line tool: python -m made OUT_DIR [--count N] [--family NAME]

Writes one PLY with doubles for each solid, and manifest.json with name, file, family, triangles and Betti numbers.
The manifest also lists the requested thinnest feature, in units and in voxels of a grid of 64 along the longest side.
It is 0 if the solid tapers to a point or edge."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import blum

from . import MadeSolid, made_solids
from .shapes import FAMILIES


def entry_of(solid: MadeSolid, file: Path) -> dict[str, object]:
    voxel = float((solid.vertices.max(axis=0) - solid.vertices.min(axis=0)).max()) / 64
    return {
        "name": solid.name,
        "file": file.name,
        "family": solid.family,
        "triangles": len(solid.triangles),
        "betti": list(solid.betti),
        "thinnest": solid.thinnest,
        "thinnest_voxels": solid.thinnest / voxel,
    }


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m made", description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path, metavar="OUT_DIR")
    parser.add_argument("--count", type=int, metavar="N", help="the first N; default: all 300")
    parser.add_argument("--family", choices=sorted(FAMILIES), help="only this one, of those")
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    entries = []
    for solid in made_solids(chosen.count):
        if chosen.family in (None, solid.family):
            file = chosen.out / f"{solid.name}.ply"
            blum.Mesh(solid.vertices, solid.triangles).write(file)
            entries.append(entry_of(solid, file))
    (chosen.out / "manifest.json").write_text(json.dumps(entries, indent=1) + "\n", encoding="utf-8")
    print(f"{len(entries)} solids, {sum(int(str(entry['triangles'])) for entry in entries)} triangles in {chosen.out}")


if __name__ == "__main__":
    main()
