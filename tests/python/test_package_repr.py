"""Proves that results print in at most 20 lines and 2,000 characters, however large they are, with their numbers."""

import dataclasses
import inspect

import numpy as np
import pytest

blum = pytest.importorskip("blum")

BRACKET = blum.subdivided(blum.generate("bracket"), 1)
AWAY = np.eye(3), (9, 0, 0)
POINTS = np.random.default_rng(1).uniform(-1, 1, (999, 3))  # NumPy prints arrays of up to 1,000 entries in full.


def scene():
    made = blum.ProximityScene()
    bracket = blum.generate("bracket")
    for place in range(4):
        made.add((bracket.vertices + np.array([0.2 * place, 0, 0]), bracket.triangles))
    return made


def results():
    """Results of all functions, most of them large, by name."""
    axis = blum.medial_axis(BRACKET, resolution=48)
    piece = axis.certified(60, allow_uncertified=True)
    diagram = blum.voronoi_complex(blum.generate("bracket"), resolution=8)
    tubes, solid, moving = blum.generate("tube_image"), blum.Solid(BRACKET), scene()
    lines, graph, nested = blum.centreline(tubes), piece.graph(), axis.nested()
    query, pair = blum.ClosestPointQuery(BRACKET), (BRACKET, blum.generate("box"))
    corners = BRACKET.vertices[BRACKET.triangles[:500]]
    found = {
        "closest_points": blum.closest_points(BRACKET, POINTS),
        "signed_distance": blum.signed_distance(BRACKET, POINTS),
        "ClosestPointQuery": query,
        "ClosestPointQuery.within": query.within(POINTS, 1),
        "WindingNumber": blum.WindingNumber(BRACKET),
        "sample_surface": blum.sample_surface(BRACKET, 900),
        "sample_near": blum.sample_near(BRACKET, 900),
        "Mesh": BRACKET,
        "topology": blum.topology(BRACKET),
        "topology of shells": blum.topology(blum.generate("bodies")),
        "self_intersections": blum.self_intersections(blum.generate("soup")),
        "Sites": blum.Sites(BRACKET),
        "clean_mesh": blum.clean_mesh(BRACKET, 1e-4),
        "clean_mesh.report": blum.clean_mesh(BRACKET, 1e-4).report,
        "oriented_mesh": blum.oriented_mesh(BRACKET),
        "solid_rule": blum.solid_rule(BRACKET),
        "Solid": solid,
        "Solid.bodies": solid.bodies[0],
        "Solid.shells": solid.shells,
        "Solid.model": solid.model(resolution=8),
        "Solid.model.report": solid.model(resolution=8).report,
        "medial_axis": axis,
        "medial_axis.report": axis.report,
        "certified": piece,
        "certificate": piece.certificate,
        "certificate.medial": piece.certificate.medial,
        "graph": graph,
        "match_sheets": blum.match_sheets(piece, piece),
        "nested": nested,
        "nested.at": nested.at(60),
        "extend": piece.extend(),
        "extend.report": piece.extend().report,
        "voronoi_complex": diagram,
        "voronoi_complex.report": diagram.report,
        "voronoi_complex.graph": diagram.graph(),
        "voronoi_complex.sites": diagram.sites(),
        "voronoi_complex.patches": diagram.patches(),
        "voronoi_complex.patches with shapes": diagram.patches(patch_fit=1e-6),
        "voronoi_complex.regions": diagram.regions(),
        "centreline": lines,
        "centreline of a label": lines[0],
        "branch": lines[0].branches[0],
        "Image": tubes,
        "Image.labels": blum.Image(np.arange(1000).reshape(10, 10, 10)).labels(500),
        "distance_transforms": blum.distance_transforms(tubes, [1] * 30),
        "distance_field": blum.distance_field(BRACKET, resolution=16, order=2),
        "Grid": blum.Grid.around(BRACKET),
        "ProximityScene": moving,
        "separation": moving.separation(),
        "separation of a pair": moving.separation(0, 1),
        "closest_primitives": moving.closest_primitives(),
        "penetrations": moving.penetrations(),
        "least_translation": blum.least_translation(blum.generate("box"), blum.generate("box")),
        "certify_motion": blum.certify_motion(BRACKET, BRACKET, (np.eye(3), (9, 0, 0)), (np.eye(3), (0, 0, 0))),
        "MotionCertifier": blum.MotionCertifier(BRACKET, BRACKET),
        "MotionClearance": blum.MotionCertifier(BRACKET, BRACKET).clearance(AWAY, AWAY),
        "MotionContact": blum.MotionCertifier(BRACKET, BRACKET).first_contact(AWAY, (np.eye(3), (0, 0, 0))),
        "verify_path": blum.verify_path([AWAY, (np.eye(3), (0, 9, 0))], BRACKET, BRACKET),
        "CertifiedPath": blum.MotionCertifier(BRACKET, BRACKET).certify_path([AWAY, (np.eye(3), (0, 9, 0))]),
        "plan": blum.plan(BRACKET, BRACKET, (np.eye(3), (9, 0, 0)), (np.eye(3), (0, 9, 0)), planner="sliding"),
        "continuous": moving.continuous({0: blum.generate("bracket").vertices + 1}),
        "continuous_collisions": blum.continuous_collisions(BRACKET, BRACKET.vertices + 1),
        "first_contact": blum.first_contact(BRACKET, BRACKET.vertices * [1, 1, -1]),
        "triangle_distances": blum.triangle_distances(corners, corners),
        "close_features": blum.close_features(BRACKET, 0.01),
        "surface_distance_map": blum.surface_distance_map(*pair, texel=0.1),
        "statistics": blum.surface_distance_map(*pair, texel=0.1).statistics(),
        "thickness": blum.thickness(BRACKET),
        "hausdorff_distance": blum.hausdorff_distance(*pair),
        "surface_deviation": blum.surface_deviation(*pair, pieces=1000),
        "shapes": blum.shapes(),
        "file_formats": blum.file_formats(),
        "cuda_devices": blum.cuda_devices(),
        "voxel_topology": blum.voxel_topology(tubes.values),
        "ball_union_field": blum.ball_union_field([[0, 0, 0]], [1], blum.Grid((0, 0, 0), 1, (3, 3, 3))),
    }
    parts = {kind: getattr(graph, kind) for kind in ("sheets", "seams", "curves", "junctions", "patches")}
    return found | {f"graph.{kind}": parts[kind][0] for kind in parts if parts[kind]}


@pytest.fixture(scope="module")
def made():
    return results()


def test_results_print_in_few_lines(made):
    long = {name: len(repr(result)) for name, result in made.items() if len(repr(result)) > 2000}
    assert not long
    assert all(repr(result).count("\n") < 20 and str(result).count("\n") < 20 for result in made.values())
    assert all(" object at 0x" not in repr(result) for result in made.values())


def test_every_result_type_is_printed(made):
    """Each public dataclass is a type of the results above or of their parts, or states its members itself."""

    def types_in(value, depth=0):
        if dataclasses.is_dataclass(value):
            parts = [getattr(value, field.name) for field in dataclasses.fields(value)]
        else:
            parts = list(value)[:3] if isinstance(value, (tuple, list)) else []
        return {type(value)}.union(*(types_in(part, depth + 1) for part in parts if depth < 6))

    printed = set().union(*map(types_in, made.values()))
    public = {getattr(blum, name) for name in blum.__all__}
    left = {kind for kind in public if inspect.isclass(kind) and dataclasses.is_dataclass(kind)} - printed
    assert {kind.__name__ for kind in left} <= {
        "ComplexFile",
        "CrossingCounts",
        "DeviceInfo",
        "FailingVoronoiCell",
        "ModelFailure",
        "OpenVoronoiPlace",
        "ResultWarning",
        "ShapeInfo",
        "ShapeParameter",
    }


def test_small_values_are_shown_in_full():
    found = blum.separation(blum.generate("box"), blum.Mesh([[0, 0, 2.5]]))
    assert repr(found).startswith(f"PrimitivePair(object=(0, 1), primitive={found.primitive}, distance=2.0, ")
    assert "closest=[[0.0, 0.0, 0.5], [0.0, 0.0, 2.5]]" in repr(found)
    one = blum.closest_points(blum.generate("box"), [0, 0, 3])
    assert "closest=[0.0, 0.0, 0.5], distance=2.5" in repr(one)
    many = blum.closest_points(blum.generate("box"), POINTS)
    assert "closest=float64 (999, 3), distance=float64 (999,)" in repr(many)


def test_lists_are_lists_and_show_how_many_entries_are_left():
    every = blum.file_formats()
    assert isinstance(every, list) and every == list(every) and every[0].name == "OBJ"
    shown = repr(every)
    left = int(shown.rsplit("... ", 1)[1].removesuffix(" more]"))
    assert shown.count("FileFormat(") + left == len(every)
    shapes = blum.shapes()
    assert isinstance(shapes, dict) and shapes == dict(shapes) and repr(shapes).endswith(" more}")
