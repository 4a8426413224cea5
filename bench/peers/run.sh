#!/usr/bin/env bash
# Measures Etendue beside other renderers, and writes what it found into docs/performance.md.
set -euo pipefail

usage() {
  cat <<'END'
usage: bench/peers/run.sh [OPTION...]

Installs the other renderers with pip into build/peers/venv, nowhere else, renders every scene with each, and writes
the table, the plots and the images into docs/performance.md and docs/images/peers. The whole takes half an hour; the
machine must have nothing else to do.

  --scenes A,B     only these; the others keep what was measured before
  --peers A,B      of mitsuba, cycles [all]
  --etendue FILE   the program [build/release/etendue]
  --seeds N        images of each renderer, 6 to 10 [6]
  --cores N,M      one thread on each; processor time with one core, time by the clock with more [the last core]
  --quick          small and coarse, to see that it works; documentation stays as it is
END
}

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(cd -- "$here/../.." && pwd)
out=$root/build/peers
program=$root/build/release/etendue
arguments=()
is_quick=
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --etendue) program=${2:?--etendue: which program?}; shift ;;
    --quick) is_quick=1; arguments+=("$1") ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
[ -x "$program" ] || { echo "run.sh: no program $program: build it, or name it with --etendue" >&2; exit 2; }

mkdir -p "$out"
[ -x "$out/venv/bin/python" ] || python3 -m venv "$out/venv"
"$out/venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt"

# Mitsuba compiles with LLVM and fails with those before 17. Debian's package is taken apart, not installed.
newest_llvm() { find "$@" -name 'libLLVM*.so*' 2>/dev/null | grep -E 'libLLVM(-|\.so\.)(1[7-9]|2[0-9])' | sort -V | tail -n 1; }
llvm=${DRJIT_LIBLLVM_PATH:-$(newest_llvm "$out/llvm" /usr/lib/x86_64-linux-gnu /usr/lib/llvm-* || true)}
if [ -z "$llvm" ]; then
  mkdir -p "$out/llvm"
  (cd "$out/llvm" && apt-get download --quiet libllvm19 && dpkg-deb -x libllvm19_*.deb .)
  llvm=$(newest_llvm "$out/llvm")
fi
export DRJIT_LIBLLVM_PATH=$llvm

if [ -n "$is_quick" ]; then out=$out/quick; mkdir -p "$out"; fi
python=$root/build/peers/venv/bin/python
"$python" "$here/compare.py" --etendue "$program" --out "$out" "${arguments[@]}"
[ -n "$is_quick" ] || "$python" "$here/report.py" "$out" "$root/docs"
