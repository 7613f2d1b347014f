#!/usr/bin/env bash
# `make bench`: builds and runs every benchmark with its peers. Writes the figures as JSON to out/bench, as tables to
# docs/generated/performance.md and as plots to docs/pictures.
#   tools/bench.sh [PROGRAM ...]   runs only these, without a report: field_bench, image_peers, skeleton_peers, ...
# BENCH_OPTIONS: options for Google Benchmark, for example BENCH_OPTIONS=--benchmark_filter=bunny.
# BLUM_BENCH_PEER_NODES=all: peers compute every node, which may take minutes. By default they compute 2,200,000 evenly
# spread nodes, and the time is scaled.
# BLUM_BENCH_RUNS: runs per case (default: 25 below 0.3 s, 5 below 2 s, 3 below 20 s, else 1).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh --bench
tools/build.sh bench
out=out/bench
mkdir -p "$out"

programs=("$@")
if [[ ${#programs[@]} -eq 0 ]]; then
  for source in bench/*_bench.cpp; do programs+=("$(basename "$source" .cpp)"); done
  programs+=(image_peers skeleton_peers)
fi
read -r -a options <<<"${BENCH_OPTIONS:-}"
export BLUM_DISTANCE_TRANSFORM_SAMPLE="$PWD/build/bench/bin/distance_transform_sample"
echo "bench: $(nproc) cores, load $(cut -d ' ' -f 1-3 /proc/loadavg), $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
for program in "${programs[@]}"; do
  echo "--- bench: $program"
  if [[ $program == image_peers ]]; then
    build/venv/bin/python bench/peers/image_peers.py --json "$out/image_peers.json"
    continue
  fi
  if [[ $program == skeleton_peers ]]; then
    for shape in bumpy organs pores; do
      # The slow peers run only one shape; ITK alone takes nine minutes for it.
      peers=scikit-image
      if [[ $shape == bumpy ]]; then peers=scikit-image,kimimaro,itk; fi
      BLUM_CLI="$PWD/build/bench/bin/blum" build/venv/bin/python bench/peers/skeleton_peers.py --shape "$shape" \
        --peers "$peers" --json "$out/skeleton_peers_$shape.json"
    done
    continue
  fi
  "build/bench/bin/$program" --benchmark_out="$out/$program.json" --benchmark_out_format=json "${options[@]}"
done
if [[ $# -eq 0 ]]; then
  build/venv/bin/python tools/bench_report.py "$out"
fi
echo "bench: figures in $out"
