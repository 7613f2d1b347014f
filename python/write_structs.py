"""Writes blum/_structs.py, the types of Blum's options and results, from the descriptions in the extension module.

write_structs.py FOLDER     contains the module _core and receives _structs.py
"""

import re
import sys
from pathlib import Path
from typing import Any

#: Options that functions declare as their own parameters: the spacing of an image consists of three numbers.
NAMED = {"MedialAxisOptions": {"spacing"}}
#: Results with a base class in _methods.py.
METHODS = re.findall(r"^class (\w+)Methods:", (Path(__file__).parent / "blum/_methods.py").read_text("utf-8"), re.M)
HEAD = '''"""Options and results.

The build of the package writes this file from the descriptions of the library's structs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypedDict

from . import _methods

if TYPE_CHECKING:
    from ._arguments import FloatArray, IntArray, Integer, Real
    from ._grid import Grid

Bounds = tuple[tuple[float, float, float], tuple[float, float, float]]
'''


def quoted(text: str) -> str:
    return f'"{text}"'


def comment(doc: str, unit: str) -> str:
    return f"  #: {doc}{f' ({unit})' if unit else ''}"


def class_of(name: str, entry: dict[str, Any]) -> str:
    bases = "TypedDict, total=False" if entry["is_options"] else f"_methods.{name}Methods" if name in METHODS else ""
    lines = [f"class {name}({bases}):" if bases else f"class {name}:"]
    if not entry["is_options"]:
        # Arrays compare element by element, so a generated __eq__ could not return one bool.
        has_arrays = any(kind in ("FloatArray", "IntArray") for _, kind, *_ in entry["members"])
        lines.insert(0, "@dataclass(frozen=True, eq=False)" if has_arrays else "@dataclass(frozen=True)")
    lines.append(f'    """{entry["doc"]}."""\n')
    members = [member for member in entry["members"] if member[0] not in NAMED.get(name, ())]
    lines += [f"    {member}: {kind}{comment(doc, unit)}" for member, kind, _, unit, doc in members]
    return "\n".join(lines)


def structs(described: dict[str, Any], enums: dict[str, tuple[str, ...]]) -> str:
    names = ", ".join(map(quoted, sorted(described)))
    choices = [f"{name} = Literal[{', '.join(map(quoted, values))}]" for name, values in enums.items()]
    classes = [class_of(name, entry) for name, entry in described.items()]
    return "\n\n\n".join(["\n".join([HEAD + "\n".join(choices), f"\n__all__ = [{names}]"]), *classes]) + "\n"


def main() -> None:
    folder = Path(sys.argv[1])
    sys.path.insert(0, str(folder))
    sys.dont_write_bytecode = True
    import _core

    (folder / "_structs.py").write_text(structs(_core.described, _core.enums), encoding="utf-8")


if __name__ == "__main__":
    main()
