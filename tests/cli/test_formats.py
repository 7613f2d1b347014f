"""Proves that `blum formats` lists the formats, and that each one has a fuzz target with a corpus."""

import pathlib

import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

CORPUS = pathlib.Path(__file__).parents[1] / "fuzz" / "corpus"


def test_formats_are_listed_for_people_and_programs():
    formats = run_json("formats")["formats"]
    contents = {"mesh", "image", "field", "complex", "points", "pairs", "collisions", "surface map", "graph"}
    assert contents | {"centreline", "extended axis"} == {one["content"] for one in formats}
    text, _ = run("formats")
    for one in formats:
        assert one["extensions"] or one["written"]
        assert set(one["written"]) <= set(one["extensions"]) or not one["extensions"]  # else only written
        assert all(extension in text for extension in one["extensions"] + one["written"])
        assert one["holds"] in text and one["opens_in"] in text


def test_each_format_is_fuzzed():
    read = [one for one in run_json("formats")["formats"] if one["extensions"]]
    read = [one for one in read if one["content"] in {"mesh", "image", "field", "complex"}]
    wanted = {f"fuzz_{one['content']}_{one['name'].lower()}" for one in read}
    wanted |= {"fuzz_queries_csv", "fuzz_points_csv", "fuzz_maps_npz"}  # the inputs of `blum ccd`, `query` and `view`
    assert wanted == {folder.name for folder in CORPUS.iterdir()}
    assert all(any(folder.iterdir()) for folder in CORPUS.iterdir())
