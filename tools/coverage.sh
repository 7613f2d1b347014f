#!/usr/bin/env bash
# `make coverage`: prints the share of lines that tests labelled fast run, by layer and in total (g++ --coverage, gcov).
#   tools/coverage.sh [LAYER ...]   only these layers, by their own tests, test_LAYER: much faster
# Low figures are not a failure. build/coverage/missed.txt lists the lines that no test runs.
set -euo pipefail
cd "$(dirname "$0")/.."

targets=()
tests=(--label-regex '^fast$')
if [[ $# -gt 0 ]]; then
  targets=(--)
  for layer in "$@"; do
    if [[ ! -d tests/unit/$layer ]]; then
      echo "coverage: there is no layer $layer; there are: $(cd tests/unit && echo *)" >&2
      exit 2
    fi
    targets+=("test_$layer")
  done
  tests+=(--tests-regex "^test_($(IFS='|' && echo "$*"))\\.")
fi

tools/setup.sh --tests
tools/build.sh coverage -DBLUM_CLI=OFF "${targets[@]}"
find build/coverage -name '*.gcda' -delete
log=build/coverage/ctest.log
# A suite that was not built, for example of another layer, is not a failure here.
if ! ctest --test-dir build/coverage --parallel "${JOBS:-$(nproc)}" --output-on-failure --no-tests=error "${tests[@]}" \
  --exclude-regex '_NOT_BUILT$' >"$log" 2>&1; then
  tail -n 40 "$log"
  echo "coverage: tests failed" >&2
  exit 1
fi
grep 'tests passed' "$log"
tools/coverage_report.py build/coverage "$@"
