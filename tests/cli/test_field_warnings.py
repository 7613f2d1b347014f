# Proves that `blum field` warns of dubious meshes and rejects fields as input unless they have a threshold.
import pytest

from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


def test_warnings_go_to_stderr(tmp_path):
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    inverted, sheet = tmp_path / "inverted.obj", tmp_path / "sheet.obj"
    inverted.write_text(corners + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n")
    sheet.write_text(corners + "f 1 2 3\n")
    for mesh, words, code in [(inverted, "1 shell was reversed", "facing"), (sheet, "no node is inside", "nothing-inside")]:
        command = ["field", mesh, "-o", tmp_path / "out.nrrd", "--resolution", 8]
        out, err = run(*command, warns=True)
        assert words in err and "blum: warning" not in out
        (warning,) = run_json(*command, warns=True)["warnings"]
        assert words in warning["text"] and warning["code"] == code
        assert run(*command, "--quiet") == ("", "")
        assert run_json(*command, "--sign", "none")["warnings"] == []


def test_only_wrongly_nested_shells_cause_a_warning_about_facing(shapes, tmp_path):
    """Winding numbers unite overlapping parts. A part inside another part must face the other way."""
    run("make", "box", "-o", tmp_path / "box.obj")
    corners = [line for line in (tmp_path / "box.obj").read_text().splitlines() if line.startswith("v ")]
    faces = [line for line in (tmp_path / "box.obj").read_text().splitlines() if line.startswith("f ")]
    places = [[float(x) for x in line.split()[1:]] for line in corners]

    def with_copy(scale, by):
        copy = [" ".join(["v", *(repr(scale * x + d) for x, d in zip(p, by, strict=True))]) for p in places]
        more = [" ".join(["f", *(str(int(k) + len(places)) for k in line.split()[1:])]) for line in faces]
        (tmp_path / "two.obj").write_text("\n".join([*corners, *copy, *faces, *more]) + "\n")
        return ["field", tmp_path / "two.obj", "-o", tmp_path / "two.npz", "--resolution", 12]

    summary = run_json(*with_copy(1, (0.3, 0.2, 0.1)))
    assert summary["warnings"] == [] and "crosses or touches itself" in summary["fields"][0]["sign"]["reason"]
    out, err = run(*with_copy(0.5, (0, 0, 0)), warns=True)
    assert "face the wrong way" in err and "do not all face away" in out


def test_a_field_is_an_image_only_with_a_threshold(shapes, tmp_path):
    for end in ("nrrd", "npz"):
        run("field", shapes / "torus.obj", "-o", tmp_path / f"t.{end}", "--resolution", 12)
        err = run("field", tmp_path / f"t.{end}", "-o", tmp_path / "out.npz", status=1)[1]
        assert "is a field; a mesh or a voxel image is needed here" in err and ("--threshold" in err) == (end == "nrrd")
    run("field", tmp_path / "t.nrrd", "-o", tmp_path / "out.npz", "--threshold", 0)
