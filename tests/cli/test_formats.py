"""Proves that `blum formats` lists the formats, and that each one has a fuzz target with a corpus."""

import pathlib

import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

CORPUS = pathlib.Path(__file__).parents[1] / "fuzz" / "corpus"


def test_formats_are_listed_for_people_and_programs():
    formats = run_json("formats")["formats"]
    contents = {"mesh", "image", "field", "complex", "points", "pairs", "collisions", "surface map", "graph"}
    assert contents | {"centreline", "extended axis", "path"} == {one["content"] for one in formats}
    text, _ = run("formats")
    for one in formats:
        assert one["extensions"] or one["written"]
        assert set(one["written"]) <= set(one["extensions"]) or not one["extensions"]  # else only written
        assert all(extension in text for extension in one["extensions"] + one["written"])
        assert one["holds"] in text and one["opens_in"] in text


def test_each_format_is_fuzzed():
    read = [one for one in run_json("formats")["formats"] if one["extensions"]]
    read = [one for one in read if one["content"] in {"mesh", "image", "field", "complex", "path"}]
    wanted = {f"fuzz_{one['content']}_{one['name'].lower()}" for one in read}
    wanted |= {"fuzz_queries_csv", "fuzz_points_csv", "fuzz_maps_npz"}  # the inputs of `blum ccd`, `query` and `view`
    assert wanted == {folder.name for folder in CORPUS.iterdir()}
    assert all(any(folder.iterdir()) for folder in CORPUS.iterdir())


VERBS = [
    ("field", ["m.ply"], ".npz"), ("slice", ["f.npz"], ".png"), ("make", ["box"], ".ply"), ("medial", ["m.ply"], ".npz"),
    ("reconstruct", ["a.npz"], ".ply"), ("surface", ["f.npz"], ".ply"), ("centreline", ["i.npy"], ".json"),
    ("query", ["m.ply", "p.csv"], ".npz"), ("sample", ["m.ply", "--count", "3"], ".npy"),
    ("surface-map", ["m.ply"], ".npz"), ("hausdorff", ["m.ply", "m.ply"], ".npz"), ("clean", ["m.ply"], ".ply"),
    ("voronoi", ["m.ply"], ".ply"), ("view", ["m.ply"], ".html"),
    ("plan", ["m.ply", "m.ply", "--start", "5,0,0,1,0,0,0", "--goal", "5,0,1,1,0,0,0"], ".json"),
    *[(f"proximity {query}", ["m.ply", "m.ply"], ".npz")
      for query in ("separation", "signed", "closest", "collide", "penetration", "continuous")],
]  # fmt: skip


def test_the_list_of_verbs_with_outputs_is_complete():
    listed = run("--help")[0].split("Subcommands:\n")[1].split("\n\n")[0]
    verbs = [line.split()[0] for line in listed.splitlines()]
    with_output = {verb for verb in verbs if "--output" in run(verb, "--help")[0]}
    assert with_output >= {"field", "medial", "surface-map"}
    assert with_output <= {verb.split()[0] for verb, _, _ in VERBS}


@pytest.mark.parametrize("verb, inputs, extension", VERBS, ids=[verb for verb, _, _ in VERBS])
def test_a_second_output_is_written_or_refused(tmp_path, verb, inputs, extension):
    """Only surface maps are written to several files; no other verb drops one of two outputs."""
    run("make", "box", "-o", tmp_path / "m.ply")
    outputs = ["-o", tmp_path / f"one{extension}", "-o", tmp_path / f"two{extension}"]
    given = [tmp_path / name if "." in name else name for name in inputs]
    if verb == "surface-map":
        run(verb, *given, "--self", *outputs)
        assert (tmp_path / "one.npz").exists() and (tmp_path / "two.npz").exists()
        return
    _, err = run(*verb.split(), *given, *outputs, status=2)
    assert "--output may be given only once" in err
    assert not list(tmp_path.glob("one*")) and not list(tmp_path.glob("two*"))
