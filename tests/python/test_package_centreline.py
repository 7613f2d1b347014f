"""Proves that blum.centreline() returns the graphs of labels as arrays, for every way to choose labels."""

import numpy as np
import pytest

blum = pytest.importorskip("blum")


def capsule(shape, begin, end, radius, spacing=(1, 1, 1)):
    at = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1)[..., ::-1] * np.array(spacing)  # x, y, z
    begin, along = np.array(begin, dtype=float), np.subtract(end, begin)
    share = np.clip((at - begin) @ along / (along @ along), 0, 1)
    return np.linalg.norm(at - begin - share[..., None] * along, axis=-1) <= radius


@pytest.fixture(scope="module")
def labels():
    """An image: label 3 is a Y, label 8 a tube."""
    shape = (40, 40, 60)
    values = np.zeros(shape, dtype=np.uint16)
    for begin, end in [((15, 6, 20), (15, 20, 20)), ((15, 20, 20), (6, 33, 20)), ((15, 20, 20), (24, 33, 20))]:
        values[capsule(shape, begin, end, 2.5)] = 3
    values[capsule(shape, (40, 10, 8), (40, 30, 30), 3)] = 8
    return values


def test_each_label_is_a_graph_of_arrays(labels):
    lines = blum.centreline(labels)
    assert [line.label for line in lines] == [3, 8] and len(lines) == 2 and "2 labels, 4 branches" in repr(lines)
    y, straight = lines
    assert sorted(y.kinds) == ["end", "end", "end", "junction"] and y.positions.shape == (4, 3)
    assert y.voxels == (labels == 3).sum() and y.homotopy_kept and y.label_betti == (1, 0, 0) == y.graph_betti
    for branch in y.branches:
        assert branch.mean_radius == pytest.approx(2.5, abs=0.1) and branch.min_radius <= branch.mean_radius
        assert branch.points.shape == (len(branch.radii), 3) and not branch.is_closed
        for node, point in zip(branch.nodes, (branch.points[0], branch.points[-1]), strict=True):
            assert np.array_equal(y.positions[node], point)
        steps = np.linalg.norm(np.diff(branch.points, axis=0), axis=1)
        assert branch.length == pytest.approx(steps.sum())
    (branch,) = straight.branches
    assert branch.mean_radius == pytest.approx(3, abs=0.1) and branch.length == pytest.approx(29.7, abs=1)
    assert np.abs(branch.points[:, 0] - 40).max() < 0.3


def test_labels_are_chosen(labels):
    with pytest.warns(blum.InputWarning, match="no voxel has the label 5$"):
        assert [line.label for line in blum.centreline(labels, labels=[8, 3, 5])] == [8, 3, 5]
    assert [line.label for line in blum.centreline(labels, label=8)] == [8]
    (both,) = blum.centreline(labels / 10, threshold=0.2)
    assert both.label is None and both.graph_betti == (2, 0, 0)
    with pytest.raises(blum.InvalidImage, match="give a threshold"):
        blum.centreline(labels / 10)
    with pytest.raises(blum.InvalidOption, match="excludes"):
        blum.centreline(labels, labels=[1], label=3)
    for wrong in ({"labels": "3"}, {"labels": [0.5]}, {"spur": "x"}, {"nonsense": 1}):
        with pytest.raises(TypeError):
            blum.centreline(labels, **wrong)
    with pytest.raises(blum.InvalidOption):
        blum.centreline(labels, spur=-1)
    with pytest.warns(blum.InputWarning, match="no voxel is selected"):
        assert len(blum.centreline(np.zeros((3, 3, 3), dtype=bool))) == 0


def test_spacing_scales_and_anisotropic_voxels_give_the_same_tube():
    shape, spacing = (30, 60, 60), (0.5, 0.5, 1.0)
    mask = capsule(shape, (8, 8, 8), (20, 22, 20), 3, spacing)
    (line,) = blum.centreline(mask, spacing=spacing, origin=(100, 0, 0))
    (branch,) = line.branches
    assert branch.mean_radius == pytest.approx(3, abs=0.1)
    assert branch.length == pytest.approx(np.linalg.norm([12, 14, 12]), abs=1)
    assert branch.points[:, 0].min() > 100
    (twice,) = blum.centreline(blum.Image(mask, spacing=(1, 1, 2)))
    assert twice.branches[0].length == pytest.approx(2 * branch.length)
    assert twice.branches[0].mean_radius == pytest.approx(2 * branch.mean_radius)


def test_a_ring_is_a_closed_curve_and_edges_are_a_complex(labels):
    z, y, x = np.mgrid[:13, :31, :31]
    ring = (np.hypot(x - 15, y - 15) - 9) ** 2 + (z - 6) ** 2 <= 2.5**2
    (line,) = lines = blum.centreline(ring)
    assert line.kinds == () and line.branches[0].is_closed and line.graph_betti == (1, 1, 0)
    assert line.branches[0].length == pytest.approx(2 * np.pi * 9, abs=0.5)
    assert lines.complex.homology() == (1, 1, 0)
    both = blum.centreline(labels).complex
    assert both.homology() == (2, 0, 0) and set(both.edge_columns["label"]) == {3, 8}
    assert (both.vertex_columns["radius"] > 1).all()


def test_networkx_graphs_have_the_branches(labels):
    networkx = pytest.importorskip("networkx")
    graph = blum.centreline(labels)[0].to_networkx()
    assert isinstance(graph, networkx.MultiGraph) and networkx.is_tree(graph)
    assert sorted(degree for _, degree in graph.degree) == [1, 1, 1, 3]
    assert min(data["mean_radius"] for *_, data in graph.edges(data=True)) > 2.4


def test_results_do_not_depend_on_threads(labels):
    one, seven = (blum.centreline(labels, threads=threads) for threads in (1, 7))
    for first, second in zip(one, seven, strict=True):
        for a, b in zip(first.branches, second.branches, strict=True):
            assert a.points.tobytes() == b.points.tobytes() and a.radii.tobytes() == b.radii.tobytes()
