#!/usr/bin/env bash
# Checks `pip install .` and that the wheel works without the sources. Builds a wheel with pip's own build environment,
# installs it in a new virtual environment, and uses the package and the tool from another folder.
#   tools/check_wheel.sh [PYTHON]   an interpreter of 3.11 or newer (default python3)
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/cache.sh

tools/setup.sh --tests
python=${1:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# Names the compiler as the other builds do, so that they share a compiler cache.
options=()
[[ -n ${CI:-} ]] && options+=(--config-settings=cmake.define.BLUM_WERROR=ON)
"$python" -m venv "$folder/venv"
CC=${CC:-cc} CXX=${CXX:-c++} "$folder/venv/bin/pip" wheel . --no-deps --quiet --disable-pip-version-check \
  --wheel-dir "$folder" --config-settings=build-dir=build/wheel "${options[@]}"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check "$folder"/blum-*.whl
cp examples/python/medial_axis_of_part.py tests/python/wheel_smoke.py "$folder"
cd "$folder"
ls -l blum-*.whl
venv/bin/blum --version
venv/bin/blum make torus -o torus.ply
venv/bin/python wheel_smoke.py torus.ply
venv/bin/python medial_axis_of_part.py torus.ply --resolution 48
