#!/usr/bin/env python3
"""Checks the rules of includes. Prints each line that breaks a rule, and exits with 1 if there is one.

- A layer may include the public headers of lower layers and its own. Its sources may also include its internals.
- The certificate checks the results of other layers. Apart from core and complex, it may include only headers in
  SHARED. None of them constructs an axis.
- io may include every layer; no layer may include io.
- Apps, bindings and examples may include only public headers and their own files. Tests and benchmarks may include
  internals.
- A layer may include exactly the layers that CMakeLists.txt links to it.
- Large integers are in src/exact. Sources of layers above it may include its headers.
- Public headers include only the standard library and Blum.
- One file starts threads (src/core/parallel.cpp). SIMD is in src/field/cpu and src/geometry/bvh/*_kernels.cpp.
  Compression is in src/io.
- field/cpu and field/cuda may not include each other. CUDA is in src/field/cuda.
- Only tests may include the header of debug_dump(); other files only temporarily, while they are debugged.
"""

import pathlib
import re
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
LOWER = {
    "core": set(),
    "exact": set(),
    "geometry": {"core", "exact"},
    "shapes": {"core", "geometry"},
    "grid": {"core"},
    "complex": {"core"},
    "solid": {"core", "geometry", "grid", "complex"},
    "field": {"core", "geometry", "grid"},
    "points": {"core", "geometry", "grid", "field"},
    "surface_map": {"core", "geometry", "grid", "field"},
    "axis": {"core", "geometry", "grid", "complex", "solid"},
    "medial_axis": {"core", "geometry", "grid", "complex", "solid", "field", "axis"},
    "proximity": {"core", "exact", "geometry", "grid", "complex", "solid"},
    "planning": {"core", "geometry"},
    "voronoi": {"core", "exact", "geometry", "grid", "complex", "solid"},
    "certificate": {"core", "complex"},
    "certified": {"core", "geometry", "grid", "complex", "solid", "field", "axis", "medial_axis", "certificate"},
}
LOWER["io"] = set(LOWER)
# Single headers of layers that a layer may not include otherwise. The certificate takes types of input and names from
# these headers, and has its own searches and predicates. It shares code for four facts. Self-intersections and the sign
# of a determinant are exact and tested against slow versions. The certificate itself checks the shells, crossings and
# inside of the resolved mesh. Files contain the numbers of sites.
SHARED = {
    "certificate": {
        "blum/geometry/orient3d.hpp",
        "blum/geometry/resolve_crossings.hpp",
        "blum/geometry/self_intersections.hpp",
        "blum/geometry/sites.hpp",
        "blum/geometry/triangle_mesh.hpp",
        "blum/grid/grid_spec.hpp",
        "blum/grid/voxel_set.hpp",
        "blum/solid/solid_rule.hpp",
    },
}

DEBUG_DUMP = "include/blum/core/debug_dump.hpp"

STANDARD = re.compile(r"[a-z_]+")  # for example <vector> and <stop_token>, without dot and slash
SYSTEM = re.compile(r"(sys/\w+|unistd|fcntl|linux/\w+|sched|dlfcn)\.h")  # only in sources
STARTS_THREADS = {"thread", "future", "execution", "pthread.h", "omp.h"}
INCLUDE = re.compile(r'^\s*#\s*include\s+(?:<([^>]+)>|"([^"]+)")')


def layer_of(path: pathlib.PurePosixPath) -> str:
    """The layer of include/blum/<layer>/... or src/<layer>/..."""
    return path.parts[2] if path.parts[0] == "include" else path.parts[1]


def third_party_rule(source: str, name: str) -> str | None:
    """The reason why a source under src/ may not include <name>, a header outside of Blum; None if it may."""
    if name in STARTS_THREADS or name.startswith("tbb/"):
        # context.cpp queries the number of cores.
        allowed = source == "src/core/parallel.cpp" or (source == "src/core/context.cpp" and name == "thread")
        return None if allowed else "only src/core/parallel.cpp starts threads"
    if name.startswith("hwy/"):
        allowed = source.startswith("src/field/cpu/") or re.fullmatch(r"src/geometry/bvh/\w+_kernels\.cpp", source)
        return None if allowed else "SIMD belongs in src/field/cpu and src/geometry/bvh/*_kernels.cpp"
    if name == "cuda_runtime.h" or name.startswith(("cub/", "thrust/")):
        return None if source.startswith("src/field/cuda/") else "CUDA belongs in src/field/cuda"
    if name in ("zlib.h", "png.h", "tiny_gltf.h", "nlohmann/json.hpp"):
        return None if source.startswith("src/io/") else "only src/io reads and writes compressed files"
    if name.startswith("ompl/"):
        return None if source == "src/planning/ompl_search.cpp" else "OMPL belongs in src/planning/ompl_search.cpp"
    if name.startswith("boost/multiprecision/"):
        return None if source.startswith("src/exact/") else "large integers belong in src/exact"
    if STANDARD.fullmatch(name) or SYSTEM.fullmatch(name):
        return None
    return "not a dependency of this layer"


def blum_rule(source: pathlib.PurePosixPath, target: pathlib.PurePosixPath) -> str | None:
    """The reason why `source` may not include the project's file `target`; None if it may."""
    top = source.parts[0]
    public = target.parts[0] == "include"
    if str(target) == DEBUG_DUMP and top != "tests" and str(source) != "src/core/debug_dump.cpp":
        return "debug_dump() is for debugging: take the call out (CONTRIBUTING.md, Debugging)"
    if top == "bench" and str(target) == "src/field/cpu/tile_kernel.hpp":
        return None  # for comparing the speed of instruction sets
    if top in ("apps", "examples", "python"):
        return None if public or target.parts[0] == top else f"{top} sees public headers only"
    if top in ("tests", "bench"):
        return None
    own = layer_of(source)
    other = layer_of(target)
    if not public and top == "include":
        return "a public header sees public headers only"
    if public and target.relative_to("include").as_posix() in SHARED.get(own, set()):
        return None
    if other != own and other not in LOWER.get(own, set()):
        return f"{own} does not see {other}"
    if not public and other != own and other != "exact":  # exact has no public headers; they would name Boost
        return f"internals of {other} are its own"
    back_ends = {source.parts[2:3], target.parts[2:3]}
    if top == "src" and back_ends == {("cpu",), ("cuda",)}:
        return "field/cpu and field/cuda do not see each other"
    return None


def resolve(source: pathlib.PurePosixPath, name: str) -> pathlib.PurePosixPath | None:
    """The project's file that `source` includes as `name`."""
    places = [source.parent / name, pathlib.PurePosixPath("include") / name, pathlib.PurePosixPath("src") / name]
    if source.parts[0] in ("tests", "bench"):
        places.append(pathlib.PurePosixPath(source.parts[0]) / name)
    if source.parts[0] == "apps":
        places.append(pathlib.PurePosixPath(*source.parts[:2]) / name)
    for place in places:
        if (PROJECT / place).is_file():
            return pathlib.PurePosixPath((PROJECT / place).resolve().relative_to(PROJECT).as_posix())
    return None


def check_line(source: pathlib.PurePosixPath, angled: str | None, quoted: str | None) -> str | None:
    name = angled or quoted or ""
    target = resolve(source, name) if quoted or name.startswith("blum/") else None
    if target is not None:
        return blum_rule(source, target)
    if name.startswith("blum/"):
        return "no such header"
    if source.parts[0] == "include":
        allowed = angled is not None and STANDARD.fullmatch(name) and name not in STARTS_THREADS
        return None if allowed else "a public header names nothing but the standard library and Blum"
    if source.parts[0] == "src":
        return third_party_rule(source.as_posix(), name)
    return None


def check_cmake() -> list[str]:
    """Differences of LOWER and the layers of CMakeLists.txt, where src/field/reference is a separate target."""
    linked: dict[str, set[str]] = {}
    text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
    for name, rest in re.findall(r"blum_add_layer\((\w+)([^)]*)\)", text):
        layer = name.removesuffix("_reference")
        below = {word for word in rest.split() if word != "DIR" and "/" not in word} - {layer}
        linked[layer] = linked.get(layer, set()) | below
    problems = [f"{layer}: in LOWER and in CMakeLists.txt not the same layers" for layer in linked.keys() ^ LOWER.keys()]
    for layer in linked.keys() & LOWER.keys():
        reached = set(linked[layer])
        while more := {lower for name in reached for lower in linked.get(name, set())} - reached:
            reached |= more
        for other in sorted(LOWER[layer] - reached):
            problems.append(f"{layer} may see {other}, which CMake does not link to it")
        shared = {name.split("/")[1] for name in SHARED.get(layer, set())}
        for other in sorted(linked[layer] - LOWER[layer] - shared):
            problems.append(f"CMake links {other} to {layer}, which may not see it")
    return problems


def check_shared() -> list[str]:
    """Headers in SHARED that do not exist."""
    names = sorted(name for headers in SHARED.values() for name in headers)
    return [f"SHARED names {name}, which does not exist" for name in names if not (PROJECT / "include" / name).is_file()]


def main() -> int:
    problems = check_cmake() + check_shared()
    print("".join(f"tools/check_includes.py: {problem}\n" for problem in problems), end="")
    broken = len(problems)
    files = 0
    for folder in ("include", "src", "apps", "examples", "python", "bench", "tests"):
        for path in sorted((PROJECT / folder).rglob("*")):
            if path.suffix not in (".hpp", ".cpp", ".h", ".cu", ".cuh"):
                continue
            files += 1
            source = pathlib.PurePosixPath(path.relative_to(PROJECT).as_posix())
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                reason = check_line(source, match[1], match[2]) if match else None
                if reason:
                    print(f"{source}:{number}: {match[1] or match[2]}: {reason}")
                    broken += 1
    print(f"check_includes: {files} files, {broken} includes that break a rule")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
