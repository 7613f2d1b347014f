#!/usr/bin/env python3
"""Checks the links of Markdown files: linked files and headings of the project exist, and no link spans two lines.

Prints broken links, and exits with 1 if there are any. Links to other sites are not followed."""

import pathlib
import re
import subprocess
import sys
import urllib.parse

PROJECT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"!?\[(?:[^\]\[]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|<img[^>]+src=\"([^\"]+)\"")
FENCE = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)


def markdown_files() -> list[pathlib.Path]:
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "*.md"]
    names = subprocess.run(command, cwd=PROJECT, check=True, capture_output=True, text=True).stdout.split("\0")
    return [PROJECT / name for name in names if name and (PROJECT / name).is_file()]


def anchors(path: pathlib.Path) -> set[str]:
    """The anchors of a page's headings, in the common form of Markdown hosts."""
    found: set[str] = set()
    for heading in re.findall(r"^#{1,6}\s+(.*?)\s*#*$", FENCE.sub("", path.read_text(encoding="utf-8")), re.MULTILINE):
        explicit = re.search(r"\{#([\w-]+)\}", heading)
        plain = re.sub(r"[^\w\- ]", "", re.sub(r"\{#.*?\}", "", heading).strip().lower()).replace(" ", "-")
        anchor = explicit[1] if explicit else plain
        number = 1
        while anchor in found:
            anchor = f"{plain}-{number}"
            number += 1
        found.add(anchor)
    return found


def main() -> int:
    broken = 0
    links = 0
    for page in markdown_files():
        text = re.sub(r"`[^`\n]*`", "", FENCE.sub("", page.read_text(encoding="utf-8")))
        for match in LINK.finditer(text):
            link = match[1] or match[2]
            if "\n" in match[0]:
                print(f"{page.relative_to(PROJECT)}: {link} spans two lines: Doxygen garbles what follows")
                broken += 1
            if re.match(r"[a-z]+:", link):
                continue
            links += 1
            name, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (page.parent / name).resolve() if name else page
            problem = None
            if not name:
                problem = f"needs the page's name ({page.name}#{anchor}): Doxygen knows no headings by their words alone"
            elif not target.exists():
                problem = "is not there"
            elif not target.is_relative_to(PROJECT):
                problem = "is outside of the project"
            elif anchor and target.suffix == ".md" and anchor not in anchors(target):
                problem = "has no such heading"
            if problem:
                print(f"{page.relative_to(PROJECT)}: {link} {problem}")
                broken += 1
    print(f"check_links: {links} links, {broken} broken")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
