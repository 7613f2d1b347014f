#!/usr/bin/env python3
"""Checks the text of the project's files. Prints each place that breaks a rule, and exits with 1 if there is one.

- No code uses a name that docs/glossary.md replaces.
- No word marks unfinished work, and no absolute path names a machine's folder.
- C++ and Python files have at most 900 lines. C++ headers open with a description, the licence and `#pragma once`.
- Files have no tabs (except makefiles) and no spaces at line ends, and end with a line feed.
"""

import pathlib
import re
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
LONGEST = 900
CODE = {".cpp", ".hpp", ".py", ".sh", ".cmake", ".ts"}
TEXT = CODE | {".txt", ".md", ".json", ".cff", ".in", ".yml", ".yaml", ".toml", ""}
UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX|HACK|[Nn]ot implemented|[Ss]tub|[Pp]laceholder)\b")
# Former names in code, and the terms of docs/glossary.md that replace them.
REPLACED = {
    "bounding_box": "bounds",
    "cavity": "void",
    "contender": "candidate",
    "narrow_band": "band",
    "object_angle": "separation_angle",
    "suspect": "candidate",
    "surface_components": "components",
    "topology_reached": "topology_matches",
    "turned_shells": "reversed_shells",
    "turned_triangles": "reversed_triangles",
}
REPLACED_NAME = re.compile(r"\b(" + "|".join(REPLACED) + r")\b")
MACHINE_PATH = re.compile(r"(?<![\w.}/)<-])/(home|root|work|workspace|Users|mnt|scratch)/\w")


def tracked_files() -> list[pathlib.Path]:
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, cwd=PROJECT, check=True, capture_output=True, text=True).stdout.split("\0")
    return [PROJECT / name for name in names if name and (PROJECT / name).is_file()]


def line_problems(path: pathlib.Path, line: str) -> list[str]:
    problems = []
    if path.suffix in CODE and path != pathlib.Path(__file__).resolve() and UNFINISHED.search(line):
        problems.append("marks unfinished work")
    old = REPLACED_NAME.search(line)
    if old and path.suffix in CODE and path != pathlib.Path(__file__).resolve():
        problems.append(f"`{old[1]}` is called `{REPLACED[old[1]]}` (docs/glossary.md)")
    if MACHINE_PATH.search(line):
        problems.append("names an absolute path of some machine")
    if line != line.rstrip() and path.suffix != ".md":
        problems.append("spaces at the end of the line")
    if "\t" in line and path.name != "Makefile":
        problems.append("a tab")
    return problems


def file_problems(path: pathlib.Path, text: str) -> list[str]:
    problems = []
    lines = text.split("\n")
    if text and not text.endswith("\n"):
        problems.append("no line feed at the end")
    if path.suffix in {".cpp", ".hpp", ".py"} and len(lines) - 1 > LONGEST:
        problems.append(f"{len(lines) - 1} lines; at most {LONGEST}")
    if path.suffix == ".hpp":
        if not re.match(r"// Blum: .*SPDX-License-Identifier: Apache-2\.0", " ".join(lines[:3]).replace(" // ", " ")):
            problems.append("a header opens with `// Blum: <what it is>. SPDX-License-Identifier: Apache-2.0`")
        if "-inl" not in path.name and "#pragma once" not in text:
            problems.append("no #pragma once")
    return problems


def main() -> int:
    broken = 0
    files = 0
    for path in tracked_files():
        relative = path.relative_to(PROJECT)
        inputs = ("tests/fuzz/corpus/", "tests/data/")  # hostile on purpose
        if path.suffix not in TEXT or path.name == "LICENSE" or relative.as_posix().startswith(inputs):
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        files += 1
        found = [(0, problem) for problem in file_problems(path, text)]
        for number, line in enumerate(text.split("\n"), 1):
            found += [(number, problem) for problem in line_problems(path, line)]
        for number, problem in found:
            print(f"{relative}:{number}: {problem}" if number else f"{relative}: {problem}")
        broken += len(found)
    print(f"check_text: {files} files, {broken} problems")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
