"""Proves that medial axes of the package equal the tool's and are certified, and that wrong axes are rejected."""

import numpy as np
import pytest

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def plate():
    return blum.generate("plate", holes_x=2, holes_y=1)


@pytest.fixture(scope="module")
def axis(plate):
    return blum.medial_axis(plate, resolution=64)


def test_roles_are_named_as_the_library_numbers_them(axis):
    piece = axis.simplify(60)
    assert blum.ROLES == ("sheet", "rim", "seam", "curve", "junction")
    sides = {tuple(sorted(pair)) for a, b, c in piece.triangles.tolist() for pair in ((a, b), (b, c), (c, a))}
    on_no_triangle = [tuple(sorted(edge)) not in sides for edge in piece.edges.tolist()]
    assert np.array_equal(piece.edge_role == blum.ROLES.index("curve"), on_no_triangle)


def test_options_have_the_defaults_of_the_library(plate):
    assert blum.medial_axis(plate, resolution=16).least_theta == 0
    axis = blum.medial_axis(plate, resolution=16, least_theta=np.float32(20), lambda_=0.125)
    assert (axis.least_theta, axis.nested().least_theta, axis._origin.lambda_) == (20, 20, 0.125)


@pytest.mark.parametrize("theta", [0, 20, 60, 120])
def test_axes_are_certified_at_every_angle(axis, plate, theta):
    piece = axis.simplify(theta)
    certificate = piece.certificate
    assert certificate and certificate.axis_betti == certificate.solid_betti == (1, 2, 0) == blum.known_betti(
        "plate", holes_x=2, holes_y=1
    )
    assert certificate.geometry.radius_error <= certificate.geometry.tolerance
    assert blum.homology(len(piece.vertices), piece.edges, piece.triangles) == (1, 2, 0)
    found = blum.closest_points(plate, piece.vertices)
    assert np.abs(-found.distance - piece.radius).max() < 1e-9
    assert np.abs(np.linalg.norm(piece.footprints[:, 0] - piece.vertices, axis=1) - piece.radius).max() < 1e-9


def test_larger_angles_give_parts_of_smaller_ones(axis):
    def keys(piece):
        corners = np.sort(piece.vertices[piece.triangles].round(9), axis=1)
        return {triangle.tobytes() for triangle in corners}

    assert keys(axis.simplify(120)) <= keys(axis.simplify(60)) <= keys(axis.simplify(20))


def test_sheets_keep_their_numbers_if_the_part_or_grid_moves(plate):
    def sheets(axis, turn):
        corners = axis.vertices[axis.triangles] @ turn
        sides = corners[:, 1:] - corners[:, :1]
        area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
        moments = [np.bincount(axis.triangle_sheet, weights=area * x) for x in corners.mean(axis=1).T]
        return np.transpose(moments) / np.bincount(axis.triangle_sheet, weights=area)[:, None]

    cosine, sine = np.cos(np.radians(17)), np.sin(np.radians(17))
    turn = np.array([[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]]) @ [
        [cosine, -sine, 0],
        [sine, cosine, 0],
        [0, 0, 1],
    ]
    first = sheets(blum.medial_axis(plate, resolution=64).certified(60), np.eye(3))
    apart = np.linalg.norm(first[:, None] - first, axis=2) + np.eye(len(first))
    allowed = 0.01 * np.linalg.norm(np.ptp(plate.vertices, axis=0))
    assert len(first) > 10 and apart.min() > 2 * allowed
    turned = blum.medial_axis(plate.vertices @ turn.T, plate.triangles, resolution=64).certified(60)
    shifted = blum.medial_axis(plate, resolution=64, grid_shift=0.3).certified(60)
    for again in (sheets(turned, turn), sheets(shifted, np.eye(3))):
        assert again.shape == first.shape and np.linalg.norm(again - first, axis=1).max() < allowed


def test_defaults_are_those_of_the_tool(plate, tmp_path):
    import tool

    plate.write(tmp_path / "plate.ply")
    tool.run("medial", tmp_path / "plate.ply", "-o", tmp_path / "axis.npz", "--resolution", 64)
    theirs, ours = (
        blum.read_medial(tmp_path / "axis.npz"),
        blum.medial_axis(tmp_path / "plate.ply", resolution=64).certified(),
    )
    for name in ("vertices", "radius", "footprints", "sites", "role", "edges", "triangles", "triangle_sheet"):
        assert np.array_equal(getattr(theirs, name), getattr(ours, name)), name
    for end in ("vtp", "ply", "obj", "ma", "npz"):
        ours.write(tmp_path / f"ours.{end}")
        tool.run("verify", tmp_path / "plate.ply", tmp_path / f"ours.{end}")
    assert (tmp_path / "ours.npz").read_bytes() == (tmp_path / "axis.npz").read_bytes()


def test_certified_axes_have_a_certificate_that_holds(axis, plate):
    found = axis.certified(60)
    assert found.certificate.holds
    assert found.certificate == blum.certify(found, plate)
    whole = axis.certified(60, tolerance=0)
    assert np.array_equal(whole.vertices, axis.simplify(60).vertices)
    with pytest.raises(blum.InvalidOption, match="tolerance"):
        axis.certified(60, tolerance=-1)


def block_with_needle():
    """A cube with a slanted square hole, so narrow that the cellular model closes it."""
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    rings = [(square, z) for z in (0, 1)]
    rings += [((0.37 + 0.2 * z, 0.41 + 0.3 * z) + 1e-9 * (square - 0.5), z) for z in (0, 1)]
    vertices = [(x, y, z) for ring, z in rings for x, y in ring]
    faces = []
    for k in range(4):
        n = (k + 1) % 4
        faces += [(k, n, 4 + n, 4 + k), (8 + n, 8 + k, 12 + k, 12 + n)]
        faces += [(n, k, 8 + k, 8 + n), (4 + k, 4 + n, 12 + n, 12 + k)]
    return blum.Mesh(vertices, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def test_an_uncertified_axis_is_refused_unless_allowed():
    axis = blum.medial_axis(block_with_needle(), resolution=8, max_resolution=8)
    assert not axis.report.topology_matches
    with pytest.raises(blum.NotCertified, match=r"NOT certified: the model of the solid .* at theta 60: ") as refused:
        axis.certified(60)
    assert isinstance(refused.value, RuntimeError)
    with pytest.warns(blum.InputWarning, match="NOT certified: the model of the solid"):
        found = axis.certified(60, allow_uncertified=True)
    assert not found.certificate.holds and len(found.vertices) > 0


def test_one_verifier_certifies_many_axes_as_certify_does(axis, plate, tmp_path):
    plate.write(tmp_path / "plate.ply")
    of_mesh = blum.AxisVerifier(plate)
    of_file = blum.AxisVerifier(tmp_path / "plate.ply")
    for theta in (120, 60, 90):
        piece = axis.simplify(theta)
        alone = blum.certify(piece, plate, threads=1)
        assert alone.holds
        assert of_mesh.certify(piece) == of_file.certify(piece) == alone == piece.certificate
        assert of_mesh.certify(piece, balls=False) == blum.certify(piece, plate, balls=False)
    wrong = axis.simplify(60)
    moved = blum.MedialComplex(wrong.vertices + 1, radius=wrong.radius, edges=wrong.edges, triangles=wrong.triangles)
    assert not of_mesh.certify(moved)
    with pytest.raises(TypeError, match="MedialComplex"):
        of_mesh.certify(plate)
    labels = np.zeros((6, 6, 12), np.uint8)
    labels[1:4, 1:4, 1:5] = 1
    labels[1:4, 1:4, 7:11] = 2
    of_image = blum.AxisVerifier(labels)
    for label in (1, 2, 1):
        piece = blum.medial_axis(labels, label=label).simplify(60)
        assert of_image.certify(piece) == piece.certificate
        with pytest.warns(blum.InputWarning, match="was computed with"):
            assert not of_image.certify(piece, label=3 - label)


def test_a_wrong_axis_is_not_certified(axis, plate):
    piece = axis.simplify(60)
    parts = {
        name: np.array(getattr(piece, name))
        for name in (
            "radius",
            "footprints",
            "sites",
            "separation_angle",
            "role",
            "edges",
            "edge_angle",
            "edge_role",
            "triangles",
            "triangle_angle",
            "triangle_sheet",
        )
    }
    assert blum.certify(blum.MedialComplex(piece.vertices, **parts), plate)
    wrong = blum.certify(blum.MedialComplex(piece.vertices, **{**parts, "radius": parts["radius"] * 1.01}), plate)
    assert not wrong and "NOT certified" in str(wrong)
    torn = blum.certify(
        blum.MedialComplex(
            piece.vertices,
            **{
                **parts,
                "triangles": parts["triangles"][:-1],
                "triangle_angle": parts["triangle_angle"][:-1],
                "triangle_sheet": parts["triangle_sheet"][:-1],
            },
        ),
        plate,
    )
    assert not torn and not torn.topology_holds
    with pytest.raises(ValueError, match="certify"):
        _ = blum.MedialComplex(piece.vertices).certificate


def test_columns_that_an_axis_lacks_are_not_invented(axis, plate, tmp_path):
    piece = axis.simplify(60)
    for extension, has in ((".obj", set()), (".ma", {"radii"})):
        piece.write(tmp_path / f"few{extension}")
        few = blum.read_medial(tmp_path / f"few{extension}")
        few.write(tmp_path / "again.vtp")
        again = blum.read_medial(tmp_path / "again.vtp")
        assert {name for name, is_there in again.has.items() if is_there} == has
        assert blum.certify(again, plate)
        assert again.counts["sheets"] is None and "sheets" not in repr(again)
        with pytest.raises(ValueError, match=r"'separation_angle'.*\.vtp, \.ply and \.npz files hold it"):
            again.prune_sheets(60)
        with pytest.raises(ValueError, match="footprint_0"):
            _ = again.footprints
        if not has:
            with pytest.raises(ValueError, match=r"'radius'.*\.ma"):
                again.reconstruct(resolution=16)
        assert len(again.to_pyvista().point_data) == len(has)


def test_arrays_of_an_axis_are_checked():
    for wrong, given in (("radius", {"radius": [1, float("nan")]}), ("twice", {"edges": [[0, 0]]})):
        with pytest.raises(ValueError, match=wrong):
            blum.MedialComplex([[0, 0, 0], [1, 0, 0]], **given)


def test_images_and_open_meshes():
    tubes = blum.generate("tube_image", nodes=2)
    piece = blum.medial_axis(tubes).simplify(60)
    assert piece.certificate and piece.certificate.against == "voxels" and piece.certificate.axis_betti == (1, 5, 0)
    array = blum.medial_axis(tubes.values, spacing=(1, 1, 2)).simplify(60)
    assert array.certificate and array.certificate.axis_betti == (1, 5, 0)
    box = blum.generate("box")
    piece = blum.medial_axis(box.vertices, box.triangles[1:], resolution=24).simplify(60)
    assert piece.certificate and piece.certificate.against == "winding" and piece.grid is not None
    assert blum.solid_rule(box.vertices, box.triangles[1:]).rule == "winding"


def test_reconstruction_pruning_and_conversions(axis, plate):
    piece = axis.simplify(20)
    ball = piece.reconstruct(resolution=48)
    assert ball.sign_rule == "balls"
    solid = blum.distance_field(plate, grid=ball.grid)
    assert (ball.distance >= solid.distance - 1e-6).all(), "balls lie in the solid"
    assert blum.certify(piece.prune_sheets(100), plate).topology_holds
    trimesh, pyvista = pytest.importorskip("trimesh"), pytest.importorskip("pyvista")
    assert isinstance(piece.to_trimesh(), trimesh.Trimesh)
    out = piece.to_pyvista()
    assert isinstance(out, pyvista.PolyData) and out.n_cells == len(piece.edges) + len(piece.triangles)


def test_skeletons_of_scikit_image_agree_in_topology():
    morphology = pytest.importorskip("skimage.morphology")
    tubes = blum.generate("tube_image", nodes=2).values
    theirs = blum.voxel_topology(morphology.skeletonize(tubes > 0)).betti
    assert theirs == blum.medial_axis(tubes).simplify(60).certificate.axis_betti


def test_nested_axes_contain_the_axis_of_each_angle(axis):
    def corners(vertices, cells):
        return {cell.tobytes() for cell in np.sort(vertices[cells].view("f8,f8,f8")[..., 0], axis=1)}

    nested = axis.nested()
    assert nested.least_theta == axis.least_theta == 0
    for theta in (0, 20, 60, 120, 180):
        piece, there = axis.simplify(theta), nested.at(theta)
        assert len(there.vertices) == len(nested.vertices) and len(there.edges) == len(nested.edges)
        ours, theirs = (
            corners(nested.vertices, nested.triangles[there.triangles]),
            corners(piece.vertices, piece.triangles),
        )
        assert ours <= theirs
        # Omitted triangles have no area, because two of their corners coincide.
        assert all(len(set(np.frombuffer(cell, dtype="V24"))) < 3 for cell in theirs - ours)
        assert there.vertices[np.unique(nested.triangles[there.triangles])].all()
        curves = nested.edges[there.edges & (nested.edge_role == blum.ROLES.index("curve"))]
        assert corners(nested.vertices, curves) <= corners(
            piece.vertices, piece.edges[piece.edge_role == blum.ROLES.index("curve")]
        )
    for bad in (-1, 181, float("nan")):
        with pytest.raises(ValueError, match="theta"):
            nested.at(bad)


@pytest.mark.parametrize("least", [0, 30])
def test_files_of_nested_axes_equal_those_of_the_tool(plate, tmp_path, least):
    import tool

    plate.write(tmp_path / "plate.ply")
    tool.run(
        "medial", tmp_path / "plate.ply", "-o", tmp_path / "axis.npz", "--resolution", 32, "--nested", "--theta", least
    )
    blum.medial_axis(tmp_path / "plate.ply", resolution=32, least_theta=least).write(tmp_path / "ours.npz")
    assert (tmp_path / "ours.npz").read_bytes() == (tmp_path / "axis.npz").read_bytes()
    nested = blum.read_medial(tmp_path / "ours.npz").nested
    assert nested is not None and nested.least_theta == least
    axis = blum.medial_axis(plate, resolution=32, least_theta=least)
    for name in ("vertices", "vertex_until", "edges", "edge_from", "edge_until", "triangles", "triangle_until"):
        assert np.array_equal(getattr(nested, name), getattr(axis.nested(), name)), name
    assert axis.simplify(60).nested is None
    with pytest.raises(ValueError, match="npz"):
        axis.write(tmp_path / "axis.vtp")


def test_the_tool_and_python_certify_voxels_of_a_mesh_alike(tmp_path):
    import tool

    box = blum.generate("box")
    blum.Mesh(box.vertices, box.triangles[1:]).write(tmp_path / "open.ply")
    piece = blum.medial_axis(tmp_path / "open.ply", resolution=24).simplify(60)
    piece.write(tmp_path / "axis.npz")
    told = tool.run("verify", tmp_path / "open.ply", tmp_path / "axis.npz")[0]
    assert "topology of the voxels inside by winding number, side" in told
    elsewhere = blum.Grid(np.array(piece.grid.origin) + 5, piece.grid.spacing, piece.grid.size)
    with pytest.raises(ValueError, match="no voxel"):
        blum.certify(piece, tmp_path / "open.ply", grid=elsewhere)


@pytest.mark.parametrize(
    "changes,dropped,reason",
    [
        ({"solid_rule": "winding"}, (), "its solid is 'winding', but it is 'polyhedron'"),
        ({"solid_rule": "nonsense"}, (), "its solid is 'nonsense', but it is 'polyhedron'"),
        ({}, ("radius",), "contains no radii"),
        ({}, ("separation_angle",), "contains no separation angles"),
        ({"site_ids": "voxels"}, (), "contains no sites of this kind of solid"),
    ],
)
def test_the_tool_and_python_refuse_false_claims_alike(axis, plate, tmp_path, changes, dropped, reason):
    import json

    import tool

    plate.write(tmp_path / "plate.ply")
    axis.simplify(60).write(tmp_path / "true.npz")
    assert blum.certify(blum.read_medial(tmp_path / "true.npz"), plate)
    with np.load(tmp_path / "true.npz") as file:
        arrays = {name: file[name] for name in file.files if name not in dropped}
    arrays["metadata"] = np.array(json.dumps(json.loads(str(arrays["metadata"])) | changes))
    np.savez(tmp_path / "false.npz", **arrays)
    certificate = blum.certify(blum.read_medial(tmp_path / "false.npz"), plate)
    assert not certificate and any(reason in mismatch for mismatch in certificate.mismatches)
    told = tool.run("verify", tmp_path / "plate.ply", tmp_path / "false.npz", "--json", "-", status=3)[0]
    assert tuple(json.loads(told)["certificate"]["mismatches"]) == certificate.mismatches


def test_a_file_records_the_voxels_of_its_axis(tmp_path):
    labels = np.zeros((12, 12, 12), dtype=np.uint8)
    labels[2:5, 2:10, 2:10] = 1
    labels[7:10, 2:10, 2:10] = 2
    blum.medial_axis(labels, label=2).simplify(60).write(tmp_path / "two.npz")
    read = blum.read_medial(tmp_path / "two.npz")
    assert blum.certify(read, labels).holds
    assert not blum.certify(read, labels, label=1)
    sparse = blum.certify(read, blum.Image(labels, spacing=(2, 2, 2)))
    assert any("voxels have the sides 1 1 1, but those of the image have 2 2 2" in text for text in sparse.mismatches)
