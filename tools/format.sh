#!/usr/bin/env bash
# Formats every C++ file of the project with clang-format 19; with --check, only lists files that are not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.cpp' '*.hpp' '*.cu' '*.cuh')
if [[ ${1:-} == --check ]]; then
  if ! clang-format-19 --dry-run --Werror "${files[@]}"; then
    echo "format: run make format" >&2
    exit 1
  fi
else
  clang-format-19 -i "${files[@]}"
fi
if [[ ${1:-} != --check && -x build/venv/bin/ruff ]]; then build/venv/bin/ruff format --quiet; fi
echo "format: ${#files[@]} files"
