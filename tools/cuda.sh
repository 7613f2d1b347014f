#!/usr/bin/env bash
# Compiles all CUDA code, the module and the programs of bench/gpu, with warnings as errors. If nvcc is missing, first
# installs its wheels from PyPI into build/cuda-toolkit (300 MB). Runs nothing; bench/gpu.sh runs the programs on a GPU.
#   tools/cuda.sh
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/cache.sh

toolkit=$PWD/build/cuda-toolkit
if [[ -n ${CUDACXX:-} ]] && ! command -v "$CUDACXX" >/dev/null; then
  echo "cuda: CUDACXX is $CUDACXX, which cannot be run" >&2
  exit 1
fi
find_nvcc() {
  command -v "${CUDACXX:-nvcc}" || ls "$toolkit"/lib/python3*/site-packages/nvidia/cu13/bin/nvcc 2>/dev/null
}
if ! find_nvcc >/dev/null; then
  python3 -m venv "$toolkit"
  "$toolkit/bin/pip" install --quiet -r bench/gpu/requirements.txt
  # nvcc links with libraries in lib64; the wheels have them in lib.
  for folder in "$toolkit"/lib/python3*/site-packages/nvidia/cu13; do ln -sfn lib "$folder/lib64"; done
fi
CUDACXX=$(find_nvcc)
export CUDACXX CCACHE_COMPILERCHECK=content  # the wheels are unpacked anew in each clone
echo "cuda: $("$CUDACXX" --version | tail -n 1)"
cmake -S . -B build/cuda -G Ninja -DCMAKE_BUILD_TYPE=Release -DBLUM_CUDA=ON -DBLUM_GPU_BENCH=ON -DBLUM_FIELD_CPU=OFF \
  -DBLUM_TESTS=OFF -DBLUM_THREADS=STD -DBLUM_WERROR=ON --log-level=WARNING
cmake --build build/cuda --parallel "${JOBS:-$(nproc)}" --target blum_cuda check_gpu time_gpu
echo "cuda: export BLUM_CUDA_MODULE=$PWD/build/cuda/bin/libblum_cuda.so makes every Blum here use it"
