#!/usr/bin/env bash
# Makes the machine ready to build: installs the Debian packages that are missing, and nothing else.
set -euo pipefail

usage() {
  cat <<'END'
usage: scripts/setup.sh [GROUP...]

Installs the packages of the groups named (default: build) in scripts/debian-packages.txt that are not
installed yet, as root or through sudo. Says nothing where nothing is missing. Where packages cannot be
installed (no apt-get, or neither root nor sudo), names what is missing and goes on if CMake finds all it needs.

groups: build    compilers, libraries, test framework
        report   what demo.sh's page needs
        develop  clang, clang-format, clang-tidy
END
}

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
list=$root/scripts/debian-packages.txt
log=$(mktemp)
trap 'rm -f "$log"' EXIT

say() { printf 'setup: %s\n' "$*"; }

# packages_of GROUP: its packages, one a line.
packages_of() {
  awk -v wanted="[$1]" '
    { sub(/#.*/, ""); gsub(/[ \t]+/, "") }
    /^\[/ { here = ($0 == wanted); found = found || here; next }
    here && $0 != "" { print }
    END { exit !found }' "$list" || { echo "setup: no group '$1' in $list" >&2; return 2; }
}

# missing PACKAGE...: those that dpkg does not know as installed, one a line.
missing() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

# The last resort where nothing can be installed: other names or places may hold all that is needed.
go_on_if_cmake_is_content() {
  if command -v cmake >/dev/null && (cd "$root" && cmake --preset release) >"$log" 2>&1 </dev/null; then
    say "CMake finds all it needs; going on without them."
    return 0
  fi
  if [ -s "$log" ]; then
    sed -n '/^CMake Error/,$p' "$log" | head -n 20 >&2
  else
    echo "setup: cmake is not installed." >&2
  fi
  echo "setup: please install what is missing (docs/dependencies.md says what each part is), then run this again." >&2
  return 1
}

# apt_knows PACKAGE...: whether the package lists on this machine have all of them.
apt_knows() {
  local package
  for package in "$@"; do
    apt-cache show "$package" >/dev/null 2>&1 || return 1
  done
}

install_missing() {
  local as_root=()
  [ "$(id -u)" = 0 ] || as_root=(sudo)
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600)
  local install=("${apt[@]}" install -y --no-install-recommends "$@")

  if ! apt_knows "$@"; then
    say "fetching the package lists (apt-get update)"
    "${apt[@]}" update >"$log" 2>&1 </dev/null || { cat "$log" >&2; return 1; }
  fi
  say "installing $# Debian packages: $*"
  if ! "${install[@]}" >"$log" 2>&1 </dev/null; then
    say "that failed; once more with fresh package lists"
    if ! { "${apt[@]}" update && "${install[@]}"; } >"$log" 2>&1 </dev/null; then
      tail -n 30 "$log" >&2
      echo "setup: apt-get could not install the packages; its last lines are above." >&2
      return 1
    fi
  fi
}

main() {
  local group names="" wanted need
  for group in "$@"; do
    case $group in -h | --help) usage; return 0 ;; esac
  done
  [ $# -gt 0 ] || set -- build
  for group in "$@"; do
    names+=$(packages_of "$group")$'\n' || return 2
  done
  mapfile -t wanted < <(printf '%s' "$names" | sort -u)

  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    say "this is not a Debian system; what is needed, by its Debian 12 names: ${wanted[*]}"
    go_on_if_cmake_is_content
    return
  fi
  mapfile -t need < <(missing "${wanted[@]}")
  [ ${#need[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    say "neither root nor sudo; as root, please run: apt-get install --no-install-recommends ${need[*]}"
    go_on_if_cmake_is_content
    return
  fi
  install_missing "${need[@]}"
}

main "$@"
