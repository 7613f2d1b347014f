#!/usr/bin/env bash
# Builds configurations with parts switched off, and runs the tests that differ there: parts without their packages, the
# scalar, serial path. (Clang builds everything for tools/sanitize.sh asan and for clang-tidy.)
# With RESULTS set, adds the counts to that folder and leaves the closing line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/cache.sh

# Builds one configuration: name, then CMake options.
configuration() {
  local name=$1 folder=build/$1
  shift
  cmake -S . -B "$folder" -G Ninja --no-warn-unused-cli -DCMAKE_BUILD_TYPE=Release -DBLUM_WERROR=ON "$@" || return
  cmake --build "$folder" --parallel "${JOBS:-$(nproc)}" || return
}

# The core, geometry, grid and reference layers. Configuring fails if they search for any third-party package.
compiler_alone() {
  local forbidden=() package
  for package in TBB hwy Boost ZLIB PNG CLI11 nlohmann_json GTest benchmark; do
    forbidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
  done
  configuration "$1" -DBLUM_FIELD_CPU=OFF -DBLUM_TESTS=OFF "-DBLUM_THREADS=$2" "${forbidden[@]}" || return
  tests/install/run.sh "build/$1"
}

# Builds a configuration in which layers run other code, and tests it: name, then CMake options. `make test` runs suites
# that repeat much or are slow.
with_tests() {
  local name=$1
  shift
  configuration "$name" "$@" || return
  ctest --test-dir "build/$name" --parallel "${JOBS:-$(nproc)}" --output-on-failure --tests-regex '^test_' \
    --label-exclude 'slow|many' --no-tests=error --quiet --output-log "build/$name/ctest.log" ||
    {
      tail -n 100 "build/$name/ctest.log"
      return 1
    }
}

case ${1:-} in
  '')
    tools/setup.sh --tests --fuzz
    results=${RESULTS:-build/results/configurations}
    [[ -n ${RESULTS:-} ]] || rm -rf "$results"
    for name in compiler-alone compiler-alone-serial scalar-serial; do
      tools/results.py check "$results" "configuration-$name" -- "$0" "$name"
    done
    [[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
    ;;
  compiler-alone) compiler_alone compiler-alone STD ;;
  compiler-alone-serial) compiler_alone compiler-alone-serial SERIAL ;;
  # Uses other instructions in geometry and field, and no threads in core, so that every loop runs differently. `make
  # tsan` tests std::thread. Builds the tool without its precompiled header, which might hide a missing include.
  scalar-serial) with_tests scalar-serial -DBLUM_OMPL=OFF -DBLUM_PCH=OFF -DBLUM_SIMD=OFF -DBLUM_THREADS=SERIAL ;;
  *)
    echo "configurations: unknown configuration $1" >&2
    exit 2
    ;;
esac
