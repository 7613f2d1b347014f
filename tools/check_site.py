#!/usr/bin/env python3
"""Checks a built site: `tools/check_site.py FOLDER`.

Each link leads to an existing file and anchor of the site. Each picture, script and style is in the folder, so that the
site opens from a disk. A search index exists. Prints problems, and exits with 1 if there are any. Links to other sites
are not followed.
"""

import html.parser
import pathlib
import sys
import urllib.parse

#: Elements whose files the browser loads.
LOADED = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}


class Page(html.parser.HTMLParser):
    def __init__(self, path: pathlib.Path) -> None:
        super().__init__()
        self.links: list[tuple[str, str]] = []  # element, address
        self.anchors: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        for name in ("id", "name"):
            if values.get(name):
                self.anchors.add(values[name] or "")
        key = "href" if tag == "a" else LOADED.get(tag)
        address = values.get(key) if key else None
        if address and not (tag == "link" and values.get("rel") in ("search", "canonical")):
            self.links.append((tag, address))


def main() -> int:
    site = pathlib.Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in sorted(site.rglob("*.html"))}
    problems: list[str] = []
    count = 0
    for path, page in pages.items():
        for tag, address in page.links:
            parts = urllib.parse.urlsplit(address)
            if parts.scheme or parts.netloc:
                if tag != "a" and parts.scheme != "data":
                    problems.append(f"{path.relative_to(site)}: <{tag}> loads {address} from another site")
                continue
            count += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.is_relative_to(site) or not target.is_file():
                problems.append(f"{path.relative_to(site)}: {address} does not exist")
            elif anchor and target in pages and anchor not in pages[target].anchors:
                problems.append(f"{path.relative_to(site)}: {address} has no such anchor")
    if not (site / "searchindex.js").is_file():
        problems.append("searchindex.js does not exist")
    for problem in problems:
        print(problem)
    print(f"check_site: {len(pages)} pages, {count} links, {len(problems)} problems")
    return 1 if problems or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
