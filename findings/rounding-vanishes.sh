#!/usr/bin/env bash
# GCC 12.2, the compiler of Debian 12, removes the rounding of two neighbouring doubles to float.
#
# Version: g++-12 12.2.0-14 and its security updates, x86-64, with -O2 and -O3.
# The function below rounds two numbers to single precision, and stores them where they came from.
# GCC 12 vectorises both conversions (-ftree-slp-vectorize, part of -O2 since this version).
# It then drops them: the compiled function consists of one return instruction.
#
# Expected: both numbers are rounded, as the C and C++ standards demand of a cast, and as -O1 does.
# Seen: with -O2 and -O3 they keep all digits of double precision. There is no warning.
# With three numbers, for example the coordinates of a vertex, two of them keep their digits.
# A loop over more numbers, or a store to another array, is compiled correctly.
#
# Affected: code that snaps coordinates in place to the precision of a file (STL, GLB, PLY), for example to merge
# equal vertices or to make test data. It runs with coordinates that are not rounded.
# Workaround: store to a float variable marked volatile, or compile with -fno-tree-slp-vectorize.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
compiler=$(command -v g++-12) || {
  echo "g++-12 is not installed: apt-get install g++-12 on Debian 12"
  exit 1
}
"$compiler" --version | head -n 1

cat >round.cpp <<'END'
#include <cstdio>

__attribute__((noinline)) void round_both(double* p) {
  p[0] = static_cast<float>(p[0]);
  p[1] = static_cast<float>(p[1]);
}

int main() {
  double p[2] = {0.1, 0.2};
  round_both(p);
  std::printf("%.17g %.17g\n", p[0], p[1]);
}
END
rounded="0.10000000149011612 0.20000000298023224"
kept="0.10000000000000001 0.20000000000000001"
for level in -O1 -O2 -O3; do
  "$compiler" "$level" round.cpp -o round
  seen=$(./round)
  expected=$kept
  [ "$level" = -O1 ] && expected=$rounded
  echo "$level: $seen"
  if [ "$seen" != "$expected" ]; then
    echo "changed: expected $expected"
    exit 1
  fi
done
"$compiler" -O2 -fno-tree-slp-vectorize round.cpp -o round
echo "-O2 -fno-tree-slp-vectorize: $(./round)"
[ "$(./round)" = "$rounded" ]
