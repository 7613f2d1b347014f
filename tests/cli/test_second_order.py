# Proves that `blum field --order 2` writes and summarizes second distances and sites in every format.

import numpy as np
import pytest

from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.mark.parametrize("end", ["nrrd", "npz", "vti"])
def test_fields_of_order_2(shapes, tmp_path, end):
    given = (shapes / "sphere.ply", "--resolution", 20)
    first = run_json("field", *given, "-o", tmp_path / f"first.{end}")
    summary = run_json("field", *given, "--order", 2, "-o", tmp_path / f"a.{end}")
    assert first["fields"][0]["second"] is None
    (field,) = summary["fields"]
    assert field["distance"] == first["fields"][0]["distance"]
    assert field["second"]["rule"] == "no-common-vertex" and field["second"]["nodes_without"] == 0
    assert 0 < field["second"]["minimum"] < field["second"]["maximum"]
    names = ["a.nrrd", "a.site.nrrd", "a.distance2.nrrd", "a.site2.nrrd"] if end == "nrrd" else [f"a.{end}"]
    assert field["files"] == [str(tmp_path / name) for name in names]
    assert all((tmp_path / name).exists() for name in names)
    if end == "npz":
        with np.load(tmp_path / "a.npz") as file:
            second, sites = file["distance2"], file["site2"]
            assert (second >= np.abs(file["distance"])).all() and (sites >= 0).all()
            assert field["second"]["minimum"] == pytest.approx(float(second.min()))
            assert field["second"]["maximum"] == pytest.approx(float(second.max()))
            corners = file["site_vertices"]
            shared = (corners[file["site"]][..., :, None] == corners[sites][..., None, :])
            assert not (shared & (corners[file["site"]] >= 0)[..., :, None]).any()
    if end == "nrrd":
        for name in ("a.distance2.nrrd", "a.site2.nrrd"):
            assert "a.nrrd" in run("info", tmp_path / name, status=1)[1]
        text, _ = run("field", *given, "-o", tmp_path / "a.nrrd")
        assert "a.distance2.nrrd: second order of the replaced field" in text
        assert not (tmp_path / "a.distance2.nrrd").exists() and not (tmp_path / "a.site2.nrrd").exists()


def test_second_sites_of_other_objects(shapes, tmp_path):
    summary = run_json("field", shapes / "sphere.ply", "-o", tmp_path / "alone.npz", "--resolution", 12, "--order", 2,
                       "--second", "other-object")
    second = summary["fields"][0]["second"]
    assert second == {"rule": "other-object", "minimum": None, "maximum": None, "nodes_without": 12**3}
    with np.load(tmp_path / "alone.npz") as file:
        assert np.isinf(file["distance2"]).all() and (file["site2"] == -1).all()
    out = ("-o", tmp_path / "x.npz")
    assert "--order 2" in run("field", shapes / "sphere.ply", *out, "--second", "other-object", status=2)[1]
    assert "--order" in run("field", shapes / "sphere.ply", *out, "--order", 3, status=2)[1]
    assert "CPU" in run("field", shapes / "sphere.ply", *out, "--order", 2, "--device", "cuda", status=2)[1]
