#!/usr/bin/env bash
# Runs the ctest tests of one build folder and adds the counts to a results folder.
#   tools/ctest.sh RESULTS NAME BUILD_FOLDER [ctest options ...]
set -euo pipefail
cd "$(dirname "$0")/.."

results=$1
name=$2
folder=$3
shift 3
junit=$PWD/$folder/junit.xml
rm -rf "$junit" "$folder/pytest"
mkdir "$folder/pytest"
echo "--- $name: ctest in $folder"
# ctest's exit status is in the JUnit file too; results.py judges that.
ctest --test-dir "$folder" --parallel "${JOBS:-$(nproc)}" --output-on-failure --no-label-summary \
  --output-junit "$junit" --test-output-size-passed 4096 "$@" >"$folder/ctest.log" 2>&1 || true
grep -vE '^ *(Start +[0-9]+:|[0-9]+/[0-9]+ Test .* Passed )' "$folder/ctest.log" | tail -n 400
tools/results.py junit "$results" "$name" "$junit" "$folder/pytest"
