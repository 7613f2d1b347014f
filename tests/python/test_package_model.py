"""Proves that cellular models in Python have the Betti numbers of their solids, and that wrong input is rejected.

Tests the first 40 made solids, one of each family, or all 300 if the environment variable BLUM_MADE_SOLIDS is 300."""

import os

import blum
import numpy as np
import pytest
from made import made_solid, names


@pytest.mark.parametrize("resolution", [1, 2, 7, 20])
@pytest.mark.parametrize("name", ["torus", "plate", "nested_shells", "linked_tori", "menger"])
def test_models_have_the_numbers_of_the_solid_at_every_resolution(name, resolution):
    solid = blum.Solid(blum.generate(name))
    model = solid.model(resolution=resolution)
    assert model.passes and model.report.failures == ()
    assert model.betti() == solid.betti
    components, tunnels, voids = solid.betti
    vertices, edges, polygons, polyhedra = model.report.cells
    assert vertices - edges + polygons - polyhedra == model.report.euler == components - tunnels + voids


def test_the_complex_lies_in_the_solid():
    solid = blum.Solid(blum.generate("bracket"))
    complex_ = solid.model(resolution=16).complex()
    assert type(complex_) is blum.Complex and complex_.homology() == solid.betti
    lower, upper = np.array(solid.bounds)
    assert (complex_.vertices >= lower).all() and (complex_.vertices <= upper).all()
    assert solid.inside(complex_.vertices).mean() > 0.9  # the others lie on the surface, up to rounding


def test_places_that_do_not_pass_are_named():
    solid = blum.Solid(blum.generate("menger"))
    model = solid.model(resolution=2, most_splits=0)
    assert not model.passes
    assert {failure.obstacle for failure in model.report.failures} <= {"hole in square", "handle", "void in cube"}
    for failure in model.report.failures:
        assert (np.array(failure.low) < failure.high).all()
    assert solid.model(resolution=2).passes


def test_moving_and_scaling_grids_leaves_the_numbers():
    mesh = blum.generate("gear")
    for scale in (1e-20, 1.0, 1e20):
        solid = blum.Solid(mesh.vertices * scale, mesh.triangles)
        for shift in (0.0, 0.5, 1.0):
            assert solid.model(resolution=3, shift=shift).betti() == solid.betti
    assert blum.Solid(mesh).model(spacing=0.25).report.grid.spacing == (0.25, 0.25, 0.25)


def test_only_polyhedra_have_a_model():
    with pytest.raises(blum.InvalidMesh, match=r"no cellular model: .*open"):
        blum.Solid(blum.generate("organic", holes=2)).model()
    with pytest.raises(blum.InvalidOption, match="union of voxels"):
        blum.Solid(np.ones((3, 3, 3), np.uint8)).model()
    solid = blum.Solid(blum.generate("box"))
    for options in ({"resolution": 0}, {"resolution": 801}, {"spacing": 0.0}, {"spacing": 1e-9}, {"shift": 1.5}):
        with pytest.raises(blum.InvalidOption):
            solid.model(**options)
    tiny = blum.generate("box")
    vertices = tiny.vertices.copy()
    vertices[vertices == vertices.max()] = 1e-60
    with pytest.raises(blum.InvalidMesh, match="too small next to the other coordinates"):
        blum.Solid(vertices, tiny.triangles).model()


#: Models with slanted pinholes need thousands of boxes and seconds.
SLOW = {"pinholes-3", "pinholes-5", "drillings-6", "hairs-5"}
TOO_SLOW = {"pinholes-7"}  # a hole 2e-6 cubes wide takes minutes
COUNT = int(os.environ.get("BLUM_MADE_SOLIDS", "40"))
LEFT_OUT = TOO_SLOW if COUNT == 300 else SLOW | TOO_SLOW
CHOSEN = [(family, k) for family, k in names()[:COUNT] if f"{family}-{k}" not in LEFT_OUT]


@pytest.mark.parametrize("family, variant", CHOSEN, ids=[f"{family}-{variant}" for family, variant in CHOSEN])
def test_models_of_made_solids_have_their_numbers(family, variant):
    made = made_solid(family, variant)
    solid = blum.Solid(made.vertices, made.triangles)
    for resolution, shift in ((2, 0.381966), (5, 0.0), (24, 0.7)):
        model = solid.model(resolution=resolution, shift=shift)
        assert model.passes and model.betti() == made.betti, f"at {resolution}"
