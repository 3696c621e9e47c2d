#!/bin/sh
# Installs what is missing, builds, and runs every test.
# Usage: tests/run.sh [--full]
#   --full  then opens scenes in MRPT's viewer, tries batches on a Slurm cluster of its own (as
#           root), builds with the address and undefined-behaviour sanitizers and runs the tests again
# POLEMCL_DATA names the folder of real scans; without it the tests on them are skipped.
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)

full=no
case "$#:${1-}" in
  0:) ;;
  1:--full) full=yes ;;
  1:-h | 1:--help)
    sed -n '2,6s/^# //p' "$0"
    exit 0
    ;;
  *)
    echo "usage: tests/run.sh [--full]" >&2
    exit 2
    ;;
esac

if [ -n "${POLEMCL_DATA-}" ]; then
  POLEMCL_DATA=$(cd "$POLEMCL_DATA" && pwd) || {
    echo "tests/run.sh: POLEMCL_DATA must name a folder" >&2
    exit 1
  }
  export POLEMCL_DATA
else
  echo "POLEMCL_DATA is not set: tests on real scans will be skipped"
fi

run_tests() {
  ctest --test-dir "$1" --output-on-failure --parallel "$(nproc)"
}

"$top/share/setup/install.sh"
"$top/share/setup/build.sh" release all
run_tests "$top/build"

if [ "$full" = yes ]; then
  "$top/share/setup/install.sh" full
  "$top/tests/viewers/run.sh"
  "$top/tests/slurm/run.sh"
  "$top/share/setup/build.sh" sanitize all
  run_tests "$top/build-sanitize"
fi
