#!/usr/bin/env bash
# `make fuzz`: builds the libFuzzer targets with clang and runs each for FUZZ_SECONDS (15), from its corpus.
# build/fuzz/corpus collects new inputs of all runs; build/fuzz/findings keeps each input that breaks a reader.
# With RESULTS set, adds the counts to that folder and leaves the closing line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh --fuzz
results=${RESULTS:-build/results/fuzz}
[[ -n ${RESULTS:-} ]] || rm -rf "$results"
mkdir -p build/fuzz/findings

run_target() {
  local target=$1 grown=build/fuzz/corpus/$1 seeds=tests/fuzz/corpus/$1
  mkdir -p "$grown"
  local folders=("$grown")
  [[ -d $seeds ]] && folders+=("$seeds")
  # The limits also report short headers that make a reader allocate much memory.
  "build/fuzz/bin/$target" -max_total_time="${FUZZ_SECONDS:-15}" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
    -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$target-" "${folders[@]}" >"build/fuzz/$target.log" 2>&1 ||
    {
      tail -n 60 "build/fuzz/$target.log"
      return 1
    }
  grep -E 'number_of_executed_units|peak_rss_mb' "build/fuzz/$target.log" | sed "s/^stat::/$target: /"
}
export -f run_target

tools/results.py check "$results" fuzz-build -- tools/build.sh fuzz -DBLUM_WERROR=ON
# Runs one target for each core in parallel.
# shellcheck disable=SC2016  # $0 is the inner shell's
for folder in tests/fuzz/corpus/*; do basename "$folder"; done |
  xargs -P "${JOBS:-$(nproc)}" -I '{}' tools/results.py check "$results" '{}' -- \
    bash -c 'set -euo pipefail; run_target "$0"' '{}'
[[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
