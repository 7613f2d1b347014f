#!/usr/bin/env python3
"""Counts results of tests and checks over several programs, and closes with one line.

  results.py check DIR NAME -- COMMAND...   run a command as one check, which passes if the command exits with 0
  results.py junit DIR NAME FILE [INNER]    count the tests of a JUnit file (ctest, vitest); no tests is a failure. The
                                            tests of INNER/X.xml replace a test pytest.X of ctest. A skipped one counts
                                            as failed, unless it lacks the data folder or a CUDA device
  results.py fail DIR NAME REASON           count one failure
  results.py summary DIR                    list failures and skips; last line `N passed, N failed[, N skipped]`

Every command except `summary` adds a file to DIR, and exits with 0 also on failure, so that later steps still run.
`summary` exits with 1 if a test failed or nothing passed. If the data folder exists (BLUM_DATA_DIR, else ../shared/data
beside the project), a test that was skipped for lack of data counts as failed.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

PROJECT = pathlib.Path(__file__).resolve().parent.parent
WANTS_DEVICE = re.compile(r"no CUDA (device|module)|CUDA: ")
WANTS_DATA = re.compile(r"no data folder|data folder|shared/data|BLUM_DATA_DIR", re.IGNORECASE)


def data_present() -> bool:
    return pathlib.Path(os.environ.get("BLUM_DATA_DIR") or PROJECT.parent / "shared" / "data").is_dir()


def record(folder: str, name: str, passed: int, failed: list[str], skipped: list[str], seconds: float = 0) -> None:
    path = pathlib.Path(folder)
    path.mkdir(parents=True, exist_ok=True)
    # The numbers in file names keep the order of the results.
    number = len(list(path.glob("*.json")))
    entry = {"name": name, "passed": passed, "failed": failed, "skipped": skipped, "seconds": round(seconds, 1)}
    (path / f"{number:03}-{name}.json").write_text(json.dumps(entry, indent=1), encoding="utf-8")
    print(f"{name}: {passed} passed, {len(failed)} failed, {len(skipped)} skipped", flush=True)


def check(folder: str, name: str, command: list[str]) -> None:
    print(f"--- {name}: {' '.join(command)}", flush=True)
    start = time.monotonic()
    status = subprocess.run(command, check=False).returncode
    seconds = time.monotonic() - start
    if status == 0:
        record(folder, name, 1, [], [], seconds)
    else:
        record(folder, name, 0, [f"{name} (exit status {status})"], [], seconds)


def outcome(case: ElementTree.Element, label: str, complete: bool) -> tuple[str, str]:
    """The outcome of a test (passed, failed or skipped) and its label in the list."""
    if case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail":
        return "failed", label
    skip = case.find("skipped")
    if skip is None and case.get("status") not in ("notrun", "disabled"):
        return "passed", label
    text = (skip.get("message") or "" if skip is not None else "") + " " + (case.findtext("system-out") or "")
    if case.get("status") == "disabled" or "Unable to find executable" in text or "_NOT_BUILT" in label:
        return "failed", f"{label} (did not run)"
    if data_present() and WANTS_DATA.search(text):
        return "failed", f"{label} (skipped for want of data, though the data folder is there)"
    if complete and not WANTS_DATA.search(text) and not WANTS_DEVICE.search(text):
        return "failed", f"{label} (skipped: {text.strip()})"
    return "skipped", label


def inner_outcomes(file: pathlib.Path, outer: tuple[str, str]) -> list[tuple[str, str]]:
    """The outcomes of the tests of one pytest file.

    A failure is added if the file has no results, or if its test of ctest failed although none of its tests did."""
    try:
        cases = list(ElementTree.parse(file).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        cases = []
    found = [outcome(case, f"pytest: {case.get('classname')}.{case.get('name')}", complete=True) for case in cases]
    if not found or (outer[0] != "passed" and all(kind != "failed" for kind, _ in found)):
        found.append(("failed", f"{outer[1]} (broke off)"))
    return found


def junit(folder: str, name: str, file: str, inner: str | None) -> None:
    try:
        root = ElementTree.parse(file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        record(folder, name, 0, [f"{name}: no results ({error})"], [])
        return
    outcomes: list[tuple[str, str]] = []
    seconds = 0.0
    for case in root.iter("testcase"):
        seconds += float(case.get("time") or 0)
        test = case.get("name") or ""
        found = outcome(case, f"{name}: {test}", complete=False)
        if inner and test.startswith("pytest."):
            outcomes += inner_outcomes(pathlib.Path(inner) / f"{test.removeprefix('pytest.')}.xml", found)
        else:
            outcomes.append(found)
    passed, failed, skipped = ([label for kind, label in outcomes if kind == wanted]
                               for wanted in ("passed", "failed", "skipped"))
    if not outcomes:
        failed.append(f"{name}: no tests were found")
    record(folder, name, len(passed), failed, skipped, seconds)


def summary(folder: str) -> int:
    entries = [json.loads(file.read_text(encoding="utf-8")) for file in sorted(pathlib.Path(folder).glob("*.json"))]
    print(f"\n{'':26} passed failed skipped  seconds")
    for entry in entries:
        counts = f"{entry['passed']:6} {len(entry['failed']):6} {len(entry['skipped']):7} {entry['seconds']:8.1f}"
        print(f"{entry['name']:26} {counts}")
    failed = [item for entry in entries for item in entry["failed"]]
    skipped = [item for entry in entries for item in entry["skipped"]]
    passed = sum(entry["passed"] for entry in entries)
    for item in skipped:
        print(f"SKIPPED {item}")
    for item in failed:
        print(f"FAILED {item}")
    if passed == 0 and not failed:
        failed.append("nothing ran")
        print("FAILED nothing ran")
    print(f"{passed} passed, {len(failed)} failed" + (f", {len(skipped)} skipped" if skipped else ""), flush=True)
    return 1 if failed else 0


def main(arguments: list[str]) -> int:
    match arguments:
        case ["check", folder, name, "--", *command] if command:
            check(folder, name, command)
        case ["junit", folder, name, file]:
            junit(folder, name, file, None)
        case ["junit", folder, name, file, inner]:
            junit(folder, name, file, inner)
        case ["fail", folder, name, reason]:
            record(folder, name, 0, [f"{name}: {reason}"], [])
        case ["summary", folder]:
            return summary(folder)
        case _:
            print(__doc__, file=sys.stderr)
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
