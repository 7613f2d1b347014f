#!/usr/bin/env bash
# `make docs`: the API pages and the Markdown pages as HTML in build/docs/html; any warning of Doxygen and any broken
# link within the project is an error.
set -euo pipefail
cd "$(dirname "$0")/.."

tools/check_links.py
rm -rf build/docs
mkdir -p build/docs
doxygen docs/Doxyfile
echo "docs: build/docs/html/index.html"
