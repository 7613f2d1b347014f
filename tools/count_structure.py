#!/usr/bin/env python3
"""Counts files and lines of each layer, small files, and internal headers with a single user.

  tools/count_structure.py [REVISION | FROM..TO] [--json]

- Files and lines are those of C++ and CUDA files in src/LAYER and include/blum/LAYER. Small files have fewer than 60
  lines.
- An internal header is a .hpp of src. Its users are the files of src and include that include it, except the source of
  the same name. A header with a single user could be part of this user.
- With a revision or range of Git: the number and places of touched files, and the median number per commit.

The same files always give the same text. --json prints the figures and the names of headers and files as one object.
"""

import argparse
import collections
import json
import pathlib
import statistics
import subprocess
import sys

import check_includes

PROJECT = check_includes.PROJECT
SMALL = 60


def git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=PROJECT, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"count_structure: git {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def sources() -> list[pathlib.PurePosixPath]:
    """C++ and CUDA files of src and include that Git tracks or does not ignore."""
    names = git("ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "src", "include").split("\0")
    paths = sorted(pathlib.PurePosixPath(name) for name in names if name)
    return [path for path in paths if path.suffix in (".hpp", ".cpp", ".cu", ".cuh") and (PROJECT / path).is_file()]


def included(source: pathlib.PurePosixPath) -> set[pathlib.PurePosixPath]:
    """The project's files that a file includes."""
    found = set()
    for line in (PROJECT / source).read_text(encoding="utf-8").splitlines():
        match = check_includes.INCLUDE.match(line)
        target = check_includes.resolve(source, match[2] or match[1]) if match else None
        if target:
            found.add(target)
    return found


def single_users(paths: list[pathlib.PurePosixPath]) -> tuple[int, dict[str, str]]:
    """The number of internal headers, and the headers with a single user together with this user."""
    users: dict[pathlib.PurePosixPath, set[pathlib.PurePosixPath]] = {
        path: set() for path in paths if path.parts[0] == "src" and path.suffix == ".hpp"
    }
    for path in paths:
        for target in included(path) & users.keys():
            if path.with_suffix("") != target.with_suffix(""):
                users[target].add(path)
    single = {str(header): str(next(iter(of))) for header, of in users.items() if len(of) == 1}
    return len(users), single


def count() -> dict:
    paths = sources()
    headers, single = single_users(paths)
    layers: dict[str, dict[str, dict[str, int]]] = {}
    totals = {folder: collections.Counter() for folder in ("src", "include")}
    for path in paths:
        folder = path.parts[0]
        lines = len((PROJECT / path).read_text(encoding="utf-8").splitlines())
        row = layers.setdefault(check_includes.layer_of(path), {})
        cell = row.setdefault(folder, collections.Counter())
        for counter in (cell, totals[folder]):
            counter.update(files=1, lines=lines, small=int(lines < SMALL))
            counter["single_user"] += str(path) in single
            counter["internal_headers"] += folder == "src" and path.suffix == ".hpp"
    return {"layers": layers, "total": totals, "internal_headers": headers, "single_user": single}


def touched(revision: str) -> dict:
    """Files that the commits of a revision or a range touched."""
    if ".." in revision:
        commits = git("rev-list", "--no-merges", "--reverse", revision).split()
    else:
        commits = git("rev-list", "--max-count=1", revision).split()
    of_each = [
        set(filter(None, git("diff-tree", "--root", "--no-commit-id", "--name-only", "-r", "-z", commit).split("\0")))
        for commit in commits
    ]
    files = sorted(set().union(*of_each))
    places = collections.Counter(place_of(pathlib.PurePosixPath(file)) for file in files)
    return {
        "revision": revision,
        "commits": len(commits),
        "median_files_per_commit": statistics.median([len(names) for names in of_each]) if of_each else 0,
        "places": dict(sorted(places.items())),
        "files": files,
    }


def place_of(path: pathlib.PurePosixPath) -> str:
    """The place of a file: src/LAYER, include/blum/LAYER, another top folder, or a file at the top."""
    depth = {"src": 2, "include": 3, "apps": 2}.get(path.parts[0], 1)
    return "/".join(path.parts[: min(depth, max(len(path.parts) - 1, 1))])


def share(part: int, whole: int) -> str:
    return f"{part} ({100 * part / whole:.0f} %)" if whole else "0"


def show(figures: dict) -> None:
    print(f"{'':14}{'src':>6}{'lines':>8}{'< 60 lines':>14}{'headers':>9}{'one user':>13}{'include':>9}{'lines':>8}")
    rows = [*sorted(figures["layers"].items()), ("total", figures["total"])]
    for name, row in rows:
        inner, outer = (row.get(folder) or collections.Counter() for folder in ("src", "include"))
        print(
            f"{name:14}{inner['files']:>6}{inner['lines']:>8}{share(inner['small'], inner['files']):>14}"
            f"{inner['internal_headers']:>9}{share(inner['single_user'], inner['internal_headers']):>13}"
            f"{outer['files']:>9}{outer['lines']:>8}"
        )
    if "touched" in figures:
        of = figures["touched"]
        print(f"\n{of['revision']}: {of['commits']} commits touch {len(of['files'])} files", end="")
        print(f"; the median one {of['median_files_per_commit']:g}")
        for place, number in of["places"].items():
            print(f"  {number:5} {place}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("revision", nargs="?", help="a revision, or FROM..TO: files that its commits touched, too")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    arguments = parser.parse_args()
    figures = count()
    if arguments.revision:
        figures["touched"] = touched(arguments.revision)
    if arguments.json:
        print(json.dumps(figures, indent=1, sort_keys=True))
    else:
        show(figures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
