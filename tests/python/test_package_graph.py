"""Proves that graphs of medial axes hold every sheet, seam, curve and junction once, and answer an engineer's question.

networkx reads the same graph from files as to_networkx() returns."""

import json
import pathlib
import pickle
import re
import sys

import numpy as np
import pytest
from content import content_of

blum = pytest.importorskip("blum")

SEAM, CURVE, JUNCTION = (blum.ROLES.index(name) for name in ("seam", "curve", "junction"))


def pairs(vertices):
    """The edges of a chain, each with its smaller end first."""
    return [tuple(sorted(pair)) for pair in zip(vertices.tolist(), vertices.tolist()[1:], strict=False)]


def check_whole(axis, graph):
    """Checks the facts that hold for every axis and its graph."""
    corners = axis.vertices[axis.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert np.isclose(graph.area, areas.sum(), rtol=1e-12)
    for_homotopy = axis.triangle_angle <= axis.theta
    assert np.isclose(graph.homotopy_area, areas[for_homotopy].sum(), rtol=1e-12)
    curves = (axis.edge_role == CURVE) & (axis.edge_angle <= axis.theta)
    lengths = np.linalg.norm(np.diff(axis.vertices[axis.edges[curves]], axis=1)[:, 0], axis=1)
    assert np.isclose(graph.homotopy_curve_length, lengths.sum(), rtol=1e-12)
    assert np.isclose(sum(curve.homotopy_length for curve in graph.curves), lengths.sum(), rtol=1e-12)
    for sheet in graph.sheets:
        own = axis.triangle_sheet == sheet.sheet
        assert np.isclose(sheet.homotopy_area, areas[own & for_homotopy].sum(), rtol=1e-12)
        assert sheet.for_homotopy == for_homotopy[own].all()
        radii = axis.radius[np.unique(axis.triangles[own])]
        assert sheet.triangles == own.sum() and np.isclose(sheet.area, areas[own].sum(), rtol=1e-12)
        assert (sheet.thickness.minimum, sheet.thickness.maximum) == (2 * radii.min(), 2 * radii.max())
        assert sheet.thickness.minimum <= sheet.thickness.median <= sheet.thickness.maximum
        assert sum(pair.share for pair in sheet.patch_pairs) <= 1 + 1e-9
    assert sum(sheet.triangles for sheet in graph.sheets) == len(axis.triangles)
    for lines, role in ((graph.seams, SEAM), (graph.curves, CURVE)):
        theirs = sorted(pair for line in lines for pair in pairs(line.vertices))
        assert theirs == sorted(tuple(sorted(edge)) for edge in axis.edges[axis.edge_role == role].tolist())
        for line in lines:
            assert np.array_equal(line.points, axis.vertices[line.vertices])
            assert np.array_equal(line.radii, axis.radius[line.vertices])
            steps = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
            assert np.allclose(np.diff(line.arc_length), steps) and np.isclose(line.length, steps.sum())
            ends = line.vertices[[0, -1]].tolist()
            if line.closed:
                assert ends[0] == ends[1] and line.junctions is None
            else:
                assert [graph.junctions[j].vertex for j in line.junctions] == ends
    vertices = [junction.vertex for junction in graph.junctions]
    assert vertices == sorted(set(vertices)) and set(np.flatnonzero(axis.role == JUNCTION)) <= set(vertices)
    for number, junction in enumerate(graph.junctions):
        for ends, lines in ((junction.seams, graph.seams), (junction.curves, graph.curves)):
            assert sorted(ends.tolist()) == [
                k for k, line in enumerate(lines) for end in line.junctions or () if end == number
            ]


@pytest.fixture(scope="module")
def bracket():
    return blum.medial_axis(blum.generate("bracket"), resolution=64)


@pytest.mark.parametrize("theta", [0, 60, 120, 170])
def test_graphs_hold_everything_once(bracket, theta):
    axis = bracket.simplify(theta)
    check_whole(axis, axis.graph())
    pruned = axis.prune_sheets(max(theta, 100))
    check_whole(pruned, pruned.graph())


def test_membranes_around_voids_count_as_kept_for_homotopy(tmp_path):
    axis = blum.medial_axis(blum.generate("void_cube"), resolution=32).simplify(150)
    check_whole(axis, axis.graph())
    assert axis.graph().homotopy_area > 0.2 * axis.graph().area
    share = axis.graph().homotopy_area / axis.graph().area
    assert share == pytest.approx(axis.certificate.medial.homotopy_share, rel=1e-9)
    assert axis.graph(homotopy_angle=180).homotopy_area == pytest.approx(axis.graph().area)
    axis.write_graph(tmp_path / "void.json")
    told = json.loads((tmp_path / "void.json").read_text())
    assert told["homotopy_area"] == pytest.approx(axis.graph().homotopy_area)
    network = axis.graph().to_networkx()
    assert network.nodes["sheet0"]["homotopy_area"] == axis.graph().sheets[0].homotopy_area


@pytest.mark.parametrize("name", ["box", "torus", "cylinder", "bodies", "plate", "ellipsoid"])
def test_graphs_of_other_shapes_hold_everything_once(name):
    axis = blum.medial_axis(blum.generate(name), resolution=48)
    for theta in (20, 60, 175):
        check_whole(axis.simplify(theta), axis.graph(theta))


def test_curves_of_images_have_no_patches():
    axis = blum.medial_axis(blum.generate("tube_image")).simplify(120)
    graph = axis.graph()
    check_whole(axis, graph)
    assert graph.patches == () and graph.curve_length > 0
    assert all(sheet.patch_pairs == () for sheet in graph.sheets)


def test_a_closed_curve_is_one_curve():
    vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [9, 9, 9]]
    axis = blum.MedialComplex(vertices, radius=[1, 2, 1, 2, 3], edges=[[2, 3], [0, 1], [1, 2], [3, 0]])
    graph = blum.axis_graph(axis)
    (curve,) = graph.curves
    assert curve.closed and curve.vertices.tolist() == [0, 1, 2, 3, 0] and curve.length == 4
    assert [junction.kind for junction in graph.junctions] == ["point"]
    networkx = pytest.importorskip("networkx")
    nodes = graph.to_networkx().nodes(data="element")
    assert sorted(nodes) == [("curve0", "curve"), ("junction0", "junction")]
    assert networkx.number_connected_components(graph.to_networkx()) == 2


def test_ribs_thinner_than_their_neighbours_are_found(bracket):
    """The foot and the wall are 0.4 thick, the three ribs 0.24."""
    graph = bracket.graph(120)
    thin = [sheet for sheet in graph.sheets if sheet.separation_angle.median > 150 and sheet.thickness.median < 0.3]
    assert len(thin) == 3
    for rib in thin:
        assert abs(rib.thickness.median - 0.24) < 1e-3
        (first,), (second,) = rib.patch_pairs[0].first, rib.patch_pairs[0].second
        normals = np.array([graph.patches[first].normal, graph.patches[second].normal])
        assert np.allclose(np.abs(normals), [[0, 1, 0], [0, 1, 0]]) and rib.patch_pairs[0].share > 0.4


def test_the_guide_answers_its_questions(capsys):
    pytest.importorskip("networkx")
    text = (pathlib.Path(__file__).resolve().parents[2] / "docs/guide/medial-axes.md").read_text()
    section = re.search(r"^## Sheets, seams and curves as a graph\n(.*?)^## ", text, re.MULTILINE | re.DOTALL)[1]
    names = {}
    for piece in re.findall(r"^```python\n(.*?)^```", section, re.MULTILINE | re.DOTALL):
        exec(compile(piece, "docs/guide/medial-axes.md", "exec"), names)
    out = capsys.readouterr().out
    print(out)
    assert out.count("a thin rib between the faces at") == 3 and float(out.splitlines()[-1]) > 0


@pytest.mark.parametrize("theta", [60, 120])
def test_networkx_reads_the_same_graph_from_files(bracket, tmp_path, theta):
    networkx = pytest.importorskip("networkx")
    axis = bracket.simplify(theta)
    axis.write_graph(tmp_path / "g.graphml")
    read, made = networkx.read_graphml(tmp_path / "g.graphml", force_multigraph=True), axis.graph().to_networkx()
    assert list(read.nodes(data=True)) == list(made.nodes(data=True))

    def edges(graph):
        return [(a, b, data) for a, b, data in graph.edges(data=True)]

    assert sorted(edges(read), key=str) == sorted(edges(made), key=str)
    assert read.graph["theta"] == theta and read.graph["area"] == made.graph["area"]
    components, _, _ = blum.homology(len(axis.vertices), axis.edges, axis.triangles)
    parts = made.subgraph([node for node, element in made.nodes(data="element") if element != "patch"])
    assert networkx.number_connected_components(parts) == components


def test_json_has_the_members(bracket, tmp_path):
    axis = bracket.simplify(120)
    axis.write_graph(tmp_path / "g.json")
    told, graph = json.loads((tmp_path / "g.json").read_text()), axis.graph()
    assert told["theta"] == 120 and told["content"] == "graph of a medial axis"
    for sheet, theirs in zip(graph.sheets, told["sheets"], strict=True):
        assert vars(sheet).keys() == theirs.keys() and sheet.area == theirs["area"]
    for line, theirs in zip(graph.curves, told["curves"], strict=True):
        assert line.points.tolist() == theirs["points"] and line.radii.tolist() == theirs["radii"]


def test_axes_that_were_read_need_the_mesh_for_patches(bracket, tmp_path):
    axis = bracket.simplify(120)
    axis.write(tmp_path / "a.vtp")
    axis.write(tmp_path / "a.ma")
    again = blum.read_medial(tmp_path / "a.vtp")
    assert again.graph().patches == ()
    with_mesh, known = again.graph(blum.generate("bracket")), axis.graph()
    assert content_of(with_mesh) == content_of(known) and len(known.patches) == 19
    assert len(axis.graph(patch_angle=0).patches) > len(known.patches)
    with pytest.raises(blum.InvalidOption, match="the axis belongs to another mesh"):
        again.graph(blum.generate("box"))
    with pytest.raises(blum.InvalidOption, match="no column 'sheet' of triangles"):
        blum.read_medial(tmp_path / "a.ma").graph()
    with pytest.raises(blum.InvalidOption, match="patch_angle is 181 degrees"):
        axis.graph(patch_angle=181)
    with pytest.raises(blum.InvalidOption, match=r"written to \.json, \.graphml"):
        axis.write_graph(tmp_path / "a.gml")
    with pytest.raises(TypeError, match=r"axis must be a blum\.MedialComplex"):
        blum.axis_graph(bracket)


def test_results_are_read_only_and_pickle(bracket):
    graph = bracket.graph(120)
    again = pickle.loads(pickle.dumps(graph))
    assert content_of(again) == content_of(graph)
    with pytest.raises(ValueError, match="read-only"):
        graph.curves[0].radii[0] = 1


def test_the_graph_of_nested_axes_is_that_of_the_smallest_angle():
    axis = blum.medial_axis(blum.generate("box"), resolution=32, least_theta=60)
    nested, least = axis.nested().graph(), axis.graph(60)
    assert np.isclose(nested.area, least.area) and len(nested.sheets) == len(least.sheets) == 13


def test_missing_networkx_is_reported(bracket, monkeypatch):
    monkeypatch.setitem(sys.modules, "networkx", None)
    with pytest.raises(ImportError, match="needs networkx: pip install networkx"):
        bracket.graph(120).to_networkx()
