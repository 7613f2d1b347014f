"""Proves the least translation of solids: SciPy's hulls of Minkowski differences are the reference."""

import blum
import numpy as np
import pytest

spatial = pytest.importorskip("scipy.spatial")


def hull_of(points):
    """The convex hull of points, as a closed mesh that faces outwards."""
    hull = spatial.ConvexHull(points)
    triangles = hull.simplices.copy()
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    triangles[inward] = triangles[inward][:, [0, 2, 1]]
    return points, triangles


def depth_of(a, b):
    """Distance of the origin from the border of all differences b - a; 0 if it is outside."""
    hull = spatial.ConvexHull((b[0][:, None] - a[0][None]).reshape(-1, 3))
    return max(0.0, -hull.equations[:, 3].max())


@pytest.mark.parametrize("seed", range(25))
def test_convex_solids_match_scipy(seed):
    rng = np.random.default_rng(seed)
    sizes = rng.uniform(0.05, 1, (2, 3))
    a = hull_of(rng.normal(size=(rng.integers(4, 40), 3)) * sizes[0])
    b = hull_of(rng.normal(size=(rng.integers(4, 40), 3)) * sizes[1] + rng.normal(size=3) * 0.3)
    found = blum.least_translation(a, b)
    depth = depth_of(a, b)
    assert found.are_convex and found.upper - found.lower <= 1e-12
    assert found.lower - 1e-12 <= depth <= found.upper + 1e-12
    assert np.isclose(np.linalg.norm(found.translation), found.upper, atol=1e-14)
    if depth > 0:  # a slightly longer translation leaves no overlap
        moved = a[0] + np.asarray(found.translation) * (1 + 1e-9)
        scene = blum.ProximityScene()
        first, second = scene.add((moved, a[1])), scene.add(b)
        assert scene.penetration(first, second) == []


def test_scenes_use_places_and_refuse_open_meshes():
    scene, box = blum.ProximityScene(), blum.generate("box")
    a, b = scene.add(box), scene.add(box)
    scene.update(b, transform=(np.eye(3), [0.0, 0.9, 0.0]))
    found = scene.least_translation(a, b, threads=1)
    assert np.allclose(found.translation, [0, -0.1, 0], atol=1e-13) and np.isclose(found.lower, 0.1, atol=1e-13)
    with pytest.raises(blum.InvalidMesh):
        blum.least_translation((box.vertices, box.triangles[1:]), box)
    with pytest.raises(blum.InvalidOption):
        scene.least_translation(a, a)
    with pytest.raises(blum.InvalidOption):
        blum.least_translation(box, box, translation_tolerance=-1)
