#!/usr/bin/env bash
# `make lint`: checks format, changed sources (clang-tidy, tools/tidy.py), shell scripts, layer rules and their picture,
# text rules, English, links, messages of new commits, Python (ruff) and the viewer (tsc, ESLint). Each counts as one
# check.
#   tools/lint.sh [CHECK ...]   only these: format includes picture text words links commits shell python viewer tidy
# With RESULTS set, adds the counts to that folder and leaves the closing line to the caller (.ci/run).
set -euo pipefail
cd "$(dirname "$0")/.."

shell_scripts() {
  mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.sh' .ci/run)
  shellcheck "${files[@]}"
}

# Checks the rules and the format of ruff for the Python package, tests and examples.
python_sources() {
  if [[ ! -x build/venv/bin/ruff ]]; then
    echo "lint: ruff is missing: run make lint, or tools/setup.sh --lint" >&2
    return 1
  fi
  build/venv/bin/ruff check --quiet && build/venv/bin/ruff format --check
}

run() {
  case $1 in
    format) tools/format.sh --check ;;
    includes) tools/check_includes.py ;;
    picture) tools/draw_layers.py --check ;;
    text) tools/check_text.py ;;
    words) tools/check_words.py ;;
    links) tools/check_links.py ;;
    commits) tools/check_commits.py ;;
    shell) shell_scripts ;;
    python) python_sources ;;
    viewer) tools/viewer.sh install && tools/viewer.sh lint ;;
    tidy) tools/tidy.py ;;
    *)
      echo "lint: unknown check $1" >&2
      exit 2
      ;;
  esac
}

if [[ ${1:-} == --run ]]; then
  run "$2"
  exit
fi
results=${RESULTS:-build/results/lint}
[[ -n ${RESULTS:-} ]] || rm -rf "$results"
[[ $# -gt 0 ]] || set -- format includes picture text words links commits shell python viewer tidy
for name in "$@"; do
  tools/results.py check "$results" "lint-$name" -- "$0" --run "$name"
done
[[ -n ${RESULTS:-} ]] || tools/results.py summary "$results"
