#!/usr/bin/env python3
"""Lays out the pages of the documentation site in a folder, for Sphinx (tools/docs.sh).

  tools/stage_site.py FOLDER XML

The pages are the project's Markdown files and a page of file formats. Each public header has a page from Doxygen's XML
in the folder XML. Each module of the Python package has a page from its docstrings.
"""

import ast
import functools
import pathlib
import re
import shutil
import sys

import blum
import cpp_pages
from check_links import markdown_files

PROJECT = pathlib.Path(__file__).resolve().parent.parent

#: Sections of the navigation: titles, and pages in order. Other pages of docs/ follow by name.
SECTIONS = {
    "Guide": [
        "docs/guide/getting-started.md",
        "docs/guide/verbs.md",
        "docs/guide/python.md",
        "docs/guide/library.md",
        "docs/guide/*.md",
        "docs/guide/formats.md",
    ],
    "Reference": ["python/index.rst", "cpp/index.md", "docs/glossary.md", "docs/guide/troubleshooting.md"],
    "Theory": ["docs/theory/*.md"],
    "Project": [
        "docs/architecture.md",
        "docs/performance.md",
        "docs/generated/*.md",
        "docs/decisions/*.md",
        "docs/dependencies.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "SECURITY.md",
    ],
}

LINK = re.compile(r"(\]\(<?|src=\")(?!https?:|mailto:|#)([^)>\s\"]+)")
FOLDER_LINK = re.compile(r"(?<!!)\[((?:[^\]\[]|\[[^\]]*\])*)\]\(([^)\s:#]+)\)")


def plain_folder(folder: pathlib.Path, link: re.Match[str]) -> str:
    """A link to a folder of the project as plain text, because the site has no page for folders."""
    return link[1] if (folder / link[2]).is_dir() else link[0]


def write(path: pathlib.Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def copy_pages(site: pathlib.Path) -> None:
    """Copies the Markdown pages and the project's files that they link to. README.md becomes index.md."""
    for page in markdown_files():
        name = page.relative_to(PROJECT).as_posix()
        if "/" in name and not name.startswith("docs/"):
            continue
        text = page.read_text(encoding="utf-8")
        folder = page.parent
        for _, link in LINK.findall(text):
            target = (folder / link.partition("#")[0]).resolve()
            if target.is_file() and target.suffix != ".md" and target.is_relative_to(PROJECT):
                copy = site / target.relative_to(PROJECT)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(target, copy)
        text = FOLDER_LINK.sub(functools.partial(plain_folder, folder), text)
        text = re.sub(r"\bREADME\.md(?=[)#])", "index.md", text) if name != "README.md" else text
        write(site / ("index.md" if name == "README.md" else name), text)


def format_page() -> str:
    """The page of file formats, from the library's table."""
    out = [
        "# File formats\n\n"
        "MeshLab uses only the property `quality` of `.ply` files for colours. Blum writes it only for radii. "
        "[How to colour points](points.md#distances-of-points).\n\n"
        "Blum does not read the names of units in images, and converts no units. "
        "[How to find the unit](files.md#images-that-blum-reads).\n"
    ]
    for content in dict.fromkeys(row.content for row in blum.file_formats()):
        out.append(
            f"\n## {content.capitalize()}\n\n| format | read | written | holds | opens in |\n|---|---|---|---|---|"
        )
        for row in blum.file_formats(content):
            read, written = (" ".join(f"`{end}`" for end in ends) for ends in (row.extensions, row.written))
            out.append(f"| {row.name} | {read} | {written} | {row.holds} | {row.opens_in} |")
    return "\n".join(out) + "\n"


def add_navigation(site: pathlib.Path) -> None:
    placed = {page for pages in SECTIONS.values() for page in pages if "*" not in page}
    trees = []
    for title, patterns in SECTIONS.items():
        pages: list[str] = []
        for pattern in patterns:
            found = [path.relative_to(site).as_posix() for path in sorted(site.glob(pattern))]
            pages += [name for name in found if name == pattern or name not in placed]
        lines = "\n".join("/" + page.removesuffix(".rst") for page in pages)
        trees.append(f"```{{toctree}}\n:hidden:\n:caption: {title}\n:maxdepth: 1\n\n{lines}\n```\n")
    index = site / "index.md"
    write(index, index.read_text(encoding="utf-8") + "\n" + "\n".join(trees))


def names_of(module: ast.Module) -> list[str]:
    """The public names of a module, in the order of its `__all__`."""
    for node in module.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id == "__all__":
            return list(ast.literal_eval(node.value))
    return []


def write_python_pages(site: pathlib.Path) -> None:
    """One page for each module of the package that lists public names. The first line of its docstring is the title."""
    pages = []
    for path in sorted(pathlib.Path(blum.__file__).parent.glob("*.py")):
        module = ast.parse(path.read_text(encoding="utf-8"))
        if path.name == "__init__.py" or not names_of(module):
            continue
        title = (ast.get_docstring(module) or path.stem).split("\n")[0].rstrip(".")
        name = path.stem.strip("_")
        package = f"blum.{name}." if name in ("ompl", "reference") else "blum."
        kinds = {one.name: "class" for one in module.body if isinstance(one, ast.ClassDef)}
        kinds |= {one.name: "function" for one in module.body if isinstance(one, ast.FunctionDef)}
        parts = [f".. auto{kinds.get(one, 'data')}:: {package}{one}\n" for one in names_of(module)]
        write(site / f"python/{name}.rst", f"{title}\n{'=' * len(title)}\n\n" + "\n".join(parts))
        pages.append((title, f"/python/{name}"))
    listing = "\n   ".join(page for _, page in sorted(pages))
    text = "Python reference\n================\n\n.. automodule:: blum\n   :no-members:\n\n"
    write(site / "python/index.rst", text + f".. toctree::\n   :maxdepth: 1\n\n   {listing}\n")


def main() -> None:
    site = pathlib.Path(sys.argv[1])
    copy_pages(site)
    write(site / "docs/guide/formats.md", format_page())
    cpp_pages.write_pages(pathlib.Path(sys.argv[2]), site)
    write_python_pages(site)
    add_navigation(site)


if __name__ == "__main__":
    main()
