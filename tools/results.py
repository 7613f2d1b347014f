#!/usr/bin/env python3
"""Counts results of tests and checks, over several programs, and closes with one line.

  results.py check DIR NAME -- COMMAND...   run a command; it counts as one check, passed when it exits with 0
  results.py junit DIR NAME FILE [--complete]   count the tests of a JUnit file (ctest, pytest); no tests is a failure;
                                            --complete: so is a test that was skipped, but for want of the data folder
                                            or of a CUDA device
  results.py fail DIR NAME REASON           count one failure
  results.py summary DIR                    list what failed and was skipped; last line `N passed, N failed[, N skipped]`

Every command but `summary` adds a file to DIR, and exits with 0 also on failure, so that the rest still runs; `summary`
exits with 1 where anything failed or nothing passed. With the data folder present (BLUM_DATA_DIR, else ../shared/data
beside the project), a test that was skipped for want of data counts as failed.
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
    # The order of the names is the order in which the results came in.
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


def junit(folder: str, name: str, file: str, complete: bool) -> None:
    try:
        root = ElementTree.parse(file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        record(folder, name, 0, [f"{name}: no results ({error})"], [])
        return
    passed = 0
    failed: list[str] = []
    skipped: list[str] = []
    seconds = 0.0
    for case in root.iter("testcase"):
        label = f"{name}: {case.get('name')}"
        seconds += float(case.get("time") or 0)
        skip = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail":
            failed.append(label)
        elif skip is not None or case.get("status") in ("notrun", "disabled"):
            text = (skip.get("message") or "" if skip is not None else "") + " " + (case.findtext("system-out") or "")
            if case.get("status") == "disabled" or "Unable to find executable" in text or "_NOT_BUILT" in label:
                failed.append(f"{label} (did not run)")
            elif data_present() and WANTS_DATA.search(text):
                failed.append(f"{label} (skipped for want of data, though the data folder is there)")
            elif complete and not WANTS_DATA.search(text) and not WANTS_DEVICE.search(text):
                failed.append(f"{label} (skipped: {text.strip()})")
            else:
                skipped.append(label)
        else:
            passed += 1
    if passed + len(failed) + len(skipped) == 0:
        failed.append(f"{name}: no tests were found")
    record(folder, name, passed, failed, skipped, seconds)


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
            junit(folder, name, file, complete=False)
        case ["junit", folder, name, file, "--complete"]:
            junit(folder, name, file, complete=True)
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
