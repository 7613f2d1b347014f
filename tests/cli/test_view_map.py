# Proves that pages of `blum view` hold surface maps exactly, and that damaged maps are rejected by name.
import numpy as np
import pytest

from scene import scene_of_page
from tool import BLUM, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    folder = tmp_path_factory.mktemp("maps")
    run("make", "box", "-o", folder / "box.obj")
    run("make", "sphere", "-o", folder / "ball.ply", "--radius", 0.6, "--frequency", 4)
    texel = ["--texel", 0.1]
    pair = ["surface-map", folder / "box.obj", folder / "ball.ply", *texel]
    run(*pair, "-o", folder / "signed.npz", "--sign", "auto", "--units", "mm")
    run(*pair, "-o", folder / "near.npz", "--max-distance", 0.1)
    run("surface-map", folder / "box.obj", *texel, "-o", folder / "ray.npz", "--thickness", "ray")
    return folder


@pytest.mark.parametrize("name", ["signed", "near", "ray"])
def test_a_page_holds_a_map_exactly(maps, tmp_path, name):
    page = tmp_path / "page.html"
    out, _ = run("view", maps / f"{name}.npz", maps / "ball.ply", "-o", page)
    assert f"{name}.npz (surface map), ball.ply (mesh)" in out
    scene = scene_of_page(page)
    item, mesh = scene.header["items"]
    assert item["kind"] == "map" and mesh["kind"] == "mesh"
    with np.load(maps / f"{name}.npz") as file:
        arrays = {key: file[key] for key in file.files}
    height, width = arrays["distance"].shape
    assert (item["width"], item["height"]) == (width, height)
    for ours, theirs in {"distance": "distance", "vectors": "vector", "sites": "site", "owners": "triangle",
                         "triangles": "triangles"}.items():
        found = scene.array(item[ours])
        assert found.tobytes() == arrays[theirs].tobytes(), ours
    places = scene.array(item["positions"]).reshape(-1, 3) + item["origin"]
    assert np.allclose(places, arrays["vertices"], atol=1e-6)
    assert np.array_equal(scene.array(item["corners"]), arrays["corners"].ravel().astype(np.float32))
    if name == "ray":
        assert "errors" not in item and "triangle_error" not in arrays
    else:
        assert np.array_equal(scene.array(item["errors"]), arrays["triangle_error"])
    finite = arrays["distance"][np.isfinite(arrays["distance"])]
    assert item["range"] == [finite.min(), finite.max()]
    assert item["signed"] == (name == "signed") and item["units"] == ("mm" if name == "signed" else "mesh units")
    assert item["quantity"] == ("ray-thickness" if name == "ray" else "distance")


def test_a_map_without_any_value_is_shown(maps, tmp_path):
    run("make", "sphere", "-o", tmp_path / "far.ply", "--radius", 50)
    run("surface-map", maps / "box.obj", tmp_path / "far.ply", "-o", tmp_path / "none.npz", "--max-distance", 1, warns=True)
    run("view", tmp_path / "none.npz", "-o", tmp_path / "page.html")
    item = scene_of_page(tmp_path / "page.html").header["items"][0]
    assert item["range"] is None and ["values", "none within reach"] in item["facts"]


def test_damaged_maps_are_named(maps, tmp_path):
    with np.load(maps / "ray.npz") as file:
        arrays = {key: file[key] for key in file.files}
    arrays["triangle"] = np.where(arrays["triangle"] == 0, 12, arrays["triangle"])
    np.savez(tmp_path / "bad.npz", **arrays)
    _, err = run("view", tmp_path / "bad.npz", "-o", tmp_path / "page.html", status=1)
    assert "bad.npz(triangle.npy)" in err and "triangle 12 is used" in err
    assert not (tmp_path / "page.html").exists()
