#!/usr/bin/env python3
"""Checks the messages of commits by the rule in CONTRIBUTING.md, "Commits and review".

  tools/check_commits.py              commits that are not in origin's main, from the commit on that added this file;
                                      no commits if such a branch is unknown
  tools/check_commits.py FROM..TO     commits of a range

- A subject has at most 72 characters, is one idea (no semicolon), and ends without a full stop.
- An empty line separates subject and body. Lines of the body have at most 100 characters, except for links.
- No commit that belongs into another one: fixup!, squash!, amend!, WIP.

Merges are not checked. Prints each broken rule, and exits with 1 if there is one.
"""

import re
import subprocess
import sys

SUBJECT, BODY = 72, 100
BASES = ("refs/remotes/origin/main", "refs/remotes/origin/HEAD")


def git(*arguments: str) -> str | None:
    """The output of git; None if git fails."""
    done = subprocess.run(["git", *arguments], check=False, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


def before_the_rule() -> list[str]:
    """Arguments for git rev-list that leave out commits older than this file."""
    added = (git("log", "--diff-filter=A", "--format=%H", "--", ":(top)tools/check_commits.py") or "").split()
    parents = f"{added[-1]}^@" if added else ""
    return ["--not", parents] if parents and git("rev-parse", "--verify", "--quiet", f"{added[-1]}^") else []


def new_commits() -> list[str] | None:
    """Arguments for git rev-list that select commits not in origin's main; None if unknown."""
    for base in BASES:
        if git("rev-parse", "--verify", "--quiet", f"{base}^{{commit}}") is None:
            continue
        if git("merge-base", base, "HEAD") is None:
            print(f"check_commits: skipped, {base} has no commit in common with this history (a shallow clone?)")
            return None
        return [f"{base}..HEAD", *before_the_rule()]
    print("check_commits: skipped, there is no origin/main to compare with")
    return None


def problems(message: str) -> list[str]:
    subject, *rest = message.rstrip("\n").split("\n")
    found = []
    if not subject:
        found.append("no subject")
    if len(subject) > SUBJECT:
        found.append(f"{len(subject)} characters in the subject; at most {SUBJECT}")
    if ";" in subject:
        found.append("a semicolon in the subject: one idea in a commit, the rest in the body")
    if subject.endswith("."):
        found.append("a full stop at the end of the subject")
    if re.match(r"(fixup|squash|amend)!|wip\b", subject, re.IGNORECASE):
        found.append("should become part of another commit")
    if rest and rest[0]:
        found.append("no empty line after the subject")
    found += [f"{len(line)} characters in a line of the body; at most {BODY}" for line in rest
              if len(line) > BODY and "://" not in line]  # fmt: skip
    return found


def main() -> int:
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and ".." not in sys.argv[1]):
        print(__doc__, file=sys.stderr)
        return 2
    commits = [sys.argv[1]] if len(sys.argv) == 2 else new_commits()
    if commits is None:
        return 0
    names = git("rev-list", "--no-merges", "--reverse", *commits)
    if names is None:
        print(f"check_commits: git knows no commits {' '.join(commits)}", file=sys.stderr)
        return 2
    broken = 0
    for name in names.split():
        message = git("log", "-1", "--format=%B", name) or ""
        for problem in problems(message):
            print(f"{name[:10]} {message.splitlines()[0] if message else ''}: {problem}")
            broken += 1
    print(f"check_commits: {len(names.split())} commits, {broken} problems")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
