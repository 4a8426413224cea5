#!/usr/bin/env bash
# Makes the machine ready to build: installs the Debian packages that are missing, and nothing else.
set -euo pipefail

usage() {
  cat <<'END'
usage: scripts/setup.sh [GROUP...]

Installs the packages of the groups named (default: build) in scripts/debian-packages.txt that are not
installed yet, as root or through sudo. Says nothing where nothing is missing. Where packages cannot be
installed (no apt-get, neither root nor sudo, no network) it goes on if CMake finds all it needs, else stops and
names what to install.

groups: build    compilers, libraries, test framework
        report   what demo.sh's page needs
        course   what makes readme.pdf of a hand-in: etendue course pack
        browser  tests of pages in a browser
        clang    the second compiler
        develop  clang-format, clang-tidy, what fuzzing needs besides clang
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

# go_on_without WHY PACKAGE...: the last resort where nothing can be installed, as all that is needed may be
# there under other names or in other places. Fails, naming the packages, where CMake does not find it.
go_on_without() {
  local why=$1 package
  shift
  if command -v cmake >/dev/null && (cd "$root" && cmake --preset release) >/dev/null 2>"$log" </dev/null; then
    say "$why; CMake finds all it needs, so going on (all parts: scripts/debian-packages.txt)"
    return 0
  fi
  {
    say "$why, and CMake does not find all it needs."
    [ ! -s "$log" ] || sed -n '/^CMake Error/,$p' "$log" | head -n 20
    say "please install these (Debian 12 names; docs/dependencies.md tells more), then run this again:"
    for package in "$@"; do
      sed -n "s/^\($package  *#.*\)/  \1/p" "$list"
    done
  } >&2
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
    "${apt[@]}" update >"$log" 2>&1 </dev/null || { tail -n 20 "$log" >&2; return 1; }
  fi
  say "installing $# Debian packages: $*"
  if ! "${install[@]}" >"$log" 2>&1 </dev/null; then
    say "that failed; once more with fresh package lists"
    if ! { "${apt[@]}" update && "${install[@]}"; } >"$log" 2>&1 </dev/null; then
      tail -n 20 "$log" >&2
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
    go_on_without "this is not a Debian system" "${wanted[@]}"
    return
  fi
  mapfile -t need < <(missing "${wanted[@]}")
  [ ${#need[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    go_on_without "neither root nor sudo" "${need[@]}"
    return
  fi
  install_missing "${need[@]}" || go_on_without "packages could not be installed" "${need[@]}"
}

main "$@"
