#!/usr/bin/env bash
# Builds and tests the page of `blum view`, apps/viewer. Only changes of the page need this script and Node 18 or newer
# (tools/setup.sh --viewer), because the built page, apps/viewer/dist/viewer.html, is part of the sources.
#   tools/viewer.sh install   installs the pinned packages into apps/viewer/node_modules
#   tools/viewer.sh build     builds dist/viewer.html
#   tools/viewer.sh check     builds the page and compares it with dist/viewer.html, byte for byte
#   tools/viewer.sh lint      runs tsc --strict and eslint
#   tools/viewer.sh test      runs vitest; JUnit results go to build/viewer/test.xml
#   tools/viewer.sh e2e       tests in Chromium, with build/release/bin/blum or $BLUM_CLI; results: build/viewer/e2e.xml
#   tools/viewer.sh pictures  runs e2e and makes the pictures of docs/guide/viewer.md
#   tools/viewer.sh all       install, check, test, e2e, each counted (RESULTS as in tools/lint.sh, which lints)
set -euo pipefail
cd "$(dirname "$0")/.."

out=$PWD/build/viewer
page=apps/viewer/dist/viewer.html
blum=${BLUM_CLI:-$PWD/build/release/bin/blum}
verb=${1:-all}

in_viewer() {
  (cd apps/viewer && "$@")
}

install() {
  mkdir -p "$out"
  # Skips packages that match the lock file.
  sha256sum --status -c "$out/installed.sha256" 2>/dev/null && [[ -d apps/viewer/node_modules ]] && return
  # Installs the versions of the lock file. `npm ci` would also require the native parts of all other systems in it.
  in_viewer npm install --no-save --no-audit --no-fund --ignore-scripts
  sha256sum apps/viewer/package-lock.json >"$out/installed.sha256"
}

check() {
  in_viewer node build.mjs "$out/viewer.html"
  if ! cmp "$out/viewer.html" "$page"; then
    echo "viewer: $page is not what its sources make; run tools/viewer.sh build" >&2
    return 1
  fi
  echo "viewer: $page is what its sources make, $(wc -c <"$page") bytes"
}

vitest() {
  local name=$1
  shift
  mkdir -p "$out"
  rm -f "$out/$name.xml"
  in_viewer npx --no-install vitest run --reporter=default --reporter=junit "--outputFile.junit=$out/$name.xml" "$@"
}

e2e() {
  BLUM_CLI=$blum vitest e2e --config e2e/vitest.config.ts
}

all() {
  local results=${RESULTS:-build/results/viewer} step
  [[ -n ${RESULTS:-} ]] || rm -rf "$results"
  for step in install check; do
    tools/results.py check "$results" "viewer-$step" -- tools/viewer.sh "$step"
  done
  for step in test e2e; do
    echo "--- viewer-$step"
    tools/viewer.sh "$step" || true
    tools/results.py junit "$results" "viewer-$step" "$out/$step.xml"
  done
  [[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
}

case $verb in
  install) install ;;
  build) in_viewer node build.mjs dist/viewer.html ;;
  check) check ;;
  lint)
    in_viewer npx --no-install tsc -p .
    in_viewer npx --no-install eslint .
    ;;
  test) vitest test ;;
  e2e) e2e ;;
  pictures) VIEWER_PICTURES=$PWD/docs/pictures e2e ;;
  all) all ;;
  *)
    sed -n '2,13s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
