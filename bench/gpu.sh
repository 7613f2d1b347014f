#!/usr/bin/env bash
# Builds, tests and measures the CUDA back end on a machine with a GPU, nvcc, CMake and g++. Uses no other packages of
# Blum and downloads nothing. Takes less than ten minutes.
#   bench/gpu.sh [OUT]   figures go to OUT (default: out/gpu): check.txt, sanitizer-*.txt, times.txt, times.json
# BLUM_GPU_MESH: an OFF or OBJ file for the case with 69 k triangles (default: a generated mesh of that size).
# BLUM_GPU_SKIP=sanitizers: do not run compute-sanitizer.
# BLUM_GPU_BUILD_ONLY=1: only build. BLUM_GPU_ARCHITECTURE: target, for example 80 (default: that of the GPU, else 90).
# JOBS: number of parallel compilers. CUDACXX: nvcc, if it is not in PATH (default: that of tools/cuda.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-out/gpu}
mkdir -p "$out"
build=build/gpu
generator=()
command -v ninja >/dev/null && generator=(-G Ninja)

if [[ -z ${CUDACXX:-} ]] && ! command -v nvcc >/dev/null; then
  CUDACXX=$(ls "$PWD"/build/cuda-toolkit/lib/python3*/site-packages/nvidia/cu13/bin/nvcc 2>/dev/null || true)
  [[ -n $CUDACXX ]] && export CUDACXX
fi
architecture=${BLUM_GPU_ARCHITECTURE:-$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null |
  head -n 1 | tr -d '. ' || true)}

started=$SECONDS
cmake -S . -B "$build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release -DBLUM_CUDA=ON -DBLUM_GPU_BENCH=ON \
  -DBLUM_FIELD_CPU=OFF -DBLUM_TESTS=OFF -DBLUM_THREADS=STD -DCMAKE_CUDA_ARCHITECTURES="${architecture:-90}"
cmake --build "$build" --parallel "${JOBS:-$(nproc)}"
echo "gpu: built in $((SECONDS - started)) s"
[[ ${BLUM_GPU_BUILD_ONLY:-} == 1 ]] && exit 0

failed=0
"$build/bin/check_gpu" | tee "$out/check.txt" || failed=1
"$build/bin/time_gpu" --json "$out/times.json" ${BLUM_GPU_MESH:+--mesh "$BLUM_GPU_MESH"} | tee "$out/times.txt" || failed=1
if [[ ${BLUM_GPU_SKIP:-} != sanitizers ]]; then
  if command -v compute-sanitizer >/dev/null; then
    for tool in memcheck racecheck initcheck synccheck; do
      timeout 90 compute-sanitizer --tool "$tool" --error-exitcode 9 "$build/bin/check_gpu" --quick \
        >"$out/sanitizer-$tool.txt" 2>&1 || failed=1
      echo "gpu: compute-sanitizer $tool: $(tail -n 1 "$out/sanitizer-$tool.txt")"
    done
  else
    echo "gpu: compute-sanitizer is not installed: skipped"
  fi
fi
echo "gpu: took $((SECONDS - started)) s; figures are in $out"
exit "$failed"
