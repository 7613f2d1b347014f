#!/usr/bin/env bash
# Runs the tests under sanitizers.
#   tools/sanitize.sh asan|tsan
# asan: AddressSanitizer and UndefinedBehaviorSanitizer for every test program, with clang, whose warnings are errors.
# tsan: ThreadSanitizer with std::thread and g++, for the tests of the layers that run threads. The tests of proximity,
#   surface_map and voronoi run only if their name contains Threads.
# Tests labelled slow or many (tests/CMakeLists.txt) are left out, because they repeat code that other tests run once.
# With RESULTS set, adds the counts to that folder and leaves the closing line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."

preset=$1
tools/setup.sh --tests --fuzz
results=${RESULTS:-build/results/$preset}
[[ -n ${RESULTS:-} ]] || rm -rf "$results"

case $preset in
  asan)
    targets=()
    selection=(--label-exclude 'slow|many')
    # A failed allocation must reach Blum's own handling, as without the sanitizer.
    export ASAN_OPTIONS=allocator_may_return_null=1:detect_stack_use_after_return=1
    export UBSAN_OPTIONS=print_stacktrace=1
    ;;
  tsan)
    targets=(-- test_core test_field test_points test_axis test_medial_axis test_proximity test_surface_map test_voronoi)
    # Kernels on the host (/Host, Kernels) run on one thread.
    selection=(--label-exclude 'slow|many' --exclude-regex '/Host$|Kernels' --tests-regex '^test_(core|field|points|axis|medial_axis)\.|^test_(proximity|surface_map|voronoi)\..*Threads')
    export TSAN_OPTIONS=allocator_may_return_null=1:halt_on_error=1:second_deadlock_stack=1
    ;;
  *)
    echo "sanitize: asan or tsan, not $preset" >&2
    exit 2
    ;;
esac

tools/results.py check "$results" "$preset-build" -- tools/build.sh "$preset" -DBLUM_CLI=OFF -DBLUM_WERROR=ON "${targets[@]}"
if [[ -f build/$preset/build.ninja ]]; then
  tools/ctest.sh "$results" "$preset" "build/$preset" "${selection[@]}"
fi
[[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
