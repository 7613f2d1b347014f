# Proves that smooth_surface() keeps the topology of the voxels and the place of the image.
# Medial axes of smooth surfaces, also from the tool's files, are certified.
import blum
import numpy as np
import pytest


def ball(radius, size=24, middle=(11.3, 11.6, 11.8)):
    z, y, x = np.meshgrid(*[np.arange(size)] * 3, indexing="ij")
    return np.linalg.norm(np.stack([x, y, z], axis=-1) - np.array(middle), axis=-1) < radius


def test_a_ball_keeps_its_place_and_radius():
    image = blum.Image(ball(6).astype(np.uint8), spacing=(0.5, 0.5, 0.5), origin=(7, 8, 9))
    mesh = blum.smooth_surface(image)
    facts = blum.topology(mesh)
    assert facts.closed and facts.manifold and facts.faces_outwards and facts.betti == (1, 0, 0)
    radii = np.linalg.norm(mesh.vertices - (0.5 * np.array([11.3, 11.6, 11.8]) + [7, 8, 9]), axis=1)
    assert abs(radii.mean() - 3) < 0.05 and np.abs(radii - 3).max() < 0.2


def test_noise_has_the_topology_of_its_voxels():
    mask = np.random.default_rng(1).random((12, 13, 14)) < 0.3
    mesh = blum.smooth_surface(mask)
    assert blum.topology(mesh).betti == blum.voxel_topology(mask).betti
    assert len(blum.self_intersections(mesh).pairs) == 0
    again = blum.smooth_surface(mask, threads=3)
    assert np.array_equal(mesh.vertices, again.vertices) and np.array_equal(mesh.triangles, again.triangles)


def test_labels_thresholds_and_iterations():
    image = ball(6).astype(np.int16) * 3
    mesh = blum.smooth_surface(image, label=3)
    assert np.array_equal(mesh.vertices, blum.smooth_surface(image, threshold=2).vertices)
    rough = blum.smooth_surface(image, iterations=0)
    assert np.array_equal(rough.vertices % 1, np.full_like(rough.vertices, 0.5))
    with pytest.raises(blum.InvalidImage):
        blum.smooth_surface(image, label=5)
    with pytest.raises(blum.InvalidOption):
        blum.smooth_surface(image, label=3, threshold=2)
    with pytest.raises(blum.InvalidOption):
        blum.smooth_surface(image, iterations=1001)


def test_medial_axes_of_smooth_surfaces():
    surface = blum.smooth_surface(ball(6).astype(np.uint8))
    axis = blum.medial_axis(surface, spacing=1).simplify(60, fit=True)
    assert axis.certificate.holds
    assert np.linalg.norm(axis.vertices - [11.3, 11.6, 11.8], axis=1).max() < 1


def test_files_record_that_their_solid_is_a_smooth_surface(tmp_path):
    image = ball(6).astype(np.uint8)
    axis = blum.medial_axis(blum.smooth_surface(image), spacing=1).simplify(60)
    axis.write(tmp_path / "a.npz")
    arrays = dict(np.load(tmp_path / "a.npz"))
    # The tool writes this metadata: the solid is the smooth surface of the image.
    arrays["metadata"] = np.array(str(arrays["metadata"]).replace('"roles"', '"smooth": "60", "roles"'))
    np.savez(tmp_path / "b.npz", **arrays)
    assert blum.certify(blum.read_medial(tmp_path / "b.npz"), image).holds
    assert not blum.certify(blum.read_medial(tmp_path / "a.npz"), image).holds
