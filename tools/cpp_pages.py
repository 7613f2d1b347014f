"""Makes pages of the C++ reference from Doxygen's XML, one for each public header (tools/stage_site.py).

Breathe, the usual bridge from Doxygen to Sphinx, fails on the specialised templates of these headers. A page lists the
declarations of its header in the order of the code, each with its contract.
"""

import pathlib
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass, field

#: Kinds of compounds that get a section, and titles of the parts of a contract.
COMPOUNDS = ("struct", "class", "union")
SECTIONS = {
    "return": "Returns",
    "see": "See",
    "note": "Note",
    "warning": "Warning",
    "since": "Since",
    "pre": "Requires",
}
LISTS = {"param": "Parameters", "templateparam": "Template parameters", "exception": "Errors", "retval": "Returns"}


def plain(element: ET.Element | None) -> str:
    """The text of an element with folded white space."""
    return "" if element is None else re.sub(r"\s+", " ", "".join(element.itertext())).strip()


def code(text: str) -> str:
    return f"```cpp\n{text}\n```\n"


def escaped(text: str) -> str:
    """Text of a comment, escaped so that Markdown does not read it as markup."""
    return re.sub(r"([\\`*_\[\]<>|$])", r"\\\1", text)


def line_of(member: ET.Element) -> int:
    location = member.find("location")
    return 0 if location is None else int(location.get("line", "0"))


@dataclass
class Header:
    name: str
    doc: str = ""
    titles: set[str] = field(default_factory=set)  # anchors on the page
    entries: list[tuple[int, str]] = field(default_factory=list)  # line of the header, Markdown


class Reference:
    def __init__(self, folder: pathlib.Path) -> None:
        self.trees = [ET.parse(path).getroot() for path in sorted(folder.glob("*.xml")) if path.name != "index.xml"]
        self.headers: dict[str, Header] = {}
        self.anchors: dict[str, str] = {}  # Doxygen's id -> target on a page
        compounds = [tree.find("compounddef") for tree in self.trees]
        self.compounds = [one for one in compounds if one is not None]
        for compound in self.compounds:
            if compound.get("kind") in COMPOUNDS:
                name = plain(compound.find("compoundname"))
                self.anchors[compound.get("id", "")] = (
                    self.anchor(name) + "-type"
                )  # distinguishes Estimate from estimate, because anchors ignore case
            for member in compound.iter("memberdef"):
                scope = plain(compound.find("compoundname")) if compound.get("kind") in COMPOUNDS else ""
                if member.get("kind") != "variable" or not scope:
                    place = member.find("location")
                    page = pathlib.PurePosixPath("" if place is None else place.get("file", "")).stem
                    name = (scope or page) + "::" + plain(member.find("name"))
                    suffix = "" if member.get("kind") == "function" else "-type"
                    self.anchors[member.get("id", "")] = self.anchor(name) + suffix

    @staticmethod
    def anchor(name: str) -> str:
        signs = "".join(f"-{ord(sign)}" for sign in re.sub(r"[\w:]", "", name))  # for operators
        return "cpp-" + re.sub(r"[^\w]+", "-", name.removeprefix("blum::")).strip("-") + signs

    def pages(self) -> dict[str, Header]:
        for compound in self.compounds:
            kind = compound.get("kind")
            location = compound.find("location")
            if kind == "file" and location is not None:
                self.header(location).doc = self.contract(compound)
        done: set[str] = set()
        for compound in self.compounds:
            if compound.get("kind") in COMPOUNDS:
                self.add_class(compound)
            elif compound.get("kind") == "namespace":
                for member in sorted(compound.iter("memberdef"), key=line_of):
                    if member.get("id", "") not in done:
                        done.add(member.get("id", ""))
                        self.add_function(member)
        for header in self.headers.values():
            header.entries.sort(key=lambda entry: entry[0])
        return self.headers

    def header(self, location: ET.Element) -> Header:
        name = location.get("file", "").removeprefix("include/")
        return self.headers.setdefault(name, Header(name))

    def heading(self, element: ET.Element, header: Header, title: str, level: int) -> str:
        """A heading with the anchor of an element; empty for an overload of an earlier function."""
        anchor = self.anchors[element.get("id", "")]
        if anchor in header.titles:
            return ""
        header.titles.add(anchor)
        return f"({anchor})=\n{'#' * level} {escaped(title)}\n\n"

    # Declarations.

    def add_class(self, compound: ET.Element) -> None:
        name = plain(compound.find("compoundname")).removeprefix("blum::")
        location = compound.find("location")
        if location is None or name.startswith("Description<") or compound.get("prot") == "private":
            return
        bases = [plain(base) for base in compound.findall("basecompoundref")]
        template = self.template_of(compound)
        head = f"{template}{compound.get('kind')} {name}" + (f" : {', '.join(bases)}" if bases else "")
        header = self.header(location)
        out = [self.heading(compound, header, name, 2), code(head + ";"), "\n"]
        out.append(self.contract(compound))
        public = [s for s in compound.findall("sectiondef") if s.get("kind", "").startswith(("public", "user-defined"))]
        members = [m for section in public for m in section.findall("memberdef") if m.get("prot") == "public"]
        members.sort(key=line_of)
        out.append(self.table_of([m for m in members if m.get("kind") == "variable"]))
        for member in members:
            if member.get("kind") in ("variable", "friend") or self.is_deleted_or_default(member):
                continue
            heading = self.heading(member, header, plain(member.find("name")), 3)
            out.append(heading + code(self.declaration(member)) + "\n" + self.contract(member))
        header.entries.append((int(location.get("line", "0")), "".join(out)))

    @staticmethod
    def is_deleted_or_default(member: ET.Element) -> bool:
        """True for destructors and for defaulted or deleted members."""
        return bool(re.search(r"=\s*(default|delete)\s*$", plain(member.find("argsstring")))) or plain(
            member.find("name")
        ).startswith("~")

    def table_of(self, members: list[ET.Element]) -> str:
        if not members:
            return ""
        rows = ["| member | type | default | contents |\n|---|---|---|---|\n"]
        for member in members:
            value = re.sub(r"^=\s*", "", plain(member.find("initializer")))
            text = re.sub(r"\s*\n\s*", " ", self.contract(member)).strip()
            cells = [
                f"`{plain(member.find('name'))}`",
                f"`{plain(member.find('type'))}`",
                f"`{value}`" if value else "",
            ]
            rows.append("| " + " | ".join([*(cell.replace("|", "\\|") for cell in cells), text]) + " |\n")
        return "".join(rows) + "\n"

    def add_function(self, member: ET.Element) -> None:
        location = member.find("location")
        if location is None or member.get("kind") not in ("function", "enum", "typedef", "variable"):
            return
        name = plain(member.find("name"))
        body = self.contract(member)
        if member.get("kind") == "enum":
            rows = [
                f"| `{plain(value.find('name'))}` | {re.sub(chr(10), ' ', self.contract(value)).strip()} |\n"
                for value in member.findall("enumvalue")
            ]
            body += "| value | meaning |\n|---|---|\n" + "".join(rows) + "\n"
        header = self.header(location)
        line = int(location.get("line", "0"))
        header.entries.append(
            (line, self.heading(member, header, name, 2) + code(self.declaration(member)) + "\n" + body)
        )

    @staticmethod
    def template_of(element: ET.Element) -> str:
        parameters = element.find("templateparamlist")
        if parameters is None:
            return ""
        names = []
        for one in parameters.findall("param"):
            value = plain(one.find("defval"))
            names.append(
                f"{plain(one.find('type'))} {plain(one.find('declname'))}".strip() + (f" = {value}" if value else "")
            )
        return f"template <{', '.join(names)}>\n"

    def declaration(self, member: ET.Element) -> str:
        kind, name = member.get("kind"), plain(member.find("name"))
        if kind == "enum":
            return f"enum class {name};"
        if kind == "typedef":
            definition = plain(member.find("definition"))
            return definition.removeprefix("typedef ").replace("blum::", "") + ";"
        result = re.sub(r"\[\[nodiscard\]\]\s*", "", plain(member.find("type"))).replace("blum::", "")
        first = self.template_of(member) + ("static " if member.get("static") == "yes" and kind == "function" else "")
        first += f"{result} {name}".strip()
        if kind == "variable":
            return f"{first} {plain(member.find('initializer'))}".strip() + ";"
        parameters = []
        for one in member.findall("param"):
            value = plain(one.find("defval"))
            text = f"{plain(one.find('type'))} {plain(one.find('declname'))}".strip()
            parameters.append(text.replace("blum::", "") + (f" = {value}" if value else ""))
        tail = " const" if member.get("const") == "yes" else ""
        one_line = f"{first}({', '.join(parameters)}){tail};"
        if max(map(len, one_line.split("\n"))) <= 100:
            return one_line
        return f"{first}(\n    " + ",\n    ".join(parameters) + f"){tail};"

    # Contracts.

    def contract(self, element: ET.Element) -> str:
        parts = [element.find("briefdescription"), element.find("detaileddescription")]
        return "".join(text for part in parts if part is not None for text in self.blocks(part))

    def blocks(self, element: ET.Element) -> Iterator[str]:
        for child in element:
            if child.tag == "para":
                yield from self.paragraph(child)
            elif child.tag.startswith("sect"):
                yield from self.blocks(child)
            elif child.tag == "title":
                yield f"**{escaped(plain(child))}**\n\n"

    def paragraph(self, para: ET.Element) -> Iterator[str]:
        text = [escaped(para.text or "")]
        for child in para:
            if child.tag in (
                "parameterlist",
                "simplesect",
                "itemizedlist",
                "orderedlist",
                "programlisting",
                "verbatim",
            ):
                yield from self.flush(text)
                yield self.block(child)
            else:
                text.append(self.inline(child))
            text.append(escaped(child.tail or ""))
        yield from self.flush(text)

    @staticmethod
    def flush(text: list[str]) -> Iterator[str]:
        joined = re.sub(r"\s+", " ", "".join(text)).strip()
        text.clear()
        if joined:
            yield joined + "\n\n"

    def inline(self, element: ET.Element) -> str:
        if element.tag == "computeroutput":
            return f"`{plain(element)}`"
        if element.tag == "ref":
            target = self.anchors.get(element.get("refid", ""))
            return f"[`{plain(element)}`](#{target})" if target else f"`{plain(element)}`"
        if element.tag == "ulink":
            return f"[{escaped(plain(element))}]({element.get('url')})"
        if element.tag == "formula":
            return f"`{plain(element)}`"
        if element.tag == "sp":
            return " "
        inner = escaped(element.text or "") + "".join(self.inline(c) + escaped(c.tail or "") for c in element)
        if element.tag in ("bold", "emphasis"):
            return f"*{inner}*" if element.tag == "emphasis" else f"**{inner}**"
        names = {"ndash": "\u2013", "mdash": "\u2014", "nonbreakablespace": " "}
        return names.get(element.tag, inner)

    def block(self, element: ET.Element) -> str:
        if element.tag in ("programlisting", "verbatim"):
            lines = ["".join(self.listing(line)) for line in element.findall("codeline")]
            return code("\n".join(lines) if lines else (element.text or "").strip("\n")) + "\n"
        if element.tag in ("itemizedlist", "orderedlist"):
            mark = "-" if element.tag == "itemizedlist" else "1."
            items = ["".join(self.blocks(item)).strip().replace("\n", "\n  ") for item in element.findall("listitem")]
            return "".join(f"{mark} {item}\n" for item in items) + "\n"
        if element.tag == "simplesect":
            title = SECTIONS.get(element.get("kind", ""), (element.get("kind") or "").capitalize())
            return f"**{title}:** " + "".join(self.blocks(element))
        rows = []
        for item in element.findall("parameteritem"):
            names = ", ".join(f"`{plain(name)}`" for name in item.iter("parametername"))
            text = "".join(self.blocks(item.find("parameterdescription") or ET.Element("none"))).strip()
            rows.append(f"- {names}: " + text.replace("\n", "\n  ") + "\n")
        return f"**{LISTS.get(element.get('kind', ''), 'Parameters')}:**\n\n" + "".join(rows) + "\n"

    def listing(self, element: ET.Element) -> Iterator[str]:
        for part in element.iter():
            if part.tag == "sp":
                yield " "
            else:
                yield part.text or ""
            if part is not element:
                yield part.tail or ""


def write_pages(xml: pathlib.Path, site: pathlib.Path) -> None:
    """Writes cpp/index.md, an index for each layer, and a page for each header with declarations."""
    layers: dict[str, list[str]] = {}
    for name, header in sorted(Reference(xml).pages().items()):
        if not header.entries:
            continue
        path = pathlib.PurePosixPath(name)
        page = site / "cpp" / path.parent.name / f"{path.stem}.md"
        page.parent.mkdir(parents=True, exist_ok=True)
        entries = "".join(text for _, text in header.entries)
        page.write_text(f"# {escaped(name)}\n\n{header.doc}{code(f'#include <{name}>')}\n{entries}", encoding="utf-8")
        layers.setdefault(path.parent.name, []).append(f"/cpp/{path.parent.name}/{path.stem}.md")
    for layer, pages in layers.items():
        text = f"# blum/{layer}\n\n```{{toctree}}\n:maxdepth: 1\n\n" + "\n".join(pages) + "\n```\n"
        (site / "cpp" / layer / "index.md").write_text(text, encoding="utf-8")
    listing = "\n".join(f"/cpp/{layer}/index.md" for layer in layers)
    text = f"# C++ reference\n\nThe public headers, by layer.\n\n```{{toctree}}\n:maxdepth: 2\n\n{listing}\n```\n"
    (site / "cpp/index.md").write_text(text, encoding="utf-8")
