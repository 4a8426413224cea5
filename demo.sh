#!/usr/bin/env bash
# Sets up, builds, renders the example scenes with every integrator and writes a page about them.
set -euo pipefail

usage() {
  cat <<'END'
usage: ./demo.sh

Renders scenes/ex3/area_sampling.xml and scenes/ex3/phong_plates.xml with the integrators light, direct, average
and mis, and writes the page out/demo/index.html with the images, their error bars and what they show; the same as
out/demo/report.pdf and readme.pdf. Then recomputes each number of the page's answer to 3.3.4 with a second program.

Installs the Debian packages it needs where they are missing (scripts/setup.sh) and builds in build/release with
CMAKE_BUILD_PARALLEL_LEVEL jobs (default: one a core). Run again, it redoes only what has changed.
END
}

case ${1-} in
  "") ;;
  -h | --help) usage; exit 0 ;;
  *) echo "demo.sh: unknown option '$1'" >&2; usage >&2; exit 2 ;;
esac

cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
SECONDS=0
page=out/demo/index.html

scripts/setup.sh build report
cmake --preset release
cmake --build --preset release --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" --target etendue
/usr/bin/python3 report/make_report.py --etendue build/release/etendue --scenes scenes/ex3 --out out/demo
/usr/bin/python3 report/check_numbers.py out/demo

printf '\nDone in %d min %02d s. The page: %s\nOpen it with: xdg-open %q\n' \
  $((SECONDS / 60)) $((SECONDS % 60)) "$page" "$PWD/$page"
