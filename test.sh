#!/usr/bin/env bash
# Sets up, builds and runs the tests; the summary of ctest closes the run.
set -euo pipefail

usage() {
  cat <<'END'
usage: ./test.sh [--release | --asan | --clang | --all] [-- CTEST_OPTION...]

  (no option)  every test, optimised; once more the unit and errors tests under ASan and UBSan, and the unit tests
               built by clang
  --release    every test, optimised; nothing else
  --asan       every test under AddressSanitizer and UndefinedBehaviorSanitizer; nothing else
  --clang      the unit tests, built by clang; nothing else
  --all        every test, optimised and under the sanitizers, and the unit tests built by clang

What follows -- goes to ctest: ./test.sh --release -- -R Sphere
Installs the Debian packages it needs where they are missing (scripts/setup.sh). Builds in build/release,
build/asan and build/clang with CMAKE_BUILD_PARALLEL_LEVEL jobs (default: one a core). Tests named asan.* are the
sanitized ones, clang.* those built by clang.
Ends with 0 where every test passed.
END
}

every_kind="unit;statistical;image;errors;structure"
release_kinds=$every_kind
asan_kinds="unit;errors"
clang_kinds="unit"
while [ $# -gt 0 ]; do
  case $1 in
    --release) asan_kinds="" clang_kinds="" ;;
    --asan) release_kinds="" asan_kinds=$every_kind clang_kinds="" ;;
    --clang) release_kinds="" asan_kinds="" ;;
    --all) asan_kinds=$every_kind ;;
    -h | --help) usage; exit 0 ;;
    --) shift; break ;;
    *) echo "test.sh: unknown option '$1'" >&2; usage >&2; exit 2 ;;
  esac
  shift
done

cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
groups=(build)
[ -z "$clang_kinds" ] || groups+=(clang)
scripts/setup.sh "${groups[@]}"
jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

# build PRESET KINDS: builds it with these kinds of tests.
build() {
  printf '\n== %s: build\n' "$1"
  cmake --preset "$1" -DETENDUE_TEST_KINDS="$2"
  cmake --build --preset "$1" --parallel "$jobs"
}

[ -z "$release_kinds" ] || build release "$release_kinds"
[ -z "$asan_kinds" ] || build asan "$asan_kinds"
[ -z "$clang_kinds" ] || build clang "$clang_kinds"

# One list of tests over the builds, so that one summary speaks for all.
mkdir -p build/check
{
  [ -z "$release_kinds" ] || echo 'subdirs([==['"$PWD"'/build/release]==])'
  [ -z "$asan_kinds" ] || echo 'subdirs([==['"$PWD"'/build/asan]==])'
  [ -z "$clang_kinds" ] || echo 'subdirs([==['"$PWD"'/build/clang]==])'
} >build/check/CTestTestfile.cmake
printf '\n== test\n'
exec ctest --test-dir build/check --output-on-failure --no-tests=error --parallel "$jobs" "$@"
