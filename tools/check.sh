#!/usr/bin/env bash
# `make check T=PATTERN`: a quick round. Configures, builds the programs of the tests that match PATTERN, and runs these
# tests. PATTERN matches ctest's names, for example test_geometry.Bvh.FindsTheNearest, example.field_of_mesh or
# pytest.test_cli; or it is viewer.
#   tools/check.sh PATTERN [PRESET]   a regular expression; preset release (default) or dev
# A program is built if PATTERN matches its name, or a suite or test in its sources. PATTERN may contain the prefix
# (On/) and the suffix (/Cpu) of a parametrised test.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/cache.sh

pattern=${1:-}
preset=${2:-release}
if [[ -z $pattern ]]; then
  echo "check: name the tests, as in: make check T=geometry" >&2
  exit 2
fi
start=$SECONDS
if [[ $pattern == viewer* ]]; then
  tools/setup.sh --viewer
  tools/viewer.sh install
  tools/viewer.sh test
  exit
fi
# `make demo` and `make python` build without the tests.
if ! grep -qs '^BLUM_TESTS:BOOL=ON' "build/$preset/CMakeCache.txt" || [[ ! -f build/$preset/build.ninja ]]; then
  tools/setup.sh --tests
  cmake --preset "$preset" -DBLUM_TESTS=ON -DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/venv/bin/python" >/dev/null
fi
mapfile -t targets < <(
  PATTERN=$pattern python3 - <<'PYTHON'
import os, pathlib, re

wanted = re.compile(os.environ["PATTERN"])
plain = re.compile(re.sub(r"(?<=[.^])\w+/|^\w+/|/\w+\$?$", "", os.environ["PATTERN"]) or ".")
targets = set()
folders = [path for path in pathlib.Path("tests/unit").iterdir() if path.is_dir()]
for folder in (*folders, pathlib.Path("tests/property"), pathlib.Path("tests/regression")):
    program = f"test_{folder.name}"
    text = "\n".join(path.read_text() for path in sorted(folder.glob("*.cpp")))
    names = [f"{program}.{suite}.{test}" for suite, test in re.findall(r"^(?:TYPED_)?TEST\w*\((\w+),\s*(\w+)", text, re.M)]
    if names and any(wanted.search(name) or plain.search(name) for name in names):
        targets.add(program)
targets |= {f"example_{path.stem}" for path in pathlib.Path("examples").glob("*.cpp") if wanted.search(f"example.{path.stem}")}
if any(wanted.search(f"pytest.{path.stem}") for folder in ("cli", "python") for path in pathlib.Path("tests", folder).glob("test_*.py")):
    targets |= {path.stem for path in pathlib.Path("tests/support").glob("*_sample.cpp")}
    targets |= {"blum_cli", "blum_python", "blum_python_stub", "blum_emulated_cuda"}
print(*sorted(targets), sep="\n")
PYTHON
)
if [[ -z ${targets[0]:-} ]]; then
  echo "check: no test matches $pattern" >&2
  exit 1
fi
echo "check: building ${targets[*]}"
cmake --build "build/$preset" --parallel "${JOBS:-$(nproc)}" --target "${targets[@]}"
ctest --test-dir "build/$preset" --parallel "${JOBS:-$(nproc)}" --output-on-failure --no-tests=error \
  --tests-regex "$pattern" --exclude-regex '_NOT_BUILT$' --progress
echo "check: took $((SECONDS - start)) s"
