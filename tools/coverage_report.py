#!/usr/bin/env python3
"""Counts, for each layer, the lines that ran in a build with --coverage.

  tools/coverage_report.py BUILD_FOLDER [LAYER ...]

Counts the lines of src and include that gcov reports. A line ran if it ran in any program. Prints a table, and writes
the lines that did not run to BUILD_FOLDER/missed.txt, as ranges for each file.
"""

import collections
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

import check_includes

PROJECT = check_includes.PROJECT


def lines_of(notes: pathlib.Path) -> dict[str, dict[int, bool]]:
    """The lines of the project's files in an object; a value is True if the line ran."""
    command = ["gcov", "--json-format", "--stdout", notes.name]
    done = subprocess.run(command, cwd=notes.parent, check=True, capture_output=True, text=True)
    found: dict[str, dict[int, bool]] = {}
    for text in filter(None, done.stdout.splitlines()):
        report = json.loads(text)
        for file in report["files"]:
            path = pathlib.Path(os.path.normpath(pathlib.Path(report["current_working_directory"], file["file"])))
            if not path.is_relative_to(PROJECT) or path.relative_to(PROJECT).parts[0] not in ("src", "include"):
                continue
            lines = found.setdefault(path.relative_to(PROJECT).as_posix(), {})
            for line in file["lines"]:
                number = line["line_number"]
                lines[number] = lines.get(number, False) or line["count"] > 0
    return found


def ranges(numbers: list[int]) -> str:
    parts: list[list[int]] = []
    for number in numbers:
        if parts and number == parts[-1][1] + 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ", ".join(f"{first}" if first == last else f"{first}-{last}" for first, last in parts)


def main() -> int:
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder, wanted = pathlib.Path(sys.argv[1]), set(sys.argv[2:])
    notes = sorted(folder.rglob("*.gcno"))
    every: dict[str, dict[int, bool]] = {}
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS") or os.cpu_count() or 1)) as pool:
        for found in pool.map(lines_of, notes):
            for file, lines in found.items():
                merged = every.setdefault(file, {})
                for number, ran in lines.items():
                    merged[number] = merged.get(number, False) or ran
    layers: dict[str, collections.Counter] = {}
    missed = []
    for file, lines in sorted(every.items()):
        layer = check_includes.layer_of(pathlib.PurePosixPath(file))
        if wanted and layer not in wanted:
            continue
        layers.setdefault(layer, collections.Counter()).update(lines=len(lines), ran=sum(lines.values()))
        left = sorted(number for number, ran in lines.items() if not ran)
        if left:
            missed.append(f"{file}: {ranges(left)}\n")
    if not layers:
        print(f"coverage: nothing was compiled in {folder}", file=sys.stderr)
        return 1
    (folder / "missed.txt").write_text("".join(missed), encoding="utf-8")
    total = sum(layers.values(), collections.Counter())
    print(f"{'layer':14}{'lines':>8}{'ran':>8}{'':>9}")
    for name, row in [*sorted(layers.items()), ("total", total)]:
        print(f"{name:14}{row['lines']:>8}{row['ran']:>8}{100 * row['ran'] / row['lines']:>7.1f} %")
    print(f"what did not run: {folder / 'missed.txt'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
