"""Proves that images with nearly whole labels, several frames, shear or only one kind of voxel give the right result
with a warning, or an error that names a remedy. Proves that fields of images without sites have the same distances."""

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
nibabel = pytest.importorskip("nibabel")

SIDE = 12


def two_blocks(first, second, background=0.0):
    """Returns values [x, y, z] of an image with two blocks."""
    values = np.full((SIDE, SIDE, SIDE), background)
    values[2:5, 2:10, 2:10] = first
    values[7:10, 2:10, 2:10] = second
    return values


def save(path, values, affine=None, dtype=np.float32):
    image = nibabel.Nifti1Image(values.astype(dtype), np.eye(4) if affine is None else affine)
    nibabel.save(image, path)
    return path


@pytest.fixture
def nearly(tmp_path):
    """Returns an image with the labels 7001 and 3, moved by the rounding of a scale."""
    return save(tmp_path / "nearly.nii", two_blocks(7000.9995, 3.002, -0.0005))


@pytest.fixture
def exact(tmp_path):
    return save(tmp_path / "exact.nii", two_blocks(7001, 3))


LABELLED = [
    ("field", "out.npz", ()),
    ("surface", "out.ply", ("--smooth",)),
    ("medial", "out.npz", ("--theta", "60")),
    ("centreline", "out.json", ()),
]


@pytest.mark.parametrize("verb, name, options", LABELLED)
def test_nearly_whole_labels_are_rounded_with_a_warning(tmp_path, nearly, exact, verb, name, options):
    results = []
    for image, warns in ((nearly, True), (exact, False)):
        output = tmp_path / f"{image.stem}-{name}"
        _, err = run(verb, image, *options, "--label", 7001, "-o", output, warns=warns)
        data = np.load(output) if name.endswith(".npz") else output.read_bytes()
        results.append({k: data[k] for k in data.files if k != "metadata"} if name.endswith(".npz") else data)
        if warns:
            assert "labels that are not quite whole" in err and "rounded to whole numbers, by at most 0.01" in err
    rounded, wanted = results
    if isinstance(wanted, dict):
        assert rounded.keys() == wanted.keys()
        assert all(np.array_equal(rounded[key], wanted[key]) for key in wanted)
    else:
        assert rounded.replace(b"nearly", b"exact") == wanted


def test_info_and_verify_round_labels_too(tmp_path, nearly, exact):
    facts = run_json("info", nearly, warns=True)
    assert {entry["label"] for entry in facts["labels"]} == {0, 3, 7001}
    assert facts["labels"] == run_json("info", exact)["labels"]
    assert [warning["code"] for warning in facts["warnings"]] == ["rounded"]
    run("medial", exact, "--label", 3, "-o", tmp_path / "axis.vtp")
    _, err = run("verify", nearly, tmp_path / "axis.vtp", tmp_path / "axis.vtp", "--label", 3, warns=True)
    assert err.count("not quite whole") == 1


def test_labels_far_from_whole_numbers_are_an_error(tmp_path):
    far = save(tmp_path / "far.nii", two_blocks(7000.9, 3))
    _, err = run("field", far, "--label", 7001, "-o", tmp_path / "o.npz", status=1)
    assert "no voxel of the image has the label 7001" in err and "7000.9, which is not a whole number" in err
    mixed = save(tmp_path / "mixed.nii", two_blocks(7000.9995, 2.5))
    _, err = run("field", mixed, "--label", 7001, "-o", tmp_path / "o.npz", status=1)
    assert "nearly the label 7001" in err and "2.5" in err and "give a threshold" in err
    # Values that are exactly the label are selected, whatever the others are.
    run("field", far, "--label", 3, "-o", tmp_path / "o.npz")
    # A threshold compares the numbers as they are.
    run("field", mixed, "--threshold", 7000.999, "-o", tmp_path / "o.npz")


def turned(degrees, steps=(2, 3, 4), origin=(10, 20, 30)):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    affine = np.eye(4)
    affine[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) * steps
    affine[:3, 3] = origin
    return affine


def with_frames(path, sform, qform):
    image = nibabel.Nifti1Image(two_blocks(1, 2).astype(np.uint8), None)
    image.set_sform(sform, 1)
    image.set_qform(qform, 1)
    nibabel.save(image, path)
    return path


@pytest.mark.parametrize(
    "qform", [turned(90), turned(0, origin=(10, 21, 30)), turned(0, steps=(-2, 3, 4)), turned(0, (2, 3, 4.5))]
)
def test_frames_that_disagree_are_named(tmp_path, qform):
    path = with_frames(tmp_path / "a.nii", turned(0), qform)
    facts, (_, err) = run_json("info", path, warns=True), run("info", path, warns=True)
    assert facts["grid"]["origin"] == [10, 20, 30] and facts["grid"]["spacing"] == [2, 3, 4]
    assert "the sform and the qform disagree" in err and "the sform is used, and the qform is ignored" in err
    run("field", path, "-o", tmp_path / "o.npz", warns=True)
    run("surface", path, "--smooth", "-o", tmp_path / "o.ply", warns=True)
    run("centreline", path, "-o", tmp_path / "o.json", warns=True)


def test_frames_that_agree_have_no_warning(tmp_path):
    run("info", with_frames(tmp_path / "a.nii", turned(33), turned(33)))
    nudged = turned(33)
    nudged[:3, 3] += 0.05
    run("info", with_frames(tmp_path / "a.nii", turned(33), nudged))


def test_spacings_against_the_sform(tmp_path):
    image = nibabel.Nifti1Image(two_blocks(1, 2).astype(np.uint8), turned(0))
    image.set_qform(None, 0)
    image.header["pixdim"][1:4] = (1, 1, 1)
    image.to_filename(tmp_path / "a.nii")
    raw = bytearray((tmp_path / "a.nii").read_bytes())
    raw[80:92] = np.array([1, 1, 1], dtype="<f4").tobytes()  # pixdim
    (tmp_path / "a.nii").write_bytes(raw)
    facts, (_, err) = run_json("info", tmp_path / "a.nii", warns=True), run("info", tmp_path / "a.nii", warns=True)
    assert "the sform has the steps (2, 3, 4), but the spacings (pixdim) are (1, 1, 1); the sform is used" in err
    assert facts["grid"]["spacing"] == [2, 3, 4] and facts["warnings"][0]["code"] == "left-out"
    raw[80:92] = np.array([0, np.nan, 4], dtype="<f4").tobytes()  # not stated
    (tmp_path / "a.nii").write_bytes(raw)
    run("info", tmp_path / "a.nii")


def test_shear_is_named_with_a_remedy(tmp_path):
    sheared = turned(0)
    sheared[0, 1] = 0.3  # the y axis leans by atan(0.1)
    path = save(tmp_path / "a.nii", two_blocks(1, 2), sheared)
    raw = nibabel.load(path)
    raw.set_qform(None, 0)
    nibabel.save(raw, tmp_path / "s.nii")
    _, err = run("info", tmp_path / "s.nii", status=1)
    assert "its axes x and y form an angle of 84.2894 degrees, but must be perpendicular" in err
    assert "resample" in err and "SimpleITK.Resample" in err
    _, err = run("info", with_frames(tmp_path / "b.nii", sheared, turned(0)), warns=True)
    assert "the sform has shear: its axes x and y form an angle" in err and "the qform is used instead" in err


def nrrd(path, fields):
    path.write_bytes(
        f"NRRD0005\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n{fields}\n\n".encode() + bytes(range(24))
    )
    return path


DIRECTIONS = "space: left-posterior-superior\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (1,2,3)"


def test_nrrd_frames(tmp_path):
    _, err = run("info", nrrd(tmp_path / "a.nrrd", DIRECTIONS + "\nspacings: 2 3.5 4"), warns=True)
    assert "space directions and spacings disagree at axis 1: 3 and 3.5; the space directions are used" in err
    _, err = run("info", nrrd(tmp_path / "a.nrrd", DIRECTIONS + "\naxis mins: 1 2 9"), warns=True)
    assert "space origin and 'axis mins' disagree at axis 2: 3 and 9; the space origin is used" in err
    run("info", nrrd(tmp_path / "a.nrrd", DIRECTIONS + "\nspacings: 2 3 nan\naxis mins: nan 2 3"))
    sheared = "space dimension: 3\nspace directions: (2,0,0) (0.3,3,0) (0,0,4)\nspace origin: (1,2,3)"
    _, err = run("info", nrrd(tmp_path / "a.nrrd", sheared), status=1)
    assert "'space directions': its axes x and y form an angle of 84.2894 degrees" in err and "resample" in err


@pytest.mark.parametrize(
    "fields, spacing, origin",
    [
        ("axis mins: 10 20 30\naxis maxs: 12 26 42\ncenterings: cell cell cell", [1, 2, 3], [10.5, 21, 31.5]),
        ("axis mins: 10 20 30\naxis maxs: 12 26 42", [1, 2, 3], [10.5, 21, 31.5]),
        ("axis mins: 10 20 30\naxis maxs: 12 26 42\ncenterings: node node node", [2, 3, 4], [10, 20, 30]),
        ("axis mins: 10 20 30\naxis maxs: 12 26 42\nspacings: 1 nan 5", [1, 2, 5], [10, 21, 30]),
    ],
)
def test_nrrd_ranges_give_the_spacing(tmp_path, fields, spacing, origin):
    grid = run_json("info", nrrd(tmp_path / "a.nrrd", fields))["grid"]
    assert (grid["spacing"], grid["origin"]) == (spacing, origin)


def test_images_without_background_name_remedies(tmp_path):
    np.save(tmp_path / "full.npy", np.ones((4, 5, 6), dtype=np.uint8))
    _, err = run("field", tmp_path / "full.npy", "-o", tmp_path / "o.npz", status=1)
    assert "every voxel of the image differs from zero" in err
    assert "select some by label or threshold" in err and "numpy.pad(values, 1)" in err
    np.save(tmp_path / "padded.npy", np.pad(np.load(tmp_path / "full.npy"), 1))
    run("field", tmp_path / "padded.npy", "-o", tmp_path / "o.npz")


@pytest.mark.parametrize("options", [(), ("--sign", "none"), ("--band", "2"), ("--label", "1,2")])
def test_fields_of_images_without_sites(tmp_path, options):
    values = np.zeros((17, 33, 70), dtype=np.uint8)
    values[3:9, 4:30, 5:60] = 1
    values[5:12, 10:20, 40:66] = 2
    np.save(tmp_path / "a.npy", values)
    run("field", tmp_path / "a.npy", *options, "-o", tmp_path / "full.nrrd")
    report = run_json("field", tmp_path / "a.npy", *options, "--no-sites", "-o", tmp_path / "half.nrrd")
    ends = ["-label1", "-label2"] if "--label" in options else [""]
    for end in ends:
        distances = [(tmp_path / f"{name}{end}.nrrd").read_bytes()[-4 * values.size :] for name in ("full", "half")]
        assert distances[0] == distances[1] and len(set(np.frombuffer(distances[0], np.float32))) > 2
        assert (tmp_path / f"full{end}.site.nrrd").exists() and not (tmp_path / f"half{end}.site.nrrd").exists()
    assert all(field["sites"] is None for field in report["fields"])
    assert "--no-sites" in run("field", "--help")[0] and "Turn this off: store" in run("field", "--help")[0]
    # The sites of a replaced field are removed.
    removed = run_json("field", tmp_path / "a.npy", *options, "--no-sites", "-o", tmp_path / "full.nrrd")["removed"]
    wanted = [str(tmp_path / f"full{end}.site.nrrd") for end in ends]
    assert removed == (wanted[0] if len(wanted) == 1 else wanted)
    assert not any((tmp_path / f"full{end}.site.nrrd").exists() for end in ends)


def test_fields_warn_of_nrrd_frames_that_disagree(tmp_path):
    path, values = tmp_path / "a.nrrd", (np.linalg.norm(np.indices((9, 9, 9)) - 4.0, axis=0) - 2.6).astype(np.float32)
    frames = {"spacings: 1 2.5 1": True, "spacings: 1 1 1": False}
    for frame, warns in frames.items():
        path.write_bytes(
            b"NRRD0005\ntype: float\ndimension: 3\nsizes: 9 9 9\nencoding: raw\nendian: little\nspace dimension: 3\n"
            b"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nsign_rule:=winding\n"
            + frame.encode()
            + b"\n\n"
            + values.tobytes()
        )
        for command in (["info"], ["surface", "-o", tmp_path / "s.ply"], ["slice", "-o", tmp_path / "s.png"]):
            _, err = run(command[0], path, *command[1:], warns=warns)
            assert ("space directions and spacings disagree at axis 1: 1 and 2.5" in err) == warns, command
