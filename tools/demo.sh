#!/usr/bin/env bash
# `make demo`: the main job end to end, on a shape that Blum generates.
#   tools/demo.sh BLUM_PROGRAM OUTPUT_FOLDER
set -euo pipefail

blum=$1
out=$2
mkdir -p "$out"

step() {
  echo "demo: $*"
  "$@"
}
step "$blum" make torus-knot -o "$out/knot.ply" --curve-segments 60 --tube-segments 8
step "$blum" info "$out/knot.ply"
step "$blum" field "$out/knot.ply" -o "$out/knot.nrrd" --resolution 256 --json "$out/knot.json"
step "$blum" slice "$out/knot.nrrd" -o "$out/distance.png" --axis z --show distance
step "$blum" slice "$out/knot.nrrd" -o "$out/sites.png" --axis z --show sites
step "$blum" medial "$out/knot.ply" -o "$out/axis.vtp" --theta 60 --resolution 128
step "$blum" verify "$out/knot.ply" "$out/axis.vtp"
# A coarser field, and the axes of all angles, for a page that is small.
step "$blum" field "$out/knot.ply" -o "$out/view.npz" --resolution 128 --quiet
step "$blum" medial "$out/knot.ply" -o "$out/angles.npz" --theta 10 --nested --resolution 128 --quiet
step "$blum" view "$out/knot.ply" "$out/view.npz" "$out/angles.npz" -o "$out/page.html"

cat <<END

demo: done. In $out:
  knot.ply        the shape: a torus knot
  knot.nrrd       its signed distance on a grid (3D Slicer, ParaView, SimpleITK, pynrrd open it)
  knot.site.nrrd  the closest site at every node
  knot.json       what was computed, and how fast
  distance.png    a slice through the distance, with contour lines
  sites.png       the same slice, one colour per Voronoi region
  axis.vtp        the medial axis of the knot, certified (ParaView opens it; colour by radius)
  page.html       all of it to look at: open it in a browser (view.npz and angles.npz are in it)
END
