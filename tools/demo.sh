#!/usr/bin/env bash
# `make demo`: runs the main job end to end on a generated shape.
#   tools/demo.sh BLUM_PROGRAM OUTPUT_FOLDER
#   tools/demo.sh --time JOBS       only prints the time for building the tool
set -euo pipefail

if [[ $1 == --time ]]; then
  processor_seconds=700  # of library and tool, without a compiler cache, on a server of 2023
  minutes=$((processor_seconds / 60 / $2 + 2))
  echo "demo: where nothing is built yet, this takes about $minutes minutes with $2 at a time, on older machines twice that"
  exit
fi

blum=$1
out=$2
mkdir -p "$out"

step() {
  echo "demo: $*"
  "$@"
}
step "$blum" make bracket -o "$out/bracket.ply"
step "$blum" info "$out/bracket.ply"
step "$blum" field "$out/bracket.ply" -o "$out/bracket.nrrd" --resolution 256 --json "$out/bracket.json"
step "$blum" slice "$out/bracket.nrrd" -o "$out/distance.png" --axis z --show distance
step "$blum" slice "$out/bracket.nrrd" -o "$out/sites.png" --axis z --show sites
step "$blum" medial "$out/bracket.ply" -o "$out/axis.vtp" --theta 60 --resolution 160
step "$blum" verify "$out/bracket.ply" "$out/axis.vtp"
# A coarser field and the axes of all angles keep the page small.
step "$blum" field "$out/bracket.ply" -o "$out/field.npz" --resolution 128 --quiet
step "$blum" medial "$out/bracket.ply" -o "$out/angles.npz" --theta 10 --nested --resolution 160 --quiet
step "$blum" view "$out/bracket.ply" "$out/field.npz" "$out/angles.npz" -o "$out/page.html"

cat <<END

demo: done. In $out:
  page.html          look at this first: all of it, in a browser
  bracket.ply        the shape: a bracket with four holes
  bracket.nrrd       its signed distance on a grid (3D Slicer, ParaView, SimpleITK, pynrrd open it)
  bracket.site.nrrd  the closest site at every node
  bracket.json       what was computed, and how fast
  distance.png       a slice through the distance, with contour lines
  sites.png          the same slice, one colour per Voronoi region
  axis.vtp           the medial axis of the bracket, certified (ParaView opens it; colour by radius)
  field.npz, angles.npz   what the page shows: a coarser field, and the axes of all angles (NumPy reads them)
END
