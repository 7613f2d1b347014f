#!/usr/bin/env bash
# Installs the packages that Blum needs on Debian 12 and its relatives, or lists the missing ones.
#   tools/setup.sh [--python] [--tests] [--bench] [--docs] [--lint] [--fuzz] [--viewer] [--ci] [--all] [--check]
# Without options, the packages are those of the library and the command-line tool. --check installs nothing.
# As root, or if sudo works, apt installs missing packages. Otherwise the script prints the command to run, and exits
# with 1. A second run does nothing. BLUM_SETUP=skip in the environment assumes that everything is installed.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(make g++ cmake ninja-build libtbb-dev libhwy-dev libboost-dev zlib1g-dev libpng-dev libcli11-dev
          nlohmann-json3-dev libtinygltf-dev libompl-dev)
python=(python3-dev python3-venv ca-certificates)
tests=(libgtest-dev python3-dev python3-venv ca-certificates)
bench=(libbenchmark-dev libembree-dev libcgal-dev libopenvdb-dev libfcl-dev python3 python3-venv ca-certificates)
docs=(doxygen python3-dev python3-venv ca-certificates)
lint=(clang-format-19 clang-19 shellcheck python3 python3-venv ca-certificates)
fuzz=(clang-19 libclang-rt-19-dev)
ci=(ccache)

# Node and Chromium build and test the page of `blum view`. Installs them if they are missing or too old.
viewer=(ca-certificates)
if ! command -v npm >/dev/null || ! node -e 'process.exit(process.versions.node.split(".")[0] < 18 ? 1 : 0)' 2>/dev/null; then
  viewer+=(nodejs npm)
fi
command -v chromium >/dev/null || viewer+=(chromium)

check_only=false
requirement_files=()
for option in "$@"; do
  case $option in
    --python) packages+=("${python[@]}") requirement_files+=(python/requirements.txt) ;;
    --tests) packages+=("${tests[@]}") requirement_files+=(python/requirements.txt tests/python/requirements.txt) ;;
    --bench)
      packages+=("${bench[@]}")
      requirement_files+=(python/requirements.txt tests/python/requirements.txt bench/requirements.txt)
      ;;
    --docs)
      packages+=("${docs[@]}")
      requirement_files+=(python/requirements.txt tests/python/requirements.txt)
      ;;
    --lint)
      packages+=("${lint[@]}")
      requirement_files+=(python/requirements.txt tests/python/requirements.txt)
      ;;
    --fuzz) packages+=("${fuzz[@]}") ;;
    --viewer) packages+=("${viewer[@]}") ;;
    --ci) packages+=("${ci[@]}") ;;
    --all)
      packages+=("${tests[@]}" "${bench[@]}" "${docs[@]}" "${lint[@]}" "${fuzz[@]}" "${viewer[@]}")
      requirement_files+=(python/requirements.txt tests/python/requirements.txt bench/requirements.txt)
      ;;
    --check) check_only=true ;;
    *)
      echo "setup: unknown option $option; see the head of tools/setup.sh" >&2
      exit 2
      ;;
  esac
done

say() { echo "setup: $*"; }

if [[ ${BLUM_SETUP:-} == skip ]]; then
  say "skipped (BLUM_SETUP=skip)"
  exit 0
fi

missing_packages() {
  local package
  for package in $(printf '%s\n' "${packages[@]}" | sort -u); do
    # shellcheck disable=SC2016  # ${...} is dpkg-query's, not the shell's
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
  done
}

if ! command -v dpkg-query >/dev/null; then
  say "this system has no dpkg, so nothing can be checked or installed here. Blum is tested on Debian 12, where it needs:" >&2
  printf '  %s\n' "${packages[@]}" >&2
  say "install what corresponds to these, then run again with BLUM_SETUP=skip" >&2
  exit 1
fi

# Runs a command as root; fails without a prompt if no one can answer it.
as_root() {
  if [[ $EUID -eq 0 ]]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif [[ -t 0 ]]; then
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo -n env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

can_install() {
  [[ $EUID -eq 0 ]] || { command -v sudo >/dev/null && { [[ -t 0 ]] || sudo -n true 2>/dev/null; }; }
}

# Succeeds if apt's current lists contain every package.
apt_knows() {
  local package
  for package in "$@"; do
    apt-cache policy "$package" 2>/dev/null | grep -q 'Candidate: [^(]' || return 1
  done
}

apt_install() {
  as_root apt-get install -y -q --no-install-recommends "$@"
}

mapfile -t missing < <(missing_packages)
if [[ ${#missing[@]} -gt 0 ]]; then
  if $check_only || ! can_install; then
    {
      say "missing: ${missing[*]}"
      say "run this as root, then try again:"
      echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    } >&2
    exit 1
  fi
  say "installing with apt: ${missing[*]}"
  if ! apt_knows "${missing[@]}"; then as_root apt-get update -q; fi
  if ! apt_install "${missing[@]}"; then
    say "that failed; refreshing apt's lists and trying once more"
    as_root apt-get update -q
    apt_install "${missing[@]}"
  fi
  mapfile -t missing < <(missing_packages)
  if [[ ${#missing[@]} -gt 0 ]]; then
    say "still missing: ${missing[*]}" >&2
    exit 1
  fi
fi

requirements=()
for file in "${requirement_files[@]}"; do
  [[ -f $file ]] && requirements+=("$file")
done
if [[ ${#requirements[@]} -gt 0 ]]; then
  for file in "${requirements[@]}"; do
    stamp=build/venv/$(tr / - <<<"$file").sha256
    sha256sum --status -c "$stamp" 2>/dev/null && continue
    if $check_only; then
      say "missing: the Python packages of $file in build/venv" >&2
      exit 1
    fi
    say "installing the Python packages of $file into build/venv"
    [[ -x build/venv/bin/pip ]] || python3 -m venv build/venv
    build/venv/bin/pip install --quiet --disable-pip-version-check -r "$file"
    sha256sum "$file" >"$stamp"
  done
fi
say "everything needed is there"
