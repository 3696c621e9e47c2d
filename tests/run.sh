#!/bin/sh
# Installs what is missing, builds, and runs every test.
# Usage: tests/run.sh [--quick | --full]
#   --quick  runs the unit tests only: less than a minute after the build
#   --full   also checks format, spelling and clang-tidy, opens scenes in MRPT's viewer, tries batches
#            on a Slurm cluster of its own (as root), runs both commands and tries the packages in an
#            empty Debian 13 and 12 (as root), builds and checks the documentation site, builds with
#            clang, and runs the tests again under the address and undefined-behaviour sanitizers
# POLEMCL_DATA names the folder of real scans; without it the tests on them are skipped.
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)

how=all
case "$#:${1-}" in
  0:) ;;
  1:--quick) how=quick ;;
  1:--full) how=full ;;
  1:-h | 1:--help)
    sed -n '2,9s/^# //p' "$0"
    exit 0
    ;;
  *)
    echo "usage: tests/run.sh [--quick | --full]" >&2
    exit 2
    ;;
esac

if [ -n "${POLEMCL_DATA-}" ]; then
  POLEMCL_DATA=$(cd "$POLEMCL_DATA" && pwd) || {
    echo "tests/run.sh: POLEMCL_DATA must name a folder" >&2
    exit 1
  }
  export POLEMCL_DATA
elif [ "$how" != quick ]; then
  echo "POLEMCL_DATA is not set: tests on real scans will be skipped"
fi

# Usage: run_tests BUILD_FOLDER [options of ctest]
run_tests() {
  build=$1
  shift
  ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
}

"$top/share/setup/install.sh"
if [ "$how" = full ]; then
  "$top/share/setup/install.sh" full
  "$top/tests/lint.sh" format spelling files
fi
"$top/share/setup/build.sh" ci all
case $how in
  quick) run_tests "$top/build" --label-regex '^unit$' ;;
  *)
    run_tests "$top/build"
    "$top/tests/releases/run.sh"
    "$top/tests/install/run.sh" "$top/build"
    ;;
esac

if [ "$how" = full ]; then
  "$top/tests/lint.sh" tidy
  "$top/tests/viewers/run.sh"
  "$top/tests/slurm/run.sh"
  "$top/tests/install/commands.sh" trixie
  "$top/tests/install/commands.sh" bookworm
  "$top/tests/site/run.sh"
  "$top/share/setup/build.sh" clang all
  "$top/share/setup/build.sh" sanitize all
  # Fontconfig, which Cairo uses for texts, keeps some memory for good; MRPT loses map definitions,
  # and a filter of packets for each PCAP file that it opens.
  printf 'leak:libfontconfig\nleak:TSetOfMetricMapInitializers\nleak:libpcap\n' >"$top/build-sanitize/leaks.txt"
  # GCC 12's leak sanitizer reads wrong sizes of thread-local storage in loaded libraries, and crashes.
  LSAN_OPTIONS="suppressions=$top/build-sanitize/leaks.txt" ASAN_OPTIONS=intercept_tls_get_addr=0 \
    run_tests "$top/build-sanitize"
fi
