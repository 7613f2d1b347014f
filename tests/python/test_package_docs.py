"""Proves that the examples in docstrings and in examples/python run, and that the package is typed."""

import doctest
import functools
import importlib.util
import os
import pathlib
import pkgutil
import re
import subprocess
import sys

import pytest

blum = pytest.importorskip("blum")

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = [module.name for module in pkgutil.iter_modules(blum.__path__) if module.name != "_core"]


@pytest.mark.parametrize("module", MODULES)
def test_docstrings_are_true(module):
    result = doctest.testmod(importlib.import_module(f"blum.{module}"))
    assert result.failed == 0


def test_every_public_name_has_a_docstring():
    public = {
        name: getattr(blum, name) for name in blum.__all__ if name not in ("ROLES", "__version__", "thread_count")
    }
    assert not [name for name, value in public.items() if not value.__doc__]
    for name, value in public.items():
        if isinstance(value, type):
            methods = {key: member for key, member in vars(value).items() if callable(member) and key[0] != "_"}
            assert not [f"{name}.{key}" for key, member in methods.items() if not member.__doc__]
            getters = {
                key: getattr(member, "fget", None) or getattr(member, "func", None)
                for key, member in vars(value).items()
                if isinstance(member, (property, functools.cached_property)) and key[0] != "_"
            }
            assert not [f"{name}.{key}" for key, getter in getters.items() if not getter.__doc__]


@pytest.mark.parametrize("example", sorted(path.name for path in (ROOT / "examples/python").glob("*.py")))
def test_examples_run(example, tmp_path):
    if example == "field_slices.py":
        pytest.importorskip("matplotlib")
    out = (
        tmp_path
        / {
            "field_slices.py": "out.png",
            "medial_axis_of_part.py": "out.vtp",
            "thickness_of_image.py": "out.nrrd",
            "clearance_of_scene.py": "out.csv",
            "clearance_of_arm.py": "out.csv",
            "candidates_for_ipctk.py": "out.csv",
        }[example]
    )
    smaller = ["--resolution", "64"] if example in ("field_slices.py", "medial_axis_of_part.py") else []
    done = subprocess.run(
        [sys.executable, ROOT / "examples/python" / example, "-o", out, *smaller],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    if example == "candidates_for_ipctk.py" and importlib.util.find_spec("ipctk") is None:
        assert done.stdout == "skipped: ipctk is not installed; pip install ipctk\n" and not out.exists()
        return
    assert out.stat().st_size > 1000 and f"wrote {out}" in done.stdout


@pytest.mark.parametrize(
    ("example", "arguments", "message"),
    [
        ("clearance_of_arm.py", ["--steps", "0"], "--steps is 0, but must be at least 1"),
        ("clearance_of_scene.py", ["--steps", "-1"], "--steps is -1, but must be at least 1"),
        ("candidates_for_ipctk.py", ["--dhat", "-1"], "--dhat is -1.0, but must be a distance above 0"),
        *((f"clearance_of_{what}.py", ["absent.ply"], "error: [Errno 2]") for what in ("arm", "scene")),
        *(
            (f"{name}.py", ["-o", "absent/out.csv"], "-o absent/out.csv: its folder is not there")
            for name in ("clearance_of_arm", "clearance_of_scene", "candidates_for_ipctk")
        ),
    ],
)
def test_examples_report_wrong_arguments(example, arguments, message, tmp_path):
    command = [sys.executable, ROOT / "examples/python" / example, *arguments]
    package = {**os.environ, "PYTHONPATH": str(pathlib.Path(blum.__file__).parents[1].resolve())}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=package)
    assert done.returncode in (1, 2) and message in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_the_code_of_the_guide_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    pieces = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/guide/python.md").read_text(), re.MULTILINE | re.DOTALL)
    names = {}
    for piece in pieces:
        exec(compile(piece, "docs/guide/python.md", "exec"), names)
    assert len(pieces) > 5
    assert "triangles[0, 2] is 7, but must be 0 to 3" in capsys.readouterr().out


def test_the_table_of_verbs_is_complete():
    text = (ROOT / "docs/guide/verbs.md").read_text()
    named = set(re.findall(r"`blum\.(\w+)", text))
    assert not {name for name in named if not hasattr(blum, name)}
    verbs = {name for name in blum.__all__ if callable(getattr(blum, name)) and name[0].islower()}
    assert not verbs - named - {"thread_count"}
    tool = subprocess.run([os.environ["BLUM_CLI"], "--help"], capture_output=True, text=True, check=True).stdout
    commands = re.findall(r"^  (\w+)  ", tool.split("Subcommands:")[1].split("Examples:")[0], re.M)
    assert len(commands) > 5 and not [name for name in commands if f"`blum {name}" not in text]


def test_types_hold_under_mypy_strict(tmp_path):
    pytest.importorskip("mypy")
    user = tmp_path / "user.py"
    user.write_text(
        "import blum\nimport numpy as np\n"
        "field: blum.Field = blum.distance_field(np.zeros((3, 3)), np.zeros((1, 3), dtype=int), resolution=8)\n"
        "inside: np.ndarray[tuple[int, ...], np.dtype[np.bool_]] = field.distance < 0\n"
        "piece: blum.MedialComplex = blum.medial_axis('part.stl').simplify(60)\n"
        "holds: bool = piece.certificate.holds\n"
        "wrong: int = piece.radius  # type: ignore[assignment]\n"
        "near: blum.Field = blum.distance_field(np.zeros((3, 3)), band=np.float32(2), sign='none')\n"
        "outside: int = blum.medial_axis('part.stl', lambda_=2).simplify().certificate.geometry.outside\n"
        "blum.distance_field(np.zeros((3, 3)), sign='maybe')  # type: ignore[arg-type]\n"
        "blum.distance_field(np.zeros((3, 3)), sgn='none')  # type: ignore[call-arg]\n"
    )
    package = pathlib.Path(blum.__file__).parent
    assert (package / "_core.pyi").is_file(), "build the target blum_python_stub first"
    environment = {**os.environ, "MYPYPATH": str(package.parent)}
    for arguments in (["-p", "blum"], [str(user)]):
        done = subprocess.run(
            [
                sys.executable,
                "-m",
                "mypy",
                "--strict",
                "--cache-dir",
                str(tmp_path / "cache"),
                "--config-file",
                str(ROOT / "pyproject.toml"),
                *arguments,
            ],
            capture_output=True,
            text=True,
            check=False,
            env=environment,
            cwd=tmp_path,
        )
        assert done.returncode == 0, done.stdout
