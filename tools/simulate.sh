#!/usr/bin/env bash
# `make simulate`: runs a simulation of examples/simulations and makes a page of its frames.
#   tools/simulate.sh cloth|bodies|breaking|large OUTPUT_FOLDER [--frames N]
# Ctrl-C ends it after the current frame, with a page of the frames so far.
# It fails if the library's continuous check finds a missed collision.
set -euo pipefail
cd "$(dirname "$0")/.."

name=$1
out=$2
shift 2
build/release/bin/simulations "$name" "$out/$name" "$@"
build/release/bin/blum view "$out/$name"/frame_*.ply --frames --pairs "$out/$name/pairs.json" -o "$out/$name.html"
echo "simulate: open $out/$name.html"
