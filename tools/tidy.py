#!/usr/bin/env python3
"""Runs clang-tidy over the compiled sources of the library, the tools, the examples and the bindings.

  tools/tidy.py          checks sources that changed since the commit in tools/tidy-base, and the nearest sources that
                         include a changed header, directly or through other headers
  tools/tidy.py --all    checks all sources (`make tidy`); if all pass and everything is committed, the commit becomes
                         tools/tidy-base
  tools/tidy.py --deep   checks all sources with the static analyzer's own limit; otherwise it visits 20,000 states of a
                         function, which takes a third of the time

All sources of the commit in tools/tidy-base passed. If this commit is unknown (a shallow clone) or .clang-tidy changed,
all sources are checked. The build folder is build/release, and is configured if it is missing. JOBS limits the number
of parallel runs.

Every source is read without precompiled headers, so a source that relies on their includes fails.

Passed sources are recorded beside the compiler cache. The same preprocessed source, checks and clang-tidy are not run
again, also not in another clone.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

from check_includes import INCLUDE, PROJECT, resolve

FOLDERS = ("src", "apps", "examples", "python")
BUILD = PROJECT / "build/release"
ALONE = BUILD / "tidy"
BASE = PROJECT / "tools/tidy-base"
CLANG_TIDY = PROJECT / "build/venv/bin/clang-tidy"
#: The analyzer's own limit is 225,000 states of a function.
QUICK = [f"--extra-arg={word}" for word in ("-Xclang", "-analyzer-config", "-Xclang", "max-nodes=20000")]


def without_precompiled(words: list[str]) -> list[str]:
    """A compiler's arguments without CMake's precompiled header; clang cannot read that of g++."""
    kept = []
    skipped = False
    for word, following in zip(words, [*words[1:], ""], strict=True):
        is_header = word == "-include" and "cmake_pch" in following
        if not (skipped or is_header or word in ("-Winvalid-pch", "-fpch-preprocess")):
            kept.append(word)
        skipped = is_header
    return kept


def compile_commands() -> dict[str, list[str]]:
    """The compiler's arguments for each source, without the compiler and its output.

    Sources of a unity build (BLUM_UNITY) have the arguments of the file that includes them.
    """
    if not (BUILD / "compile_commands.json").is_file():
        subprocess.run(["cmake", "--preset", "release"], cwd=PROJECT, check=True, stdout=subprocess.DEVNULL)
    found = {}
    alone = []
    for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
        file = pathlib.Path(entry["file"])
        files = [file]
        if file.is_file() and file.parent == BUILD / "python/units":
            files = [PROJECT / "python" / name for name in re.findall(r'"(.+)"', file.read_text(encoding="utf-8"))]
        words = without_precompiled(shlex.split(entry["command"]))
        for source in files:
            if not source.is_file() or not any(source.is_relative_to(PROJECT / folder) for folder in FOLDERS):
                continue
            own = [str(source) if word == entry["file"] else word for word in words]
            alone.append({"directory": entry["directory"], "file": str(source), "arguments": own})
            found[source.relative_to(PROJECT).as_posix()] = [
                word
                for before, word in zip(words, words[1:], strict=False)
                if before == "-isystem" or word.startswith(("-I", "-D", "-std", "-f", "-isystem"))
            ]
    ALONE.mkdir(exist_ok=True)
    (ALONE / "compile_commands.json").write_text(json.dumps(alone), encoding="utf-8")
    return found


def git(*arguments: str) -> list[str]:
    done = subprocess.run(["git", *arguments], cwd=PROJECT, check=True, capture_output=True, text=True)
    return done.stdout.split("\0" if "-z" in arguments else "\n")


def changed_files() -> set[str] | None:
    """The files that differ from the recorded commit; None if that is unknown."""
    commit = BASE.read_text(encoding="utf-8").strip() if BASE.is_file() else ""
    known = (
        commit
        and subprocess.run(
            ["git", "cat-file", "-e", f"{commit}^{{commit}}"], cwd=PROJECT, check=False, capture_output=True
        ).returncode
        == 0
    )
    if not known:
        print("clang-tidy: the commit of tools/tidy-base is not here, so everything is checked")
        return None
    changed = set(git("diff", "-z", "--name-only", commit)) | set(
        git("ls-files", "-z", "--others", "--exclude-standard")
    )
    if ".clang-tidy" in changed:
        print("clang-tidy: .clang-tidy changed, so everything is checked")
        return None
    return changed


def includers() -> dict[str, set[str]]:
    """For each of the project's files, the files that include it."""
    found: dict[str, set[str]] = {}
    for folder in ("include", *FOLDERS):
        for path in (PROJECT / folder).rglob("*.[ch]pp"):
            if "node_modules" in path.parts:
                continue
            source = pathlib.PurePosixPath(path.relative_to(PROJECT).as_posix())
            for line in path.read_text(encoding="utf-8").splitlines():
                match = INCLUDE.match(line)
                target = resolve(source, match[1] or match[2]) if match else None
                if target is not None:
                    found.setdefault(target.as_posix(), set()).add(source.as_posix())
    return found


def affected(changed: set[str], sources: set[str]) -> set[str]:
    above = includers()
    chosen = changed & sources
    for header in changed - sources:
        level, seen = {header}, {header}
        while level and not level & sources:
            level = {file for lower in level for file in above.get(lower, ())} - seen
            seen |= level
        chosen |= level & sources
    return chosen


def cache_folder() -> pathlib.Path:
    compiler_cache = os.environ.get("CCACHE_DIR")
    return (pathlib.Path(compiler_cache).parent if compiler_cache else pathlib.Path.home() / ".cache") / "blum-tidy"


def key_of(file: str, arguments: list[str], common: str) -> str | None:
    """A hash of clang-tidy's input for a source; None if preprocessing fails."""
    command = ["clang++-19", "-E", "-C", "-Wno-everything", *arguments, str(PROJECT / file)]
    done = subprocess.run(command, cwd=BUILD, check=False, capture_output=True)
    if done.returncode != 0:
        return None
    seen = done.stdout.replace(str(PROJECT).encode(), b".")
    names = " ".join(arguments).replace(str(PROJECT), ".")
    return hashlib.sha256(b"\0".join([common.encode(), names.encode(), seen])).hexdigest()


def run_tidy(file: str, options: list[str]) -> str:
    command = [str(CLANG_TIDY), "-p", str(ALONE), "--quiet", "--extra-arg=-Wno-unknown-warning-option", *options, file]
    done = subprocess.run(command, cwd=PROJECT, check=False, capture_output=True, text=True)
    return "" if done.returncode == 0 else f"{file}: exit status {done.returncode}\n{done.stdout}{done.stderr}"


def tidy(file: str, arguments: list[str], options: list[str], common: str) -> str:
    key = key_of(file, arguments, common)
    known = cache_folder() / key if key else None
    if known and known.exists():
        return ""
    report = run_tidy(file, options)
    if known and not report:
        known.parent.mkdir(parents=True, exist_ok=True)
        known.touch()
    return report


def main(arguments: list[str]) -> int:
    if arguments not in ([], ["--all"], ["--deep"]):
        print(__doc__, file=sys.stderr)
        return 2
    options = [] if arguments == ["--deep"] else QUICK
    commands = compile_commands()
    changed = None if arguments else changed_files()
    chosen = sorted(commands if changed is None else affected(changed, set(commands)))
    print(f"clang-tidy: {len(chosen)} of {len(commands)} files", flush=True)
    version = subprocess.run([CLANG_TIDY, "--version"], check=True, capture_output=True, text=True).stdout
    common = version + " ".join(options) + (PROJECT / ".clang-tidy").read_text(encoding="utf-8")
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS") or os.cpu_count() or 1)) as pool:
        for report in pool.map(lambda file: tidy(file, commands[file], options, common), chosen):
            if report:
                failed += 1
                print(report, flush=True)
    if arguments and failed == 0:
        record()
    return 1 if failed else 0


def record() -> None:
    """Records the commit as the base of the next runs, after everything passed."""
    if "".join(git("status", "--porcelain")):
        print("clang-tidy: everything passed, with changes that are not committed: tools/tidy-base stays as it is")
        return
    BASE.write_text(git("rev-parse", "HEAD")[0] + "\n", encoding="utf-8")
    print("clang-tidy: everything passed; commit tools/tidy-base, which now names this commit")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
