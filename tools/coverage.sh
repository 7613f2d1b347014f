#!/usr/bin/env bash
# `make coverage`: the share of lines that the tests labelled fast run, of each layer and in all (g++ --coverage, gcov).
#   tools/coverage.sh [LAYER ...]   these layers alone, by their own tests, test_LAYER: much sooner
# Figures for people: nothing fails where they are low. What no test runs is in build/coverage/missed.txt.
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
# A suite that was not built, as one of another layer, is no failure here.
if ! ctest --test-dir build/coverage --parallel "${JOBS:-$(nproc)}" --output-on-failure --no-tests=error "${tests[@]}" \
  --exclude-regex '_NOT_BUILT$' >"$log" 2>&1; then
  tail -n 40 "$log"
  echo "coverage: tests failed" >&2
  exit 1
fi
grep 'tests passed' "$log"
tools/coverage_report.py build/coverage "$@"
