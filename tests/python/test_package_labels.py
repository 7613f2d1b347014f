"""Proves that labels that are nearly whole numbers are rounded with a warning by every function that selects labels,
that other values are an error, and that distance transforms without sites have the same distances."""

import warnings

import numpy as np
import pytest
from content import content_of

blum = pytest.importorskip("blum")


def image(first, second, background=0.0, dtype=np.float32):
    values = np.full((12, 12, 12), background, dtype)
    values[2:10, 2:10, 2:5] = first
    values[2:10, 2:10, 7:10] = second
    return blum.Image(values, spacing=(1, 1, 2))


NEARLY = image(7000.9995, 3.002, -0.0005)
EXACT = image(7001, 3)

#: Functions that select labels, by name.
TAKERS = {
    "distance_transform": lambda given: blum.distance_transform(given, label=7001),
    "distance_transforms": lambda given: list(blum.distance_transforms(given, [3, 7001])),
    "smooth_surface": lambda given: blum.smooth_surface(given, label=7001),
    "medial_axis": lambda given: blum.medial_axis(given, label=3).simplify(60),
    "certified": lambda given: blum.medial_axis(given, label=3).certified(60),
    "centreline of all": lambda given: list(blum.centreline(given)),
    "centreline of one": lambda given: list(blum.centreline(given, label=7001)),
    "centreline of several": lambda given: list(blum.centreline(given, labels=[7001, 3])),
    "Solid": lambda given: blum.Solid(given, label=7001).betti,
    "selected_voxels": lambda given: blum.selected_voxels(given, label=7001),
    "certify": lambda given: blum.certify(blum.medial_axis(EXACT, label=3).simplify(60), given, label=3),
    "AxisVerifier": lambda given: blum.AxisVerifier(given).certify(
        blum.medial_axis(EXACT, label=3).simplify(60), label=3
    ),
}


@pytest.mark.parametrize("name", TAKERS)
def test_nearly_whole_labels_are_those_of_whole_labels(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        wanted = content_of(TAKERS[name](EXACT))
    with pytest.warns(blum.InputWarning, match=r"not quite whole, for example .*rounded") as caught:
        found = content_of(TAKERS[name](NEARLY))
    assert found == wanted
    assert {warning.message.code for warning in caught} == {"rounded"}
    assert all(warning.filename == __file__ for warning in caught)
    assert NEARLY.values[0, 0, 0] == np.float32(-0.0005)  # The caller's image keeps its values.


def test_facts_of_labels_are_rounded():
    with pytest.warns(blum.InputWarning, match="rounded"):
        found = NEARLY.labels()
    assert found == EXACT.labels() and {fact.label for fact in found.labels} == {0, 3, 7001}


@pytest.mark.parametrize("name", ["distance_transform", "smooth_surface", "medial_axis", "Solid", "selected_voxels"])
def test_labels_among_other_numbers_are_an_error(name):
    with pytest.raises(blum.InvalidImage, match=r"nearly the label .* but also values .* for example 0.5"):
        TAKERS[name](image(7000.9995, 3.002, 0.5))


def test_thresholds_and_whole_labels_are_compared_as_they_are():
    grey = image(2.5, 3, 0.25)
    assert blum.selected_voxels(grey, label=3).sum() == 192
    assert blum.selected_voxels(NEARLY, threshold=7001).sum() == 0
    assert blum.selected_voxels(NEARLY, threshold=7000.999).sum() == 192
    with pytest.raises(blum.InvalidImage, match=r"no voxel .* has the label 7.* 0.25, which is not a whole number"):
        blum.distance_transform(grey, label=7)


@pytest.mark.parametrize("options", [{}, {"signed": False}, {"band": 1.5}, {"threshold": 3}])
def test_transforms_without_sites_have_the_same_distances(options):
    full = blum.distance_transform(EXACT, **options)
    half = blum.distance_transform(EXACT, sites=False, **options)
    assert full.site is not None and half.site is None
    assert np.array_equal(full.distance, half.distance) and half.site_ids == "voxels"


def test_conflicting_frames_warn_in_python(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    one, other = np.diag([2.0, 3.0, 4.0, 1.0]), np.diag([-2.0, 3.0, 4.0, 1.0])
    made = nibabel.Nifti1Image(np.arange(24, dtype=np.uint8).reshape(2, 3, 4), None)
    made.set_sform(one, 1)
    made.set_qform(other, 1)
    nibabel.save(made, tmp_path / "a.nii")
    with pytest.warns(blum.InputWarning, match=r"the sform and the qform disagree.*the sform is used") as caught:
        read = blum.read_image(tmp_path / "a.nii")
    assert caught[0].message.code == "left-out" and caught[0].filename == __file__
    assert read.spacing == (2, 3, 4)
    with pytest.warns(blum.InputWarning, match="disagree"):
        blum.distance_transform(tmp_path / "a.nii", threshold=12)


@pytest.mark.parametrize(
    "direction, text",
    [([[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], "columns 0 and 1 .* must be perpendicular; resample"),
     (2 * np.eye(3), "length of column 0 is 2, but must be 1; lengths of steps belong in the spacing")],
)  # fmt: skip
def test_directions_that_are_not_orthonormal_name_the_column(direction, text):
    with pytest.raises(blum.InvalidGrid, match=text):
        blum.Image(np.zeros((2, 2, 2)), direction=direction)
