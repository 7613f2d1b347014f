"""Proves that graphs of patches are those of the smooth solids that fine meshes stand for.

Counts of smooth prisms are known by hand. Pairs and areas of prisms over any profile follow from the exact diagram of
the profile, which uses no Blum.
"""

import itertools
import json
import warnings
from collections import Counter

import nonconvex_families as families
import numpy as np
import pytest
from nonconvex_families import Profile, extruded
from profile_diagrams import Diagram, prism

blum = pytest.importorskip("blum")


def ring(sides, radius=1.0, at=(0.0, 0.0)):
    turn = 2 * np.pi * (np.arange(sides) + 0.25) / sides
    return np.c_[at[0] + radius * np.cos(turn), at[1] + radius * np.sin(turn)].tolist()


def arc(x, y, radius, first, last, pieces):
    turn = np.linspace(first, last, pieces + 1)
    return np.c_[x + radius * np.cos(turn), y + radius * np.sin(turn)].tolist()


def rounded(width, depth, radius, pieces):
    """A rectangle with round corners."""
    places = ((width - radius, radius), (width - radius, depth - radius), (radius, depth - radius), (radius, radius))
    corners = (arc(x, y, radius, (k - 1) * np.pi / 2, k * np.pi / 2, pieces) for k, (x, y) in enumerate(places))
    return Profile("rounded", [list(itertools.chain(*corners))])


def angle(pieces):
    """An L with a round inner corner."""
    corner = arc(1.5, 1.5, 0.5, -np.pi / 2, -np.pi, pieces)
    return Profile("L", [[(0, 0), (4, 0), (4, 1), *corner, (1, 3.5), (0, 3.5)]])


SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
# Profiles, heights, and the numbers of patches, sheets, seams and junctions of the smooth solids.
SMOOTH = [
    (Profile("prism, 16", [ring(16)]), 5.0, (3, 2, 0, 0)),
    (Profile("prism, 200", [ring(200)]), 5.0, (3, 2, 0, 0)),
    (Profile("prism, 200", [ring(200)]), 0.5, (3, 3, 1, 0)),
    (rounded(4, 3, 0.5, 8), 0.4, (3, 3, 1, 0)),
    (rounded(4, 3, 0.5, 8), 8.0, (3, 2, 0, 0)),
    # Five sides: those of the inner corner are one. Ten sheets at the caps, five at corners, and one between the caps.
    (angle(8), 0.25, (7, 16, 15, 15)),
    # The profile's diagram has seven arcs and three nodes. Ten sheets and 14 seams lie at the caps.
    (angle(8), 8.0, (7, 17, 17, 16)),
    # A box has 13 sheets, 12 seams and 12 junctions. The hole adds two sheets and a closed seam.
    (Profile("hole", [SQUARE, ring(64, 1.0, (2, 2))[::-1]]), 0.25, (7, 15, 13, 12)),
    (Profile("tube", [ring(32), ring(32, 0.5)[::-1]]), 2.0, (4, 5, 2, 0)),
    (Profile("tube", [ring(64), ring(64, 0.5)[::-1]]), 0.2, (4, 5, 2, 0)),
]


def traced(solid, part="walls", **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mesh = blum.Mesh(solid.vertices, solid.triangles)
        found = blum.voronoi_complex(mesh, part=part, method="traced", **options)
    assert found.report.traced or found.report.exact, found.report.trace_problem
    return found


def counts(graph):
    return len(graph.patches), len(graph.walls), len(graph.seams), len(graph.junctions)


@pytest.mark.parametrize(("profile", "height", "expected"), SMOOTH, ids=lambda each: getattr(each, "name", None))
def test_counts_are_those_of_the_smooth_solid(profile, height, expected):
    solid = extruded(profile, height)
    for part in ("all", "walls"):
        assert counts(traced(solid, part).graph(patch_angle=30)) == expected, part
    made, turned, *_, single, far, tiny = families.variants(solid)
    assert made is solid
    for moved in (turned, single, far, tiny):
        assert counts(traced(moved).graph(patch_angle=30)) == expected, moved.name


def sizes(found):
    a, b, c = (found.vertices[found.triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def stepped(profile):
    """The profile with corners at multiples of 1/1024, so symmetric distances are equal, or clearly not."""
    return Profile(profile.name, [(np.round(np.array(loop) * 1024) / 1024).tolist() for loop in profile.loops])


PROFILES = [
    stepped(profile)
    for profile in (angle(4), rounded(3, 2, 0.5, 3), Profile("hole", [SQUARE, ring(6, 1.0, (2, 2))[::-1]]))
]


@pytest.mark.parametrize("profile", PROFILES, ids=lambda each: each.name)
@pytest.mark.parametrize("height", [6.0, 0.5])
def test_walls_of_patches_have_the_areas_of_the_exact_diagram(profile, height):
    """Areas of the exact diagram of sites, added up by the patches that bends of the profile's corners determine."""
    solid, exact = extruded(profile, height), prism(Diagram(profile.loops), height)
    found = traced(solid, resolution=32)
    graph, chord = found.graph(patch_angle=61), found.report.chord
    patch = {site: k for k, each in enumerate(graph.patches) for site in each.sites}
    truth = Counter()
    for pair, area in exact.areas.items():
        a, b = sorted(patch[site] for site in pair)
        if a != b:
            truth[a, b] += float(area)
    areas = Counter()
    for wall in graph.walls:
        areas[wall.site_a, wall.site_b] += wall.area
    assert set(areas) == set(truth)
    for pair, area in truth.items():
        assert areas[pair] == pytest.approx(area, abs=1e-9 + 6 * chord * area**0.5), pair
    columns = found.with_patches(61).triangle_columns
    for (a, b), area in areas.items():
        own = (columns["patch_a"] == a) & (columns["patch_b"] == b)
        assert sizes(found)[own].sum() == pytest.approx(area), (a, b)
    kept = sum(areas.values())
    inner = sizes(found)[columns["patch_a"] == columns["patch_b"]].sum()
    assert inner > 0
    assert kept + inner == pytest.approx(sizes(found).sum())


def boss(sides):
    """A plate, and a cylinder that stands on it."""
    low, top = ring(sides, 0.5, (2, 2)), 8
    square = [(x, y, z) for z in (0, 1) for x, y in SQUARE]
    foot = [(x, y, 1) for x, y in low]
    head = [(x, y, 1.5) for x, y in low]
    first, last = list(range(top, top + sides)), list(range(top + sides, top + 2 * sides))
    walls = [[[k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4]] for k in range(4)]
    sides_of = [[[first[k], first[(k + 1) % sides], last[(k + 1) % sides], last[k]]] for k in range(sides)]
    faces = [[[3, 2, 1, 0]], [[4, 5, 6, 7], first[::-1]], [last], *walls, *sides_of]
    return families.from_polygons("boss", square + foot + head, faces)


def test_reflex_edges_between_patches_are_patches():
    """All edges of the circle at the cylinder's foot are one patch. The structure does not depend on their number."""
    graphs = []
    for sides in (12, 24):
        found = traced(boss(sides))
        kinds = Counter(each.kind for each in found.patches())
        assert kinds == {"face": 8, "edge": 1}
        (circle,) = (each for each in found.patches() if each.kind == "edge")
        assert len(circle.sites) == sides
        graphs.append(found.graph(patch_angle=30))
    assert counts(graphs[0]) == counts(graphs[1])
    first, second = (Counter((wall.site_a, wall.site_b) for wall in graph.walls) for graph in graphs)
    assert first == second
    assert max(first.values()) == 1


@pytest.mark.parametrize(("profile", "height", "expected"), [SMOOTH[0], SMOOTH[3], SMOOTH[5]])
def test_medial_axes_have_sheets_of_patches(profile, height, expected):
    solid = extruded(profile, height)
    axis = traced(solid, "medial").with_patches().medial_axis(1)
    graph = axis.graph(of_patches=True)
    assert (len(graph.sheets), len(graph.seams), len(graph.junctions), len(graph.curves)) == (*expected[1:], 0)
    columns = axis.triangle_columns
    for sheet in graph.sheets:
        own = columns["patch_sheet"] == sheet.sheet
        assert own.sum() == sheet.triangles
        assert set(zip(columns["patch_a"][own].tolist(), columns["patch_b"][own].tolist(), strict=True)) == {
            tuple(sheet.sides)
        }
        assert sizes(axis)[own].sum() == pytest.approx(sheet.area)
    assert ((columns["patch_sheet"] < 0) == (columns["patch_a"] == columns["patch_b"])).all()


def test_files_and_networks_name_patches(tmp_path):
    found = traced(extruded(*SMOOTH[2][:2]), "all")
    found.write_graph(tmp_path / "graph.json", patch_angle=30)
    graph = json.loads((tmp_path / "graph.json").read_text())
    assert [patch["kind"] for patch in graph["patches"]] == ["face"] * 3
    assert [len(region["neighbours"]) for region in graph["regions"]] == [2, 2, 2]
    assert len(graph["sites"]) == len(found.sites())
    network = found.graph(30).to_networkx(found.sites())
    assert [node for node in network if node.startswith("region")] == ["region0", "region1", "region2"]
    found.write_graph(tmp_path / "graph.graphml", patch_angle=30)
    assert (tmp_path / "graph.graphml").read_text().count('<node id="region') == 3
    assert len(found.graph().patches) == 0
    for angle_ in (-1, 181, float("nan")):
        with pytest.raises(blum.InvalidOption, match="patch_angle"):
            found.graph(angle_)
    with pytest.raises(blum.InvalidOption, match="patch_a"):
        traced(extruded(*SMOOTH[0][:2]), "medial").medial_axis(1).graph(of_patches=True)
