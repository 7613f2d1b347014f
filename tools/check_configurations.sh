#!/usr/bin/env bash
# Builds what can be switched off, switched off, and runs the tests that are left: parts without their packages, the
# scalar and the serial path, and the whole with clang.
# With RESULTS set, adds the counts to that folder and leaves the closing line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."

# One configuration: name, then CMake options. Builds everything, and runs ctest where there are tests.
configuration() {
  local name=$1 folder=build/configurations/$1
  shift
  cmake -S . -B "$folder" -G Ninja --no-warn-unused-cli -DCMAKE_BUILD_TYPE=Release -DBLUM_WERROR=ON "$@" || return
  cmake --build "$folder" --parallel "${JOBS:-$(nproc)}" || return
}

# The core, geometry, grid and reference layers: configuring fails when they look for any package of a third party.
compiler_alone() {
  local forbidden=() package
  for package in TBB hwy ZLIB PNG CLI11 nlohmann_json GTest benchmark; do
    forbidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
  done
  configuration "$1" -DBLUM_FIELD_CPU=OFF -DBLUM_TESTS=OFF "-DBLUM_THREADS=$2" "${forbidden[@]}" || return
  tests/install/run.sh "build/configurations/$1"
}

with_tests() {
  local name=$1
  configuration "$@" || return
  ctest --test-dir "build/configurations/$name" --parallel "${JOBS:-$(nproc)}" --output-on-failure --label-exclude slow \
    --quiet --output-log "build/configurations/$name/ctest.log" ||
    {
      tail -n 100 "build/configurations/$name/ctest.log"
      return 1
    }
}

case ${1:-} in
  '')
    tools/setup.sh --tests --fuzz
    results=${RESULTS:-build/results/configurations}
    [[ -n ${RESULTS:-} ]] || rm -rf "$results"
    for name in compiler-alone compiler-alone-serial scalar serial clang; do
      tools/results.py check "$results" "configuration-$name" -- "$0" "$name"
    done
    [[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
    ;;
  compiler-alone) compiler_alone compiler-alone STD ;;
  compiler-alone-serial) compiler_alone compiler-alone-serial SERIAL ;;
  scalar) with_tests scalar -DBLUM_CLI=OFF -DBLUM_SIMD=OFF -DBLUM_THREADS=STD ;;
  serial) with_tests serial -DBLUM_CLI=OFF -DBLUM_THREADS=SERIAL ;;
  # Without optimisation: this one is for clang's opinion of the code.
  clang) configuration clang -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=clang++-19 ;;
  *)
    echo "configurations: unknown configuration $1" >&2
    exit 2
    ;;
esac
