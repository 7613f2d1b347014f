#!/usr/bin/env bash
# `make docs`: the API pages and the Markdown pages as HTML in build/docs/html; any warning of Doxygen and any broken
# link within the project is an error.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/check_links.py
rm -rf build/docs
mkdir -p build/docs
# The Python package's pages, from its docstrings; a warning is an error here, too.
tools/build.sh release -DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/venv/bin/python" -- blum_python >/dev/null
mkdir -p build/pages
PYTHONPATH=$PWD/build/release/python build/venv/bin/python tools/format_page.py >build/pages/formats.md
doxygen docs/Doxyfile
warnings=$(PYTHONPATH=$PWD/build/release/python build/venv/bin/pdoc --docformat numpy --no-show-source \
  -o build/docs/html/python blum 2>&1)
if [[ -n $warnings ]]; then
  echo "$warnings" >&2
  exit 1
fi
echo "docs: build/docs/html/index.html, build/docs/html/python/blum.html"
