"""Proves that the package computes the library's Voronoi complexes and rejects wrong input."""

import json
import pickle
import sys

import numpy as np
import pytest

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def box():
    return blum.generate("box")


def test_a_box_has_six_regions(box):
    found = blum.voronoi_complex(box, threads=2)
    assert found.report.certified and found.report.faces == 6
    assert found.homology() == found.report.found_betti == found.report.expected_betti == (1, 0, 6)
    sites = found.triangle_sites
    assert sites.shape == (len(found.triangles), 2) and sites.min() == -1 and sites.max() == 5
    assert (sites[:, 0] < sites[:, 1]).all()
    assert np.isclose(found.radius.max(), 0.5) and found.radius.min() == 0
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again.triangles, found.triangles) and again.report == found.report
    assert "VoronoiComplex" in repr(found)


def test_options_apply_and_wrong_input_is_rejected(box):
    coarse = blum.voronoi_complex(box, method="cubes", resolution=1)
    fine = blum.voronoi_complex(box, method="cubes", resolution=32)
    assert coarse.report.cubes < fine.report.cubes and fine.report.certified and not fine.report.exact
    failed = blum.voronoi_complex(blum.generate("gear"), method="cubes", resolution=1, depth=3)
    assert not failed.report.certified and failed.report.failing
    with pytest.raises(blum.InvalidOption, match="allow_uncertified"):
        failed.write("never.npz")
    shown = failed.with_failing_cells()
    assert len(shown.edges) == len(shown.edge_columns["obstacle"]) == 12 * len(failed.report.failing)
    assert len(failed.edges) == 0 and np.array_equal(shown.triangles, failed.triangles)
    cell = failed.report.failing[0]
    corners = shown.vertices[len(failed.vertices) :][:8]
    assert np.array_equal(corners.min(axis=0), cell.low) and np.array_equal(corners.max(axis=0), cell.high)
    assert shown.edge_columns["obstacle"][0] > 0
    with pytest.raises(blum.InvalidOption, match="depth"):
        blum.voronoi_complex(box, depth=0)
    with pytest.raises(TypeError):
        blum.voronoi_complex(box, depths=3)
    with pytest.raises(blum.InvalidMesh, match="no solid"):
        blum.voronoi_complex(box.vertices, box.triangles[1:])


def test_files(box, tmp_path):
    found = blum.voronoi_complex(box)
    for extension in ("vtp", "ply", "obj", "npz"):
        found.write(tmp_path / f"walls.{extension}")
        assert (tmp_path / f"walls.{extension}").stat().st_size > 300
    arrays = np.load(tmp_path / "walls.npz")
    metadata = json.loads(str(arrays["metadata"]))
    assert metadata["content"] == "Voronoi diagram" and metadata["certified"] == "true"
    assert float(metadata["hausdorff_bound"]) == found.report.hausdorff_bound
    failed = blum.voronoi_complex(blum.generate("gear"), method="cubes", resolution=1, depth=3)
    failed.write(tmp_path / "failed.npz", allow_uncertified=True)
    arrays_of_failed = np.load(tmp_path / "failed.npz")
    assert json.loads(str(arrays_of_failed["metadata"]))["failing_cubes"] == str(len(failed.report.failing))
    assert len(arrays_of_failed["edges"]) == 12 * len(failed.report.failing)
    assert np.array_equal(arrays["triangles"], found.triangles)


def test_regions(box):
    found = blum.voronoi_complex(box).regions()
    assert [region.site for region in found] == list(range(6))
    assert np.isclose(sum(region.volume for region in found), 1)
    assert all(len(region.neighbours) == 4 for region in found)
    with pytest.raises(blum.InvalidOption, match="all"):
        blum.voronoi_complex(box, part="walls").regions()


def test_medial_axes(tmp_path):
    bracket = blum.generate("bracket")
    walls = blum.voronoi_complex(bracket, part="walls", resolution=4)
    assert walls.report.certified and walls.part == "walls" and walls.triangle_sites.min() == 0
    found = blum.voronoi_complex(bracket, part="medial", resolution=4)
    assert found.report.certified and found.homology() == (1, 4, 0)
    assert found.footprints.shape == (len(found.vertices), 2, 3)
    distances = np.linalg.norm(found.footprints - found.vertices[:, None], axis=2)
    assert np.abs(distances - found.radius[:, None]).max() < 1e-8
    assert found.separation_angle[found.radius > 0].min() > 0
    assert not found.separation_angle[found.radius == 0].any(), "both footprints are the vertex itself"
    for theta in (0, 60, 120):
        axis = found.medial_axis(theta)
        assert axis.certificate.holds and axis.homology() == (1, 4, 0)
    fewer = pickle.loads(pickle.dumps(found)).medial_axis(60).decimate(0.01)
    assert fewer.certificate.holds and len(fewer.triangles) < len(found.medial_axis(60).triangles)
    fewer.write(tmp_path / "axis.vtp")
    assert blum.read_medial(tmp_path / "axis.vtp").triangles.shape == fewer.triangles.shape
    with pytest.raises(blum.InvalidOption, match="two footprints"):
        walls.medial_axis(60)
    with pytest.raises(blum.InvalidOption, match="theta"):
        found.medial_axis(200)


def test_axes_at_corners_of_three_convex_and_three_reflex_edges():
    """The walls that meet at such a corner form a cone; a vertex near the corner lies on the seam of all of them."""
    sponge = blum.generate("menger", level=2)
    c, s = np.cos([0.3, 0.5]), np.sin([0.3, 0.5])
    turn = np.array([[1, 0, 0], [0, c[1], -s[1]], [0, s[1], c[1]]]) @ [[c[0], -s[0], 0], [s[0], c[0], 0], [0, 0, 1]]
    axis = blum.voronoi_complex((sponge.vertices @ turn.T, sponge.triangles), part="medial").medial_axis(1)
    assert axis.certificate.holds and axis.homology() == (1, 81, 0), axis.certificate.mismatches


@pytest.mark.parametrize("size", [1e-120, 1e-75, 1e60, 1e120])
def test_sizes_beyond_exact_signs_are_rejected(box, size):
    with pytest.raises(blum.InvalidMesh, match="at least 1e-45 and coordinates up to 1e45"):
        blum.voronoi_complex(blum.Mesh(box.vertices * size, box.triangles))


def test_sites():
    """Each face of a bracket is planar, and the number of sites equals the report's."""
    mesh = blum.generate("bracket")
    found = blum.voronoi_complex(mesh)
    sites = found.sites()
    kinds = [site.kind for site in sites]
    report = found.report
    assert kinds == ["face"] * report.faces + ["edge"] * report.reflex_edges + ["vertex"] * report.reflex_vertices
    assert sorted(t for site in sites for t in site.triangles) == list(range(len(mesh.triangles)))
    for site in sites[: report.faces]:
        corners = mesh.vertices[mesh.triangles[list(site.triangles)]].reshape(-1, 3)
        assert np.linalg.svd(corners - corners.mean(axis=0))[1][2] < 1e-9
    assert all(len(site.vertices) == 2 for site in sites if site.kind == "edge")
    assert [region.site for region in found.regions()][-1] < len(sites)


def test_graphs(box):
    found = blum.voronoi_complex(blum.Mesh(box.vertices * [1, 2, 3], box.triangles))
    graph = found.graph()
    assert [len(part) for part in (graph.regions, graph.walls, graph.seams, graph.junctions)] == [6, 13, 12, 12]
    assert list(graph.regions) == found.regions()
    for wall in graph.walls:
        assert wall.site_a < wall.site_b and wall.area > 0
        assert all({wall.site_a, wall.site_b} <= set(graph.seams[seam].sites) for seam in wall.seams)
    for junction in graph.junctions:
        assert np.array_equal(junction.position, found.vertices[junction.vertex])
        assert len(junction.seams) in (1, 4)
    assert not blum.voronoi_complex(box, part="walls").graph().regions


def test_networkx_reads_graphs_of_diagrams(box, tmp_path):
    networkx = pytest.importorskip("networkx")
    found = blum.voronoi_complex(blum.generate("bracket"))
    found.write_graph(tmp_path / "g.graphml")
    graph, read = found.graph(), networkx.read_graphml(tmp_path / "g.graphml")
    assert read.graph["content"] == "graph of a Voronoi diagram" and read.graph["certified"] == "true"
    of = {node: data["element"] for node, data in read.nodes(data=True)}
    for element, parts in (("wall", graph.walls), ("seam", graph.seams), ("junction", graph.junctions)):
        assert list(of.values()).count(element) == len(parts)
    regions = read.subgraph([node for node, element in of.items() if element == "region"])
    assert all(read.nodes[f"region{k}"]["kind"] == site.kind for k, site in enumerate(found.sites()))
    area = {
        frozenset((f"region{region.site}", f"region{other.site}")): other.area
        for region in graph.regions
        for other in region.neighbours
    }
    assert {frozenset((a, b)): data["area"] for a, b, data in regions.edges(data=True)} == pytest.approx(area)
    for k, wall in enumerate(graph.walls):
        around = {f"region{wall.site_a}", f"region{wall.site_b}", *(f"seam{seam}" for seam in wall.seams)}
        assert set(read[f"wall{k}"]) == around
    for k, seam in enumerate(graph.seams):
        assert {n for n in read[f"seam{k}"] if of[n] == "junction"} == {f"junction{j}" for j in seam.junctions}
    blum.voronoi_complex(box, part="walls").write_graph(tmp_path / "walls.json")
    assert json.loads((tmp_path / "walls.json").read_text())["regions"] == []
    with pytest.raises(blum.InvalidOption, match=r"\.json, \.graphml"):
        found.write_graph(tmp_path / "g.gml")


@pytest.mark.parametrize("part", ["all", "walls"])
def test_networkx_reads_the_same_graph_from_files(tmp_path, part):
    networkx = pytest.importorskip("networkx")
    found = blum.voronoi_complex(blum.generate("bracket"), part=part)
    found.write_graph(tmp_path / "g.graphml")
    read = networkx.read_graphml(tmp_path / "g.graphml", force_multigraph=True)
    made = found.graph().to_networkx(found.sites())
    assert dict(read.nodes(data=True)) == dict(made.nodes(data=True))

    def edges(graph):
        return sorted((sorted((a, b)), sorted(data.items())) for a, b, data in graph.edges(data=True))

    assert edges(read) == edges(made)


def test_the_graph_of_a_box_has_the_expected_nodes():
    networkx = pytest.importorskip("networkx")
    box = blum.Mesh(blum.generate("box").vertices * np.array([1, 2, 3]), blum.generate("box").triangles)
    graph = blum.voronoi_complex(box).graph().to_networkx()
    count = dict.fromkeys(("region", "wall", "seam", "junction"), 0)
    for _, kind in graph.nodes(data="element"):
        count[kind] += 1
    assert count == {"region": 6, "wall": 13, "seam": 12, "junction": 12} and networkx.is_connected(graph)
    # The two faces 2 x 3 are 1 apart: their common wall is the rectangle 1 x 2 in the middle.
    largest = max(graph.nodes[f"wall{k}"]["area"] for k in range(13))
    neighbours = [data["area"] for _, _, data in graph.edges(data=True) if data["element"] == "neighbours"]
    assert len(neighbours) == 13 and max(neighbours) == pytest.approx(largest)
    assert any(area == pytest.approx(2.0, abs=1e-9) for area in neighbours)
    # A junction is one of the 8 corners of the box, or, within a cube, one of the 4 ends of that rectangle.
    junctions = [data for _, data in graph.nodes(data=True) if data["element"] == "junction"]
    places = np.array([[data[f"position_{axis}"] for axis in "xyz"] for data in junctions])
    corners = np.vstack([box.vertices, [[0, y, z] for y in (-0.5, 0.5) for z in (-1.0, 1.0)]])
    away = np.linalg.norm(places[:, None] - corners[None], axis=-1)
    assert away.min(axis=1).max() < 0.2 and sorted(away.argmin(axis=1)) == list(range(12))


def test_missing_networkx_is_reported(box, monkeypatch):
    graph = blum.voronoi_complex(box).graph()
    monkeypatch.setitem(sys.modules, "networkx", None)
    with pytest.raises(ImportError, match=r"VoronoiGraph\.to_networkx\(\) needs networkx: pip install networkx"):
        graph.to_networkx()
    (line,) = blum.centreline(blum.generate("tube_image", nodes=2, pitch=30))
    with pytest.raises(ImportError, match=r"Centreline\.to_networkx\(\) needs networkx: pip install networkx"):
        line.to_networkx()


def test_the_diagram_of_a_mesh_that_crosses_itself_is_that_of_its_solid():
    box = blum.generate("box")
    vertices = np.concatenate([box.vertices, box.vertices + np.array([0.5, 0.25, 0.125])])
    triangles = np.concatenate([box.triangles, box.triangles + len(box.vertices)])
    solid = blum.Solid(vertices, triangles)
    assert solid.problem == "" and blum.topology(solid.surface).betti == (1, 0, 0)
    with pytest.warns(blum.InputWarning, match=r"without the crossings: Solid\(mesh\)\.surface") as told:
        warned = blum.voronoi_complex(vertices, triangles)
    assert [warning.message.code for warning in told] == ["crossings-removed"]
    found = blum.voronoi_complex(solid)
    assert found.report.certified and np.array_equal(found.triangle_sites, warned.triangle_sites)
    cleaned = blum.clean_mesh(solid, 1e-6)
    assert blum.topology(cleaned.mesh).betti == (1, 0, 0)
    with pytest.raises(blum.InvalidMesh, match="not closed"):
        blum.voronoi_complex(blum.Solid(box.vertices, box.triangles[1:]))
