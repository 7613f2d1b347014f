"""Proves that blum.view() writes the page of the tool and names arguments that it cannot show."""

import webbrowser

import numpy as np
import pytest

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def part():
    return blum.generate("bracket")


def items(page):
    """Names and kinds of the items of a page."""
    import scene

    return [(item["name"], item["kind"]) for item in scene.scene_of_page(page).header["items"]]


def test_a_page_shows_everything_that_blum_makes(part, tmp_path):
    axis = blum.medial_axis(part, resolution=24)
    part.write(tmp_path / "part of mine.stl")
    page = blum.view(
        part,
        (part.vertices, part.triangles),
        blum.distance_field(part, resolution=24),
        axis,
        axis.simplify(60),
        np.ones((4, 4, 4), dtype=np.uint8),
        tmp_path / "part of mine.stl",
        output=tmp_path / "page.html",
    )
    assert page == tmp_path / "page.html"
    assert items(page) == [
        ("mesh.ply", "mesh"),
        ("mesh 2.ply", "mesh"),
        ("field.npz", "field"),
        ("axis.npz", "axis"),
        ("axis 2.npz", "axis"),
        ("image.nrrd", "image"),
        ("part of mine.stl", "mesh"),
    ]


def test_a_page_shows_surface_maps_exactly(part, tmp_path):
    import scene

    ball = blum.generate("sphere")
    maps = [blum.surface_distance_map(part, ball, texel=0.1, sign="winding"), blum.thickness_map(part, texel=0.1)]
    page = blum.view(*maps, ball, output=tmp_path / "page.html")
    assert items(page) == [("map.npz", "map"), ("map 2.npz", "map"), ("mesh.ply", "mesh")]
    shown = scene.scene_of_page(page)
    for made, item in zip(maps, shown.header["items"], strict=False):
        assert item["quantity"] == made.quantity and item["signed"] == (made.sign_rule != "none")
        assert shown.array(item["distance"]).tobytes() == made.distance.tobytes()
        assert shown.array(item["vectors"]).tobytes() == made.vector.tobytes()
        assert np.array_equal(shown.array(item["owners"]), made.triangle.ravel())
        assert ("errors" in item) == (made.error is not None)


def test_a_page_opens_without_an_output_or_on_request(part, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    blum.view(part, output=tmp_path / "page.html")
    assert opened == []
    blum.view(part, output=tmp_path / "page.html", show=True)
    page = blum.view(part)
    assert opened == [(tmp_path / "page.html").as_uri(), page.as_uri()] and page.exists()


@pytest.mark.parametrize(
    ("things", "error", "text"),
    [
        ((), ValueError, "at least one"),
        ((3,), TypeError, r"things\[0\]"),
        (("there is no such.ply",), FileNotFoundError, "no such"),
        ((np.full((2, 2, 2), "a"),), TypeError, "image"),
    ],
)
def test_unsupported_arguments_are_named(things, error, text, tmp_path):
    with pytest.raises(error, match=text):
        blum.view(*things, output=tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()


def test_a_broken_file_is_named_and_leaves_the_page_as_it_was(part, tmp_path):
    (tmp_path / "broken.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    page = tmp_path / "page.html"
    page.write_text("mine")
    with pytest.raises(OSError, match=r"broken\.ply") as caught:
        blum.view(tmp_path / "broken.ply", output=page)
    assert str(caught.value).startswith("'") and "error:" not in str(caught.value)
    assert page.read_text() == "mine"
    for wrong in ("page.txt", "page"):
        with pytest.raises(ValueError, match="output"):
            blum.view(part, output=tmp_path / wrong)
    with pytest.raises(OSError, match="folder"):
        blum.view(part, output=tmp_path / "no folder" / "page.html")


def test_keywords_name_the_items(part, tmp_path):
    page = blum.view(part, part=part, distance=blum.distance_field(part, resolution=16), output=tmp_path / "page.html")
    assert items(page) == [("mesh.ply", "mesh"), ("part.ply", "mesh"), ("distance.npz", "field")]
    with pytest.raises(TypeError, match="wrong is a int"):
        blum.view(wrong=3, output=page)
    with pytest.raises(TypeError, match="MedialAxis"):
        blum.view(blum.medial_axis(part, resolution=16).nested(), output=page)


def test_a_killed_tool_is_reported(part, tmp_path, monkeypatch):
    import blum._view

    killed = tmp_path / "blum"
    killed.write_text("#!/bin/sh\nkill -9 $$\n")
    killed.chmod(0o755)
    monkeypatch.setattr(blum._view, "_TOOL", killed)
    with pytest.raises(blum.Error, match="signal 9"):
        blum.view(part, output=tmp_path / "page.html")
    monkeypatch.setattr(blum._view, "_TOOL", tmp_path / "missing")
    with pytest.raises(blum.Error, match="not installed"):
        blum.view(part, output=tmp_path / "page.html")
