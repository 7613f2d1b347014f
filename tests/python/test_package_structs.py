"""Proves that Python's options and results match the library's description: names, types, defaults and documentation.

Messages and the keys of the tool's JSON match, too."""

import copy
import dataclasses
import inspect
import json
import os
import pathlib
import pickle
import subprocess
import typing

import blum
import numpy as np
import pytest
from blum import _core, _structs

TOOL = os.environ.get("BLUM", pathlib.Path(blum.__file__).parent / "_bin" / "blum")


def keys(value):
    return {field.name for field in dataclasses.fields(value)}


def tool_json(*words):
    return json.loads(subprocess.run([TOOL, *map(str, words), "--json", "-"], check=True, capture_output=True).stdout)


@pytest.mark.parametrize("name", _structs.__all__)
def test_types_match_the_library(name):
    told = _core.described[name]
    made = getattr(blum, name)
    assert made is getattr(_structs, name) and made.__doc__ == told["doc"] + "."
    kinds = {key: getattr(kind, "__forward_arg__", kind) for key, kind in made.__annotations__.items()}
    named = {"MedialAxisOptions": {"spacing"}}.get(name, ())  # the functions take these by name
    assert kinds == {member[0]: member[1] for member in told["members"] if member[0] not in named}
    assert dataclasses.is_dataclass(made) != told["is_options"]
    for member, _, _, _, doc in told["members"]:
        assert doc and not doc.endswith("."), f"{name}.{member}"


@pytest.mark.parametrize(
    ("taker", "options", "left_out"),
    [
        (blum.distance_field, "FieldOptions", ()),
        (blum.FieldSolver, "FieldOptions", ()),
        (blum.DeviceFieldSolver, "FieldOptions", ()),
        (blum.ClosestPointQuery, "ClosestPointOptions", ()),
        (blum.closest_points, "ClosestPointOptions", ()),
        (blum.distance_transform, "DistanceTransformOptions", ()),
        (blum.distance_transforms, "DistanceTransformOptions", ("label", "threshold")),
        (blum.medial_axis, "MedialAxisOptions", ("spacing",)),
        (blum.certify, "CertificateOptions", ()),
        (blum.Solid.model, "CellularModelOptions", ()),
    ],
)
def test_signatures_name_options_with_their_defaults(taker, options, left_out):
    parameters = inspect.signature(taker).parameters
    assert not any(each.kind is each.VAR_KEYWORD for each in parameters.values())
    for name, kind, default, _, doc in _core.described[options]["members"]:
        if name in left_out:
            continue
        assert parameters[name].default == default
        if kind in _core.enums:
            assert typing.get_args(parameters[name].annotation) == _core.enums[kind]
        else:
            assert parameters[name].annotation not in (inspect.Parameter.empty, kind)
        assert doc[1:30] in " ".join(inspect.getdoc(taker).split()) or taker is blum.DeviceFieldSolver


def test_wrong_options_are_named():
    box = blum.generate("box")
    with pytest.raises(TypeError, match=r"distance_field\(\) has no option 'sgn': did you mean 'sign'\?"):
        blum.distance_field(box, resolution=8, sgn="auto")
    with pytest.raises(blum.InvalidOption, match="sign is 'maybe', but must be 'auto', 'normals', 'winding' or 'none'"):
        blum.closest_points(box, [[0, 0, 0]], sign="maybe")
    with pytest.raises(blum.InvalidOption, match="site_ids is 'voxels', but must be 'features' or 'triangles'"):
        blum.FieldSolver(blum.Grid.around(box, resolution=8), site_ids="voxels")
    with pytest.raises(TypeError, match="band must be a number"):
        blum.distance_field(box, resolution=8, band=True)


def test_a_label_excludes_a_threshold_everywhere(tmp_path):
    image = blum.generate("ball_image", size=12)
    image.write(tmp_path / "ball.nrrd")
    axis = blum.medial_axis(image).simplify(60)
    for call in (
        lambda: blum.distance_transform(image, label=1, threshold=1),
        lambda: blum.selected_voxels(image, label=1, threshold=1),
        lambda: blum.medial_axis(image, label=1, threshold=1),
        lambda: blum.certify(axis, image, label=1, threshold=1),
    ):
        with pytest.raises(blum.InvalidOption, match="label and threshold exclude each other: each"):
            call()
    both = ["--label", "1", "--threshold", "1"]
    for verb in (["field", "ball.nrrd", "-o", "f.npz"], ["medial", "ball.nrrd", "-o", "a.npz"]):
        done = subprocess.run([TOOL, *verb, *both], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert "--label and --threshold exclude each other: each selects the voxels" in done.stderr


def test_keys_of_json_are_names_in_python(tmp_path):
    torus = blum.generate("torus")
    torus.write(tmp_path / "torus.ply")
    told = tool_json("info", tmp_path / "torus.ply")
    found = blum.topology(torus)
    assert keys(found) <= told.keys() and keys(found.shells[0]) == told["shells"][0].keys()
    assert told["betti"] == list(found.betti) and told["components"] == found.components == 1
    axis = blum.medial_axis(torus, resolution=32)
    (solid,) = tool_json("medial", tmp_path / "torus.ply", "-o", tmp_path / "a.npz", "--resolution", 32)["solids"]
    assert keys(axis.report) - {"seconds", "warnings"} <= solid.keys()
    assert keys(axis.report.bodies[0]) == solid["bodies"][0].keys()
    certificate = solid["axes"][0]["certificate"]
    mine = axis.simplify(60).certificate
    assert keys(mine) - {"holds"} <= certificate.keys() and certificate["certified"] is mine.holds is True
    for part in ("geometry", "edges", "balls"):
        assert keys(getattr(mine, part)) == certificate[part].keys()


def test_results_print_compare_and_pickle():
    found = blum.topology(blum.generate("box"))
    assert repr(found.shells[0]).startswith("Shell(triangles=12, bounds=((-0.5")
    for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert again == found and again.shells == found.shells
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.vertices = 3


def test_labels_are_listed_and_missing_ones_named(tmp_path):
    values = np.zeros((4, 5, 6), np.uint8)
    values[1, 1, 1:3], values[3, 3, 3] = 2, 1
    image = blum.Image(values, spacing=(1, 1, 0.5))
    told = image.labels()
    assert told.distinct == 3 and told.range == (0, 2) and told.nonzero == 3
    assert told.labels[1] == blum.LabelFacts(label=2, voxels=2, volume=1.0, betti=(1, 0, 0))
    assert [each.label for each in image.labels(1).labels] == [0]
    image.write(tmp_path / "image.nrrd")
    shown = tool_json("info", tmp_path / "image.nrrd")
    assert keys(told) <= shown.keys() and shown["labels"][1] == {
        "label": 2,
        "voxels": 2,
        "volume": 1,
        "betti": [1, 0, 0],
    }
    text = subprocess.run([TOOL, "info", tmp_path / "image.nrrd"], capture_output=True, text=True, check=True).stdout
    assert "2 voxels, volume 1: 1 component, 0 tunnels, 0 voids" in text
    message = "no voxel of the image has the label 7: its labels are 1 and 2"
    for call in (blum.distance_transform, blum.medial_axis):
        with pytest.raises(blum.InvalidImage, match=message):
            call(image, label=7)
    done = subprocess.run(
        [TOOL, "field", "image.nrrd", "-o", "f.npz", "--label", "7"], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 1 and message in done.stderr


def test_auto_states_the_reason_for_the_cpu():
    field = blum.distance_field(blum.generate("box"), resolution=8, device="auto")
    mask = np.zeros((3, 3, 3), bool)
    mask[1] = True
    image = blum.distance_transform(mask, device="auto")
    for each in (field, image):
        assert bool(each.device_reason) == (each.device == "cpu")
    assert blum.distance_field(blum.generate("box"), resolution=8).device_reason == ""


def test_devices_are_listed_or_their_absence_has_a_reason():
    found = blum.cuda_devices()
    assert bool(found.devices) != bool(found.reason)
    told = tool_json("info", "--devices")
    assert told["reason"][:40] == found.reason[:40] and len(told["devices"]) == len(found.devices)
    both = subprocess.run([TOOL, "info", "--devices", "part.stl"], capture_output=True, text=True, check=False)
    assert both.returncode == 2 and "--devices and INPUT exclude each other" in both.stderr
