# shellcheck shell=bash
# Sourced by what compiles: one compiler cache for every build folder and every checkout. Paths below the project count
# as relative, so that build folders of one depth (build/<name>), here and in a clone elsewhere, share what they have in
# common. Debug information then names the folder that compiled first.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=true
export CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-20G}
# Where there is no home, the cache lives in the build folder.
export CCACHE_DIR=${CCACHE_DIR:-${HOME:-$PWD/build}/.cache/ccache}
