"""Proves that `blum proximity translation` reports the least translation that separates two solids."""

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def boxes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("boxes")
    run("make", "box", "-o", folder / "box.ply")
    run("make", "box", "-o", folder / "long.ply", "--size-x", 1.5)
    return folder / "box.ply", folder / "long.ply"


def test_bounds_and_translation_are_reported(boxes):
    found = run_json("proximity", "translation", *boxes)
    assert found["are_convex"] and found["lower"] <= 1 <= found["upper"] <= found["lower"] + 1e-13
    assert np.isclose(np.linalg.norm(found["translation"]), 1)
    text, _ = run("proximity", "translation", *boxes)
    assert text.startswith("least translation  1 (interval ") and "leaves long.ply" in text


def test_wrong_arguments_are_rejected(boxes, tmp_path):
    assert "translation-tolerance" in run("proximity", "translation", *boxes, "--translation-tolerance", 2, status=2)[1]
    assert "none.ply" in run("proximity", "translation", boxes[0], tmp_path / "none.ply", status=1)[1]
