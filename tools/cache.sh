# shellcheck shell=bash
# Scripts that compile source this file. It sets one compiler cache for all build folders and checkouts. Paths below the
# project count as relative, so that build folders of one depth (build/<name>), also in other clones, share results.
# Debug information then names the folder that compiled first.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=true
# Also caches sources that use precompiled headers; no source depends on the time of its compilation.
export CCACHE_SLOPPINESS=pch_defines,time_macros
export CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-20G}
# Without a home folder, the cache lies in the build folder.
export CCACHE_DIR=${CCACHE_DIR:-${HOME:-$PWD/build}/.cache/ccache}
