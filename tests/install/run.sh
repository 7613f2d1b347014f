#!/usr/bin/env bash
# Installs a build into a fresh prefix, then builds and runs a project that finds Blum there.
#   tests/install/run.sh BUILD_FOLDER
set -euo pipefail
cd "$(dirname "$0")/../.."

build=$1
prefix=$PWD/$build/install_test/prefix
consumer=$PWD/$build/install_test/consumer
rm -rf "$build/install_test"
cmake --install "$build" --prefix "$prefix" >/dev/null
cmake -S tests/install -B "$consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$consumer"
for program in "$consumer"/consumer_*; do "$program"; done
# A component that does not exist is named.
mkdir "$build/install_test/nonsense"
echo 'cmake_minimum_required(VERSION 3.25)
project(nonsense LANGUAGES CXX)
find_package(blum REQUIRED COMPONENTS core nonsense)' >"$build/install_test/nonsense/CMakeLists.txt"
if answer=$(cmake -S "$build/install_test/nonsense" -B "$build/install_test/nonsense/build" -G Ninja \
  -DCMAKE_PREFIX_PATH="$prefix" 2>&1) || [[ $answer != *"no component nonsense"* ]]; then
  echo "install: an unknown component was not refused by its name: $answer" >&2
  exit 1
fi
# The tool starts from where it was installed.
if [[ -x $prefix/bin/blum ]]; then "$prefix/bin/blum" --version; fi
# Nothing that was installed points back to where it was built.
if grep -rlF -e "$PWD/src" -e "$PWD/include" "$prefix/include" "$prefix"/lib*/cmake "$prefix"/lib*/*/cmake 2>/dev/null; then
  echo "install: the files above name the source folder" >&2
  exit 1
fi
