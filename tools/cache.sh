# shellcheck shell=bash
# Sourced by what compiles: one compiler cache for every build folder and every checkout. Paths below the project count
# as relative, so that build folders of one depth (build/<name>), here and in a clone elsewhere, share what they have in
# common. Debug information then names the folder that compiled first.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=true
# Sources that use precompiled headers are kept, too; nothing here depends on the time at which it is compiled.
export CCACHE_SLOPPINESS=pch_defines,time_macros
export CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-20G}
# Where there is no home, the cache lives in the build folder.
export CCACHE_DIR=${CCACHE_DIR:-${HOME:-$PWD/build}/.cache/ccache}
