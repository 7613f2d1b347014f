#!/usr/bin/env bash
# `make test`: sets up what is missing, builds, and runs every test: ctest, pytest, and a consumer of the installed
# library. Closes with `N passed, N failed[, N skipped]`. With RESULTS set, adds to that folder and leaves the closing
# line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/setup.sh --tests
results=${RESULTS:-build/results/test}
[[ -n ${RESULTS:-} ]] || rm -rf "$results"

options=(-DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/venv/bin/python")
[[ -n ${CI:-} ]] && options+=(-DBLUM_WERROR=ON)
tools/results.py check "$results" build -- tools/build.sh release "${options[@]}"
if [[ -f build/release/build.ninja ]]; then
  tools/results.py check "$results" public-headers -- tools/build.sh release "${options[@]}" -- blum_header_check
  tools/ctest.sh "$results" ctest build/release
  if compgen -G 'tests/*/test_*.py' >/dev/null; then
    echo "--- pytest: tests/python, tests/cli"
    # The package as the build made it; that a wheel of it works elsewhere is shown by tools/check_wheel.sh.
    export PYTHONPATH=$PWD/build/release/python
    rm -f build/pytest.xml
    bin=$PWD/build/release/bin
    BLUM=$bin/blum BLUM_CLI=$bin/blum BLUM_BIN_DIR=$bin BLUM_DISTANCE_TRANSFORM_SAMPLE=$bin/distance_transform_sample \
      build/venv/bin/python -m pytest -q -ra -p no:cacheprovider \
      --junitxml build/pytest.xml tests/python tests/cli || true
    tools/results.py junit "$results" pytest build/pytest.xml --complete
  fi
  tools/results.py check "$results" install -- tests/install/run.sh build/release
fi

[[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
