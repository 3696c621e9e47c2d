#!/bin/sh
# Installs what is missing, builds, and runs every test.
# Usage: tests/run.sh [--quick | --full | STEP...]
#   --quick   the unit tests only: less than a minute after the build
#   --full    all steps, whichever fail, then a table of them; takes half a day on 2 cores. The same command
#             again goes on with the steps that have not passed at this commit
#   lint      format, spelling, hard phrases, ends of lines and files, tests of findings
#   unit      the unit tests
#   test      all tests, files of earlier releases, the installed programs and examples, a kill of each command
#   tidy      clang-tidy
#   golden    figures compared with those of the last release
#   mutation  whether the tests notice faults put into the program
#   viewers   scenes in MRPT's viewer
#   slurm     batches on a Slurm cluster of its own (as root)
#   debian    both commands and the packages in an empty Debian 13 and 12 (as root)
#   site      the documentation site
#   clang     a build with clang
#   sanitize  the tests under the address and undefined-behaviour sanitizers
#   threads   tests with threads of their own under the thread sanitizer
#   valgrind  the examples of --help under Valgrind
#   fuzz      arbitrary bytes for every reader, ten seconds each
#   faults    kills, power cuts, full disks and the like for every command that writes
#   long      24 hours at 10 Hz, from file and live, and a batch of a million scans
#   coverage  lines and branches that the tests reach, room by room
# POLEMCL_DATA names the folder of real scans; without it the tests on them are skipped.
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)

usage() {
  sed -n '2,25s/^# //p' "$0"
  exit "$1"
}

# Usage: run_tests BUILD_FOLDER [options of ctest]
run_tests() {
  build=$1
  shift
  [ -n "${POLEMCL_DATA-}" ] || echo "POLEMCL_DATA is not set: tests on real scans will be skipped"
  ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
}

build() {
  "$top/share/setup/build.sh" "$1" all
}

lint() {
  "$top/tests/lint.sh" format spelling files words faults findings
}

unit() {
  build ci
  run_tests "$top/build" --label-regex '^unit$'
}

all_tests() {
  build ci
  run_tests "$top/build"
  "$top/tests/releases/run.sh"
  "$top/tests/install/run.sh" "$top/build"
  "$top/tests/faults/run.sh" 1 kill
}

sanitize() {
  build sanitize
  # Fontconfig, which MRPT loads, keeps some memory for good; MRPT loses map definitions,
  # and the message of a GNSS receiver at which a rawlog is cut.
  printf 'leak:libfontconfig\nleak:TSetOfMetricMapInitializers\nleak:gnss_message::Factory\n' >"$top/build-sanitize/leaks.txt"
  # GCC 12's leak sanitizer reads wrong sizes of thread-local storage in loaded libraries, and crashes.
  LSAN_OPTIONS="suppressions=$top/build-sanitize/leaks.txt" ASAN_OPTIONS=intercept_tls_get_addr=0 \
    run_tests "$top/build-sanitize"
}

threads() {
  build threads
  "$top/tests/sanitize/tbb.sh" "$top/build-threads/tbb"
  # What the symbolizer cannot read, it would say on the screen of a program, which tests look at.
  printf '#!/bin/sh\nexec /usr/bin/llvm-symbolizer "$@" 2>/dev/null\n' >"$top/build-threads/llvm-symbolizer"
  chmod +x "$top/build-threads/llvm-symbolizer"
  # It tells of two accesses only while it remembers the earlier one: history_size is the most that it can.
  LD_LIBRARY_PATH=$top/build-threads/tbb/lib \
    TSAN_OPTIONS="history_size=7 suppressions=$top/tests/sanitize/threads.txt external_symbolizer_path=$top/build-threads/llvm-symbolizer" \
    run_tests "$top/build-threads" \
    --tests-regex "^($(paste -sd '|' "$top/tests/sanitize/threaded.txt"))(\.|$)"
}

run_step() {
  case $1 in
    lint | unit | sanitize | threads) "$1" ;;
    test) all_tests ;;
    tidy) "$top/tests/lint.sh" tidy ;;
    golden | mutation | viewers | slurm | site | valgrind | fuzz | faults | long) "$top/tests/$1/run.sh" ;;
    debian)
      "$top/tests/install/commands.sh" trixie
      "$top/tests/install/commands.sh" bookworm
      ;;
    clang) build clang ;;
    coverage) "$top/tests/coverage.sh" ;;
  esac
}

# record STEP RESULT BEGIN: a line in the table of this commit.
record() {
  mkdir -p "$top/build"
  printf '%-9s %s %4d min\n' "$1" "$2" $((($(date +%s) - $3) / 60)) | tee -a "$table"
}

# A step that has passed at this commit, here or alone, is not repeated: the command goes on where it was ended.
full() {
  status=0
  case $commit in *-dirty) rm -f "$table" ;; esac
  for step in lint test tidy golden mutation viewers slurm debian site clang sanitize threads valgrind fuzz faults long coverage; do
    ! grep -qs "^$step *passed" "$table" || continue
    echo "tests/run.sh $step"
    begin=$(date +%s)
    "$top/tests/run.sh" "$step" || {
      record "$step" FAILED "$begin"
      status=1
    }
  done
  echo "All steps at $commit:"
  cat "$table"
  exit $status
}

commit=$(git -C "$top" describe --always --dirty --exclude '*' 2>/dev/null) || commit=unknown-dirty
table=$top/build/full-$commit.txt
case "$#:${1-}" in
  0:) set -- test ;;
  1:--quick) set -- unit ;;
  1:--full) full ;;
  1:-h | 1:--help) usage 0 ;;
esac
packages=
for step in "$@"; do
  case $step in
    unit | test | golden | faults | long) ;;
    lint | tidy | mutation | viewers | slurm | debian | site | clang | sanitize | threads | valgrind | fuzz | coverage) packages=full ;;
    *) usage 2 >&2 ;;
  esac
done

if [ -n "${POLEMCL_DATA-}" ]; then
  POLEMCL_DATA=$(cd "$POLEMCL_DATA" && pwd) || {
    echo "tests/run.sh: POLEMCL_DATA must name a folder" >&2
    exit 1
  }
  export POLEMCL_DATA
fi
# shellcheck disable=SC2086 # one word or none
"$top/share/setup/install.sh" $packages
for step in "$@"; do
  begin=$(date +%s)
  run_step "$step"
  record "$step" passed "$begin"
done
