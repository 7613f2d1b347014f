"""Certifies axes of made solids: python -m made.certify SOLIDS OUT.jsonl [-- OPTIONS of blum medial]

SOLIDS is a folder that `python -m made` wrote. Adds a line of JSON for each solid to OUT.jsonl. Skips solids that
OUT.jsonl contains, so that an interrupted run can continue. Prints the number of certified axes, the warnings and
errors of the others, and the slowest solids."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

BLUM = os.environ.get("BLUM_CLI", "blum")


def run(file: Path, options: list[str], limit: float) -> dict[str, object]:
    """Runs `blum medial` on a solid; returns its status (-1: over the limit), seconds, warnings and last error."""
    with tempfile.TemporaryDirectory() as folder:
        command = [BLUM, "medial", str(file), "-o", f"{folder}/axis.npz", *options]
        before, start = os.times(), time.monotonic()
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=False)
            status, said = done.returncode, done.stderr
        except subprocess.TimeoutExpired:
            status, said = -1, f"error: not done in {limit:g} s"
        seconds, after = time.monotonic() - start, os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    lines = said.splitlines()
    return {
        "status": status,
        "seconds": round(seconds, 2),
        "cpu_seconds": round(cpu, 2),
        "warnings": [line for line in lines if "warning" in line],
        "error": "" if status == 0 else "\n".join(line for line in lines if "warning" not in line)[-600:],
    }


def report(results: list[dict[str, object]]) -> None:
    certified = [result for result in results if result["status"] == 0]
    warned = sum(bool(result["warnings"]) for result in certified)
    print(f"{len(certified)} of {len(results)} certified, {warned} of them with a warning")
    for result in results:
        for line in [*result["warnings"], *str(result["error"]).splitlines()[-1:]]:
            print(f"  {result['name']}: {line}")
    slowest = sorted(results, key=lambda result: -float(str(result["seconds"])))[:10]
    print("slowest: " + ", ".join(f"{r['name']} {r['seconds']:.1f} s" for r in slowest))


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m made.certify", description=__doc__.split("\n")[0])
    parser.add_argument("solids", type=Path, metavar="SOLIDS")
    parser.add_argument("out", type=Path, metavar="OUT.jsonl")
    parser.add_argument("--limit", type=float, default=300, help="seconds for one solid; default: %(default)g")
    parser.add_argument("--names", nargs="+", metavar="NAME", help="only these")
    arguments = sys.argv[1:]
    split = arguments.index("--") if "--" in arguments else len(arguments)
    chosen = parser.parse_args(arguments[:split])
    options = arguments[split + 1 :]
    entries = json.loads((chosen.solids / "manifest.json").read_text(encoding="utf-8"))
    names = [entry["name"] for entry in entries if not chosen.names or entry["name"] in chosen.names]
    lines = chosen.out.read_text(encoding="utf-8").splitlines() if chosen.out.exists() else []
    results = {result["name"]: result for result in map(json.loads, lines)}
    with chosen.out.open("a", encoding="utf-8") as out:
        for name in names:
            if name not in results:
                found = run(chosen.solids / f"{name}.ply", options, chosen.limit)
                results[name] = {"name": name, **found}
                out.write(json.dumps(results[name]) + "\n")
                out.flush()
    report([results[name] for name in names])


if __name__ == "__main__":
    main()
