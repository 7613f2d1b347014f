#!/usr/bin/env bash
# `make docs`: builds one static site of guides, theory and the C++ and Python references, in build/docs/html. Sphinx
# joins the Markdown pages, Doxygen's output for the headers and the package's docstrings. Warnings and broken links are
# errors.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/check_links.py
rm -rf build/docs
mkdir -p build/docs
tools/build.sh release -DBLUM_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/venv/bin/python" -- blum_python >/dev/null
doxygen docs/site/Doxyfile
export PYTHONPATH=$PWD/build/release/python
build/venv/bin/python tools/stage_site.py build/docs/pages build/docs/xml
build/venv/bin/sphinx-build --quiet --fail-on-warning --keep-going --jobs auto -d build/docs/doctrees \
  -c docs/site build/docs/pages build/docs/html
tools/check_site.py build/docs/html
echo "docs: build/docs/html/index.html"
