#!/usr/bin/env bash
# Formats every C++ file of the project with clang-format 19; with --check, only says which are not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.cpp' '*.hpp')
if [[ ${1:-} == --check ]]; then
  clang-format-19 --dry-run --Werror "${files[@]}"
else
  clang-format-19 -i "${files[@]}"
fi
if [[ ${1:-} != --check && -x build/venv/bin/ruff ]]; then
  mapfile -t python_files < <(git ls-files --cached --others --exclude-standard -- 'python/*.py' 'examples/python/*.py' \
    'tests/python/test_package_*.py' tests/python/conftest.py tests/python/wheel_smoke.py)
  build/venv/bin/ruff format --quiet "${python_files[@]}"
fi
echo "format: ${#files[@]} files"
