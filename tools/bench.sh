#!/usr/bin/env bash
# `make bench`: builds every benchmark with its peers, runs it, and leaves its figures as JSON in out/bench.
#   tools/bench.sh [PROGRAM ...]   only these, for example distance_transform_bench
# Options for Google Benchmark go into BENCH_OPTIONS, for example BENCH_OPTIONS=--benchmark_filter=bunny.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh --bench
tools/build.sh bench
out=out/bench
mkdir -p "$out"

programs=("$@")
if [[ ${#programs[@]} -eq 0 ]]; then
  for source in bench/*_bench.cpp; do programs+=("$(basename "$source" .cpp)"); done
fi
read -r -a options <<<"${BENCH_OPTIONS:-}"
echo "bench: $(nproc) cores, load $(cut -d ' ' -f 1-3 /proc/loadavg), $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
for program in "${programs[@]}"; do
  echo "--- bench: $program"
  "build/bench/bin/$program" --benchmark_out="$out/$program.json" --benchmark_out_format=json "${options[@]}"
done
if [[ -f bench/run.py && $# -eq 0 ]]; then
  build/venv/bin/python bench/run.py
fi
echo "bench: figures in $out"
