"""Proves that graphs of fitted patches are those of the smooth solids that fine meshes stand for.

Numbers, shapes, and counts of sheets, seams and junctions are known by hand. No solid here is made by Blum.
"""

import itertools
import json
from collections import Counter

import nonconvex_families as families
import numpy as np
import pytest
from exact_structure_families import Solid
from nonconvex_families import Profile, extruded
from scipy.spatial import ConvexHull
from test_package_patches import SQUARE, angle, counts, ring, traced

blum = pytest.importorskip("blum")


def revolved(profile, sides):
    """A solid of revolution about the z axis. The profile has points (radius, z), all off the axis."""
    turn = 2 * np.pi * (np.arange(sides) + 0.25) / sides
    vertices = np.concatenate([np.c_[r * np.cos(turn), r * np.sin(turn), 0 * turn + z] for r, z in profile])
    rings = np.arange(len(vertices)).reshape(len(profile), sides)
    faces = [[rings[0][::-1].tolist()], [rings[-1].tolist()]]
    for low, high in itertools.pairwise(rings):
        if vertices[low[0], 2] == vertices[high[0], 2]:  # a flat ring
            faces.append([low.tolist(), high[::-1].tolist()])
            continue
        faces += [[[low[k - 1], low[k], high[k], high[k - 1]]] for k in range(sides)]
    return families.from_polygons("revolved", vertices, faces)


def rounded_box(size, radius, pieces):
    """A box with round edges and corners. Each edge has twice as many strips as there are pieces."""
    most, number, vertices, triangles = 2 * pieces + 1, {}, [], []

    def vertex(*at):
        if at not in number:
            low = np.array(at) <= pieces
            middle = np.where(low, -1, 1) * (np.array(size) / 2 - radius)
            way = np.tan(np.pi / 4 * np.where(low, np.array(at) - pieces, np.array(at) - pieces - 1) / pieces)
            number[at] = len(vertices)
            vertices.append(middle + radius * way / np.linalg.norm(way))
        return number[at]

    for axis in range(3):
        for end in (0, most):
            for i in range(most):
                for j in range(most):
                    corners = [np.roll([end, i + u, j + v], axis) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
                    a, b, c, d = (vertex(*map(int, at)) for at in (corners if end else corners[::-1]))
                    triangles += [(a, b, c), (a, c, d)]
    return Solid("rounded box", np.array(vertices), np.array(triangles), 0.0)


def octant(pieces):
    """A block, and an eighth of a ball with radius 1 on its top. Its straight sides continue those of the block."""
    number, vertices = {}, []

    def vertex(*at):
        if at not in number:
            way = np.sin(np.pi / 2 * np.array(at) / pieces)
            number[at] = len(vertices)
            vertices.append(way / np.linalg.norm(way))
        return number[at]

    arc = lambda axis: [vertex(*np.roll([0, k, pieces - k], axis).tolist()) for k in range(pieces + 1)]  # noqa: E731
    faces = []
    for i in range(pieces):
        for j in range(pieces - i):
            k = pieces - i - j
            faces.append([[vertex(i, j, k), vertex(i + 1, j, k - 1), vertex(i, j + 1, k - 1)]])
            if k > 1:
                faces.append([[vertex(i + 1, j, k - 1), vertex(i + 1, j + 1, k - 2), vertex(i, j + 1, k - 1)]])
    low = {}
    for x, y, z in ((0, 0, -1), (2, 0, -1), (2, 2, -1), (0, 2, -1), (2, 0, 0), (2, 2, 0), (0, 2, 0)):
        low[x, y, z] = len(vertices)
        vertices.append(np.array([x, y, z], dtype=float))
    b0, b1, b2, b3, t1, t2, t3 = low.values()
    of_x, of_y, of_z = arc(0), arc(1), arc(2)  # in the planes x = 0, y = 0, z = 0
    faces += [
        [[b3, b2, b1, b0]],
        [[b1, b2, t2, t1]],
        [[b2, b3, t3, t2]],
        [[b0, b1, t1, *of_y]],
        [[b0, *of_x, t3, b3]],
        [[t1, t2, t3, *of_z]],
    ]
    return families.from_polygons("octant", np.array(vertices), faces)


def shapes(found, tolerance):
    """Patches of faces by kind, and all patches."""
    patches = found.patches(patch_fit=tolerance)
    assert all((each.shape is None) == (each.kind != "face") for each in patches)
    return Counter(each.shape.kind for each in patches if each.shape), patches


# Solids, their shapes, and the numbers of sheets, seams and junctions of the smooth solids.
SMOOTH = [
    # In a high cylinder, the side's region meets each cap's region in a cone. In a flat one, the caps meet in a disc.
    (extruded(Profile("cylinder, 64", [ring(64)]), 5.0), {"cylinder": 1, "plane": 2}, (2, 0, 0)),
    (extruded(Profile("cylinder, 256", [ring(256)]), 0.5), {"cylinder": 1, "plane": 2}, (3, 1, 0)),
    (revolved([(2, 0), (1, 8)], 64), {"cone": 1, "plane": 2}, (2, 0, 0)),
    (revolved([(2, 0), (1, 0.25)], 64), {"cone": 1, "plane": 2}, (3, 1, 0)),
    # A box has 13 sheets, 12 seams and 12 junctions. The hole adds two sheets and a closed seam.
    (extruded(Profile("hole", [SQUARE, ring(64, 1.0, (2, 2))[::-1]]), 0.25), {"cylinder": 1, "plane": 6}, (15, 13, 12)),
]


def tolerance_of(solid):
    """A tolerance above the rounding errors of the coordinates."""
    single = np.array_equal(solid.vertices, solid.vertices.astype(np.float32))
    size = np.ptp(solid.vertices, axis=0).max()
    return 1e-6 * size if single else 1e-9 * size + 4e-16 * np.abs(solid.vertices).max()


@pytest.mark.parametrize(("solid", "kinds", "expected"), SMOOTH, ids=lambda each: getattr(each, "name", None))
def test_graphs_are_those_of_the_smooth_solids(solid, kinds, expected):
    made, turned, *_, single, far, tiny = families.variants(solid)
    for moved in (made, turned, single, far, tiny):
        found = traced(moved)
        assert shapes(found, tolerance_of(moved))[0] == kinds, moved.name
        assert counts(found.graph(patch_fit=tolerance_of(moved))) == (sum(kinds.values()), *expected), moved.name


@pytest.mark.parametrize(("height", "expected"), [(0.25, (9, 22, 21, 21)), (8.0, (9, 25, 27, 24))])
def test_a_round_corner_is_one_cylinder_beside_its_planes(height, expected):
    """Bends alone join the arc with both tangent planes. Fitted patches separate them.

    The profile's diagram has eleven arcs, five nodes, and seven ends: five corners, and two points in which planes
    touch the arc. In the high solid, each of the seven sides has a wall with each cap, and arcs become 11 walls. Each
    arc has a seam at each cap, each node is a seam, and nodes and ends are junctions at each cap. In the low solid,
    there is one wall between the caps. Each end has a wall, three seams and three junctions. Reflex edges between the
    arc and its planes belong to the arc.
    """
    solid = extruded(angle(8), height)
    for moved in (solid, families.variants(solid)[1]):
        found = traced(moved)
        kinds, patches = shapes(found, 1e-9)
        assert kinds == {"plane": 8, "cylinder": 1}
        assert counts(found.graph(patch_fit=1e-9)) == expected
        (arc,) = (each.shape for each in patches if each.shape and each.shape.kind == "cylinder")
        assert arc.concave and arc.radius == pytest.approx(0.5, abs=1e-9)
        assert len(found.patches(30)) == 7


def test_a_rounded_box_has_the_walls_of_its_faces_edges_and_corners():
    """Patches are 6 planes, 12 cylinders and 8 spheres.

    13 walls are those of a box: between neighbouring faces, and in the middle. A cylinder's region meets those of its
    two planes and of the spheres at its ends: 48 walls. Strips are a little closer to the axis than the planes are. So
    the three cylinders of a corner meet in small walls, on the inner side of the sphere's centre: 24 walls. They vanish
    as strips become narrower.
    """
    small = []
    for pieces in (3, 4):
        solid = rounded_box((3, 2, 1.5), 0.3, pieces)
        for moved in (solid, families.variants(solid)[1])[: 5 - pieces]:
            found = traced(moved)
            kinds, patches = shapes(found, 1e-9)
            assert kinds == {"plane": 6, "cylinder": 12, "sphere": 8}
            assert all(each.shape.radius == pytest.approx(0.3) for each in patches if each.shape.kind != "plane")
            graph = found.graph(patch_fit=1e-9)
            walls = [sorted((patches[wall.site_a].shape.kind, patches[wall.site_b].shape.kind)) for wall in graph.walls]
            assert Counter(map(tuple, walls)) == {
                ("plane", "plane"): 13,
                ("cylinder", "plane"): 24,
                ("cylinder", "sphere"): 24,
                ("cylinder", "cylinder"): 24,
            }
            # Four inner junctions of the box. Five at each corner: one with three planes and three cylinders, one with
            # three cylinders and the sphere, and three vertices of the surface.
            assert len(graph.junctions) == 4 + 8 * 5
            # Four inner seams of the box, and one of each of the 12 cylinders with its planes. At each corner: one of
            # planes, and one of cylinders. Each of its three pairs of cylinders has one with the plane, and one with
            # the sphere.
            assert len(graph.seams) == 4 + 8 * (1 + 1 + 3 + 3) + 12
            small.append(sum(w.area for w, kinds in zip(graph.walls, walls, strict=True) if set(kinds) == {"cylinder"}))
            assert len(found.patches(30)) == 1 and len(found.graph(30).walls) == 0, "all bends are small"
    assert small[0] == pytest.approx(small[1]) and small[2] < 0.7 * small[0]


def test_steps_have_two_cylinders_and_the_circle_between():
    """The structure does not depend on the number of sides."""
    graphs = []
    for sides in (16, 32):
        found = traced(revolved([(2, 0), (2, 1), (0.75, 1), (0.75, 2.5)], sides))
        kinds, patches = shapes(found, 1e-9)
        assert kinds == {"plane": 3, "cylinder": 2}
        assert sorted(each.shape.radius for each in patches if each.shape and each.shape.kind == "cylinder") == [
            pytest.approx(0.75),
            pytest.approx(2),
        ]
        (circle,) = (each for each in patches if each.kind == "edge")
        assert len(circle.sites) == sides
        graphs.append(found.graph(patch_fit=1e-9))
    assert counts(graphs[0]) == counts(graphs[1])
    first, second = (Counter((wall.site_a, wall.site_b) for wall in graph.walls) for graph in graphs)
    assert first == second


def test_an_octant_on_a_block_is_one_sphere():
    for pieces in (5, 7):
        for moved in families.variants(octant(pieces)):
            mesh = blum.Mesh(moved.vertices, moved.triangles)
            found = blum.voronoi_complex(mesh, part="walls", method="cubes", resolution=2, max_cubes=1000)
            kinds, patches = shapes(found, tolerance_of(moved))
            assert kinds == {"plane": 6, "sphere": 1}, (moved.name, pieces)
            (ball,) = (each.shape for each in patches if each.shape and each.shape.kind == "sphere")
            scale = np.ptp(moved.vertices, axis=0).max() / np.ptp(octant(pieces).vertices, axis=0).max()
            assert ball.radius == pytest.approx(1, rel=1e-5) if 0.5 < scale < 2 else ball.radius > 0


def test_walls_inside_a_cylinder_are_left_out():
    """The walls along the cylinder's axis separate its strips. The complex keeps them; the graph does not."""
    found = traced(extruded(Profile("cylinder", [ring(64)]), 5.0))
    columns = found.with_patches(patch_fit=1e-9).triangle_columns
    inner = columns["patch_a"] == columns["patch_b"]
    assert inner.any() and not inner.all()
    kept = sum(wall.area for wall in found.graph(patch_fit=1e-9).walls)
    a, b, c = (found.vertices[found.triangles[~inner, k]] for k in range(3))
    assert kept == pytest.approx(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def test_medial_axes_have_sheets_of_fitted_patches():
    axis = traced(rounded_box((3, 2, 1.5), 0.3, 3), "medial").with_patches(patch_fit=1e-9).medial_axis(20)
    graph = axis.graph(of_patches=True, patch_fit=1e-9)
    kinds = [patch.shape.kind for patch in graph.patches]
    assert Counter(kinds) == {"plane": 6, "cylinder": 12, "sphere": 8}
    sheets = Counter(tuple(sorted(kinds[side] for side in sheet.sides)) for sheet in graph.sheets)
    assert sheets["plane", "plane"] == 13


def test_patches_of_axes_of_images_and_scans_are_fitted_too():
    mesh = blum.generate("cylinder", sides=64, height=3)
    graph = blum.medial_axis(mesh, resolution=24).graph(patch_fit=1e-6)
    assert Counter(patch.shape.kind for patch in graph.patches) == {"cylinder": 1, "plane": 2}
    assert all(patch.shape is None for patch in blum.medial_axis(mesh, resolution=24).graph().patches)


def test_files_name_shapes(tmp_path):
    found = traced(extruded(Profile("cylinder", [ring(48)]), 5.0), "all")
    found.write_graph(tmp_path / "graph.json", patch_fit=1e-9)
    *caps, first = json.loads((tmp_path / "graph.json").read_text())["patches"]
    assert first["shape"]["kind"] == "cylinder" and first["shape"]["radius"] == pytest.approx(1)
    assert 0 <= first["shape"]["deviation"] < 1e-12 and not first["shape"]["concave"]
    assert [cap["shape"]["kind"] for cap in caps] == ["plane", "plane"]
    found.write_graph(tmp_path / "graph.graphml", patch_fit=1e-9)
    assert (tmp_path / "graph.graphml").read_text().count("shape_kind") >= 3
    for bad in (0, -1, float("nan"), float("inf")):
        with pytest.raises(blum.InvalidOption, match="patch_fit"):
            found.graph(patch_fit=bad)


def test_scans_have_no_cylinders():
    """A ball with bumps, and a cylinder with noise above the tolerance, have only flat faces."""
    way = np.random.default_rng(7).normal(size=(400, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    bumps = 1 + 0.1 * np.sin(5 * way[:, 0]) * np.cos(4 * way[:, 1]) + 0.05 * np.sin(6 * way[:, 2])
    triangles = ConvexHull(way).simplices
    a, b, c = (way[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    mesh = blum.Mesh(way * bumps[:, None], triangles)
    found = blum.voronoi_complex(mesh, part="walls", method="cubes", resolution=2, max_cubes=1000)
    for tolerance in (1e-6, 1e-4):
        assert set(shapes(found, tolerance)[0]) == {"plane"}
