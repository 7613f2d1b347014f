#!/usr/bin/env bash
# Configures and builds one preset of CMakePresets.json.
#   tools/build.sh PRESET [-Doption=value ...] [-- target ...]
# JOBS in the environment limits how many compilers run at once.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/cache.sh

preset=$1
shift
options=()
targets=()
while [[ $# -gt 0 && $1 != -- ]]; do
  options+=("$1")
  shift
done
[[ $# -gt 0 ]] && shift && targets=("$@")

echo "build: configuring build/$preset"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset "$preset" "${options[@]}" >"$log" 2>&1; then
  cat "$log"
  exit 1
fi
echo "build: compiling build/$preset"
cmake --build "build/$preset" --parallel "${JOBS:-$(nproc)}" ${targets[0]:+--target "${targets[@]}"}
