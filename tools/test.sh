#!/usr/bin/env bash
# `make test`: installs missing packages, builds, and runs every test: ctest's, including pytest, and a consumer of the
# installed library. Closes with `N passed, N failed[, N skipped]`. With RESULTS set, adds the counts to that folder and
# leaves the closing line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh --tests
results=${RESULTS:-build/results/test}
[[ -n ${RESULTS:-} ]] || rm -rf "$results"

options=(-DBLUM_TESTS=ON -DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/venv/bin/python")
[[ -n ${CI:-} ]] && options+=(-DBLUM_WERROR=ON)
tools/results.py check "$results" build -- tools/build.sh release "${options[@]}"
if [[ -f build/release/build.ninja ]]; then
  tools/results.py check "$results" public-headers -- tools/build.sh release "${options[@]}" -- blum_header_check
  tools/ctest.sh "$results" ctest build/release
  tools/results.py check "$results" install -- tests/install/run.sh build/release
fi

[[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
