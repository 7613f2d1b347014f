#!/usr/bin/env python3
"""Turns the JSON of `make bench` into docs/generated/performance.md and plots in docs/pictures.

    tools/bench_report.py [FOLDER]      FOLDER holds *.json (default out/bench)

Ratios compare CPU seconds of the whole process, which barely depend on other load, and wall-clock seconds.
Cases that did not run, or lack an installed peer, appear with that reason.
"""

import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


class Results:
    """Benchmarks by name, without Google Benchmark's suffixes."""

    def __init__(self, folder):
        self.cases, self.contexts = {}, []
        self.images = None
        self.skeletons = {}  # by shape
        for file in sorted(folder.glob("*.json")):
            content = json.loads(file.read_text())
            if file.name.startswith("skeleton_peers"):
                self.skeletons[content["shape"]] = content
                continue
            if "benchmarks" not in content:
                self.images = content
                continue
            self.contexts.append(content["context"])
            for case in content["benchmarks"]:
                self.cases[case["name"].removesuffix("/iterations:1/manual_time")] = case

    def get(self, name):
        """The case, or the reason for its absence."""
        case = self.cases.get(name)
        if case is None:
            return "not run"
        return case["error_message"] if case.get("error_occurred") else case


def seconds(value):
    return f"{value * 1000:.3g} ms" if value < 1 else f"{value:.3g} s"


def both(case):
    text = f"{seconds(case['cpu_s'])} CPU, {seconds(case['wall_s'])} wall"
    return text if case.get("fraction", 1) > 0.99 else f"{text} (scaled from {100 * case['fraction']:.2g} % of nodes)"


def ratio_row(title, ours, peer, must, aim):
    if isinstance(ours, str) or isinstance(peer, str):
        return [title, ours if isinstance(ours, str) else both(ours), peer if isinstance(peer, str) else both(peer),
                "-", "-", must, aim]
    cpu, wall = peer["cpu_s"] / ours["cpu_s"], peer["wall_s"] / ours["wall_s"]
    return [title, both(ours), both(peer), f"{cpu:.3g}x", f"{wall:.3g}x", must, aim]


def extra_row(title, case, must, aim):
    if isinstance(case, str):
        return [title, case, "-", "-", "-", must, aim]
    cpu, wall = (case[f"{kind}_s"] / case[f"unsigned_{kind}_s"] - 1 for kind in ("cpu", "wall"))
    unsigned = {"cpu_s": case["unsigned_cpu_s"], "wall_s": case["unsigned_wall_s"]}
    return [title, both(case), f"unsigned: {both(unsigned)}", f"{100 * cpu:+.0f} %", f"{100 * wall:+.0f} %", must, aim]


def threads_row(results, name):
    title, case = f"two threads versus one, {name} 256^3, build included", results.get(f"threads/{name}/256/blum")
    if isinstance(case, str):
        return [title, case, "-", "-", "-", "1.7x", "1.9x"]
    one = {"cpu_s": case["one_cpu_s"], "wall_s": case["one_wall_s"]}
    speedup = f"{one['wall_s'] / case['wall_s']:.2f}x"
    cores = case["cpu_s"] / case["wall_s"]
    if cores < 1.5:  # other work took the second core, so the ratio is meaningless
        speedup = f"no result: the two threads got {cores:.2f} cores ({speedup})"
    return [title, both(case), f"one thread: {both(one)}", f"{one['cpu_s'] / case['cpu_s']:.2f}x (1.00x: no CPU lost)",
            speedup, "1.7x", "1.9x"]


def simd_row(results, name):
    title, case = f"AVX2 path versus the best path, {name} 256^3", results.get(f"simd/{name}/256/AVX2")
    if isinstance(case, str):
        return [title, case, "-", "-", "-", "reported", "0.6x"]
    best = {"cpu_s": case["best_cpu_s"], "wall_s": case["best_wall_s"]}
    return [title, both(case), f"best path: {both(best)}", f"{best['cpu_s'] / case['cpu_s']:.2f}x",
            f"{best['wall_s'] / case['wall_s']:.2f}x", "reported", "0.6x"]


def winding_row(results, n):
    """The extra time of winding signs, compared with one query per node (with its hierarchy)."""
    title = f"sign `winding`, bunny (open) {n}^3, versus one fast winding number query per node"
    case, peer = results.get(f"sign-winding/bunny/{n}/blum"), results.get(f"sign-winding/bunny/{n}/query-per-node")
    if not isinstance(case, str):
        case = dict(case)
        for kind in ("cpu_s", "wall_s"):
            case[kind] = max(case[kind] - case[f"unsigned_{kind}"], 1e-6)
    return ratio_row(title + ", sign alone", case, peer, "reported", "10x")


def image_row(results):
    title = "image 512^3 (shell), distance + feature, versus SciPy with indices"
    images = results.images
    ours = results.get("transform/side:512/shape:0/signed:0/threads:0/anisotropic:0/process_time/real_time")
    if images is None or "scipy with indices" not in images["programs"]:
        return [title, "-", "not run", "-", "-", "10x", "30x"]
    blum, scipy = images["programs"]["blum unsigned"], images["programs"]["scipy with indices"]
    cpu = None if isinstance(ours, str) else ours["cpu_time"] / 1000
    blum_text = f"{seconds(blum['seconds'])} wall"
    if cpu:  # image_peers.py does not report Blum's CPU seconds
        blum_text += f"; {seconds(cpu)} CPU in another program and run (distance_transform_bench)"
    scipy_text = f"{seconds(scipy['cpu_seconds'])} CPU, {seconds(scipy['seconds'])} wall, one thread"
    return [title, blum_text, scipy_text, f"{scipy['cpu_seconds'] / cpu:.3g}x" if cpu else "-",
            f"{scipy['seconds'] / blum['seconds']:.3g}x", "10x", "30x"]


def edt_row(results):
    title = "image 512^3 (shell), versus edt (squared distances, no feature)"
    programs = results.images["programs"] if results.images else {}
    if "edt, no indices" not in programs:
        return [title, "-", "not run", "-", "-", "-", "-"]
    blum, peer = programs["blum unsigned"], programs["edt, no indices"]
    return [title, f"{seconds(blum['seconds'])} wall", f"{seconds(peer['cpu_seconds'])} CPU, "
            f"{seconds(peer['seconds'])} wall", "-", f"{peer['seconds'] / blum['seconds']:.3g}x", "-", "-"]


def skeleton_rows(results):
    rows = []
    for shape, must, aim in (("bumpy", "2x", "10x"), ("organs", "-", "-"), ("pores", "-", "-")):
        report = results.skeletons.get(shape)
        if report is None:
            continue
        programs = report["programs"]
        ours = programs["blum"]
        share = 100 * report["selected"] / report["side"] ** 3
        for peer in ("scikit-image", "kimimaro", "itk"):
            title = f"medial axis, image {report['side']}^3 ({shape}, {share:.0f} % solid), versus {peer}"
            if peer not in programs:
                if shape == "bumpy":  # the other shapes have only one peer
                    rows.append([title, "-", "not run", "-", "-", must, aim])
                continue
            theirs = programs[peer]
            rows.append([title, f"{seconds(ours['seconds'])} wall (certificate {seconds(ours['certificate_seconds'])} more)",
                         f"{seconds(theirs['cpu_seconds'])} CPU, {seconds(theirs['seconds'])} wall", "-",
                         f"{theirs['seconds'] / ours['seconds']:.3g}x", must, aim])
    return rows


def medial_rows(results):
    """Goals of medial axes without a peer."""
    rows = [plain_row("medial axis, rocker-arm at 256, with its certificate", results.get("medial/rocker-arm/256"),
                      "wall_s", "s", "10 s", "2 s")]
    least, most = results.get("medial-image/64"), results.get("medial-image/640")
    title = "medial axis, image 64^3 to 640^3, time per solid voxel: largest over smallest side"
    if isinstance(least, str) or isinstance(most, str):
        rows.append([title, "not run", "-", "-", "-", "1.3", "-"])
    else:
        rows.append([title, f"{most['ns_per_solid_voxel'] / least['ns_per_solid_voxel']:.2f} "
                     f"({least['ns_per_solid_voxel']:.0f} ns, {most['ns_per_solid_voxel']:.0f} ns)", "-", "-", "-", "1.3", "-"])
    rows.append(plain_row("medial axis, image 512^3, peak memory beyond the image", results.get("medial-image/512"),
                          "peak_MiB_beyond_image", "MiB", "6 GiB", "3 GiB"))
    return rows


def medial_cases(results):
    """Seconds of every phase, one row for each case."""
    cases = {name: case for name, case in results.cases.items() if name.startswith("medial") and "wall_s" in case}
    phases = dict.fromkeys(key.removeprefix("phase ") for case in cases.values() for key in case if key.startswith("phase "))
    rows = [[name.removeprefix("medial/").removeprefix("medial-"), seconds(case["wall_s"]),
             *(seconds(case[f"phase {phase}"]) if f"phase {phase}" in case else "" for phase in phases)]
            for name, case in cases.items()]
    return [["case", "whole", *phases], *rows]


def plain_row(title, case, key, unit, must, aim, note=""):
    value = case if isinstance(case, str) else f"{case[key]:.3g} {unit}"
    return [title, value, note, "-", "-", must, aim]


def frame_row(results, kind, label):
    case = results.get(f"frame/organic-2000/128/{kind}")
    title = f"deforming mesh of 2,000 triangles at 128^3, whole frame{label}"
    if isinstance(case, str):
        return [title, case, "-", "-", "-", "reported", "60 frames/s"]
    return [title, both(case), "-", f"{case['frames_per_s_by_cpu']:.0f} frames/s were both cores free",
            f"{case['frames_per_s']:.0f} frames/s", "reported", "60 frames/s"]


def field_row(results, title, name, n, must="-", aim="-", peer="embree"):
    label = {"embree": "Embree", "cgal": "CGAL"}[peer]
    return ratio_row(f"{title}, versus {label}", results.get(f"field/{name}/{n}/blum"),
                     results.get(f"field/{name}/{n}/{peer}"), must, aim)


def goals(results):
    rows = [
        field_row(results, "bunny 256^3, distance + site", "bunny", 256, "120x", "250x"),
        field_row(results, "bunny 128^3", "bunny", 128, "40x", "90x"),
        field_row(results, "fandisk 256^3", "fandisk", 256, "80x", "150x"),
        field_row(results, "1.6 M triangles 256^3", "noisy-1.6M", 256, "30x", "80x"),
        threads_row(results, "bunny"),
        simd_row(results, "bunny"),
        simd_row(results, "fandisk"),
    ]
    for name in ("organic", "fandisk"):
        rows.append(extra_row(f"sign `normals`, {name} (closed) 256^3, extra time",
                              results.get(f"sign-normals/{name}/256/blum"), "10 %", "5 %"))
        rows.append(extra_row(f"sign `winding`, {name} (closed) 256^3, extra time",
                              results.get(f"sign-winding/{name}/256/blum"), "50 %", "20 %"))
    rows.append(winding_row(results, 256))
    for name in ("bunny", "fandisk", "organic"):
        rows.append(ratio_row(f"band of +-3 voxels, {name} 512^3, unsigned, versus OpenVDB",
                              results.get(f"band/{name}/512/blum"), results.get(f"band/{name}/512/openvdb"),
                              "2x", "5x"))
        if name != "bunny":
            rows.append(ratio_row(f"the same, signed, {name}", results.get(f"signed-band/{name}/512/blum"),
                                  results.get(f"signed-band/{name}/512/openvdb"), "2x", "5x"))
    rows += [frame_row(results, "blum", ""), frame_row(results, "blum-signed", ", signed"),
             image_row(results), edt_row(results)]
    rows += skeleton_rows(results) + medial_rows(results)
    for name in ("bunny/field", "bunny/field-winding", "noisy-1.6M/field", "noisy-1.6M/field-winding",
                 "noisy-1.6M/closest-points", "image/512"):
        case = results.get(f"cancel/{name}")
        rows.append(plain_row(f"longest wait after cancelling, {name}", case, "worst_latency_ms", "ms", "200 ms", "-"))
    for name, mode in (("bunny", "none"), ("bunny", "winding"), ("noisy-1.6M", "none"), ("noisy-1.6M", "winding"),
                       ("image", "shell")):
        case = results.get(f"memory/{name}/512/{mode}")
        rows.append(plain_row(f"peak memory beyond the outputs, {name} 512^3, {mode}", case, "extra_MiB", "MiB",
                              "1 GiB", "256 MiB"))
    return rows


def all_fields(results):
    rows = []
    for name in ("bunny", "fandisk", "noisy-1.6M"):
        for n in (64, 128, 256, 512):
            for who in ("blum", "embree", "cgal"):
                case = results.get(f"field/{name}/{n}/{who}")
                if case == "not run":
                    continue
                if isinstance(case, str):
                    rows.append([name, f"{n}^3", who, case, "", "", "", ""])
                    continue
                build = case.get("phase build", case.get("phase sites and hierarchy", 0))
                rows.append([name, f"{n}^3", who, seconds(case["cpu_s"]), seconds(case["wall_s"]),
                             f"{case['Mvoxel_per_core_s']:.3g}", seconds(build), f"{case['load']:.1f}"])
    return rows


def series(results, prefix, suffix, x_of):
    points = []
    for name, case in results.cases.items():
        if name.startswith(prefix) and name.endswith(suffix) and "cpu_s" in case:
            points.append((x_of(case), case))
    return sorted(points, key=lambda point: point[0])


def scaling(results, points):
    rows = []
    for x, case in points:
        floor = floor_cpu(results, case["nodes"])
        rows.append([f"{x:,.0f}", f"{round(case['nodes'] ** (1 / 3))}^3", seconds(case["cpu_s"]),
                     seconds(case["wall_s"]), f"{case['Mvoxel_per_core_s']:.3g}",
                     f"{case['cpu_s'] / floor:.3g}x" if floor else "-"])
    return rows


def floor_cpu(results, nodes):
    """CPU seconds to write 8 bytes for each node to new memory, at the rate measured at 512^3."""
    case = results.get("floor/new-memory/512/write")
    return None if isinstance(case, str) else case["cpu_s"] * nodes / case["nodes"]


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def plot(results, path, title, label, curves):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), dpi=120)
    drawn = False
    for name, points, nodes_of in curves:
        if not points:
            continue
        drawn = True
        x = [point[0] for point in points]
        line = axes.loglog(x, [point[1]["cpu_s"] for point in points], "o-", label=name)[0]
        floors = [floor_cpu(results, nodes_of(point[1])) for point in points]
        if all(floors):
            axes.loglog(x, floors, ":", color=line.get_color(), label=f"floor of {name}: write 8 bytes a node")
    if not drawn:
        pyplot.close(figure)
        return
    axes.set(title=title, xlabel=label, ylabel="CPU seconds, build included")
    axes.grid(True, which="both", alpha=0.2)
    axes.legend(fontsize=7)
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    pyplot.close(figure)


def machine(results):
    context = results.contexts[0] if results.contexts else {}
    loads = [case["load"] for case in results.cases.values() if "load" in case]
    model = next((line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), "unknown processor")
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    load = f"load average {min(loads):.1f} to {max(loads):.1f}" if loads else "load unknown"
    dates = sorted(context["date"][:16] for context in results.contexts if "date" in context)
    when = " to ".join(dict.fromkeys([dates[0], dates[-1]])) if dates else "date unknown"
    return (f"{when}, {model}, {context.get('num_cpus', os.cpu_count())} cores, "
            f"{load} before the cases; reported at commit {commit.stdout.strip() or 'unknown'}.")


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "out/bench"
    results = Results(folder)
    if not results.cases:
        sys.exit(f"bench_report: no figures in {folder}; run make bench first")
    nodes = {name: series(results, f"nodes/{name}/", "/blum", lambda c: c["nodes"]) for name in ("bunny", "fandisk")}
    triangles = {n: series(results, "triangles/", f"/{n}/blum", lambda c: c["triangles"]) for n in (128, 256)}
    pictures = ROOT / "docs/pictures"
    plot(results, pictures / "performance-nodes.png", "Distance and closest site: time against nodes", "nodes",
         [(name, points, lambda case: case["nodes"]) for name, points in nodes.items()])
    plot(results, pictures / "performance-triangles.png", "Distance and closest site: time against triangles",
         "triangles", [(f"{n}^3", points, lambda case: case["nodes"]) for n, points in triangles.items()])

    scaled = ["", "grid", "CPU", "wall", "Mvoxel per core-second", "CPU over the floor"]
    parts = [
        "# Measured figures\n\nWritten by tools/bench_report.py; do not edit. `make bench` measures anew.\n",
        machine(results) + "\n",
        "Medians of several runs; one run above 20 s. CPU seconds are those of the whole process. Building sites and "
        "hierarchies counts on both sides. Where other work shares the machine, wall-clock seconds are inflated, and "
        "ratios on CPU seconds are the ones to read.\n",
        "## Goals\n", table(["case", "Blum", "peer", "ratio, CPU", "ratio, wall", "must", "aim"], goals(results)),
        "## Distance and closest site\n",
        table(["mesh", "grid", "program", "CPU", "wall", "Mvoxel per core-second", "build, wall", "load"],
              all_fields(results)),
        "## Time against nodes\n\nThe floor is what it takes to write 8 bytes a node to new memory.\n",
    ]
    for name, points in nodes.items():
        parts += [f"{name}:\n", table(["nodes", *scaled[1:]], scaling(results, points))]
    parts += ["![Time against nodes](../pictures/performance-nodes.png)\n", "## Time against triangles\n"]
    for n, points in triangles.items():
        parts += [f"{n}^3:\n", table(["triangles", *scaled[1:]], scaling(results, points))]
    parts += ["![Time against triangles](../pictures/performance-triangles.png)\n"]
    header, *rows = medial_cases(results)
    if rows:
        parts += ["## Medial axes, by phase\n\nWall-clock; meshes with their certificate, images without.\n", table(header, rows)]
    target = ROOT / "docs/generated/performance.md"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("\n".join(parts))
    wrong = [name for name, case in results.cases.items() if str(case.get("error_message", "")).startswith("WRONG")]
    for name in wrong:
        print(f"bench_report: {name}: {results.cases[name]['error_message']}", file=sys.stderr)
    print(f"bench_report: wrote {target.relative_to(ROOT)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
