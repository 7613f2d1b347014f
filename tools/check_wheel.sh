#!/usr/bin/env bash
# `pip install .` as a user does it, and a wheel that works where the sources are not: builds a wheel with all that pip
# brings, installs it in a new virtual environment, and uses the package and the tool from another folder.
#   tools/check_wheel.sh [PYTHON]   an interpreter of 3.11 or newer (default python3)
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/cache.sh

tools/setup.sh --tests
python=${1:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# The compiler by the name that the other builds use, so that they share a compiler cache.
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
