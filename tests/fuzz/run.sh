#!/bin/sh
# Feeds damaged and forged bytes to every reader, under the address and undefined-behaviour sanitizers.
# Usage: tests/fuzz/run.sh [LIMIT] [TARGET...]
#   LIMIT   seconds for each target, such as 10s (default), executions of each, such as 1000000,
#           or both, such as 1000000,600s: whichever comes first
#   TARGET  one or more of `build-fuzz/bin/fuzz --list` (default: all)
# Prints a table, and exits with 1 if anything was found. Inputs that are findings stay in
# build-fuzz/findings, and inputs that reach other code in build-fuzz/corpus, where later runs go on.
# POLEMCL_FUZZ_RECORD names a CSV that gets a line for each target: share/reports/fuzz.csv.
set -eu
cd "$(dirname "$0")/../.."
fuzz=build-fuzz/bin/fuzz
limit=10s
case ${1-} in
  -h | --help)
    sed -n '2,10s/^# //p' "$0"
    exit 0
    ;;
  [0-9]*)
    limit=$1
    shift
    ;;
esac
options=$(echo "$limit" | sed -nE 's/^([0-9]+)s$/-max_total_time=\1/p; s/^([0-9]+)$/-runs=\1/p
  s/^([0-9]+),([0-9]+)s$/-runs=\1 -max_total_time=\2/p')
[ -n "$options" ] || {
  echo "tests/fuzz/run.sh: a limit is seconds, such as 10s, executions, such as 1000000, or both" >&2
  exit 2
}
share/setup/build.sh fuzz fuzz polemcl-programs

# The files of the fuzzers lie in memory. A fuzzer that is ended leaves its folder.
TMPDIR=$(mktemp -d "$([ -d /dev/shm ] && echo /dev/shm || echo /tmp)/polemcl-fuzz-XXXXXX")
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
# LimitedNew.cpp replaces `new` but not all forms of it, which is no mismatch. tests/run.sh sanitize
# looks for leaks. OpenCV throws where malloc() gives nothing.
export ASAN_OPTIONS=alloc_dealloc_mismatch=0:allocator_may_return_null=1:detect_leaks=0:quarantine_size_mb=16:malloc_context_size=4
export UBSAN_OPTIONS=print_stacktrace=1

# The first inputs: small files of the programs, and those that the fuzzer writes itself.
make_seeds() {
  made=$TMPDIR/made
  mkdir "$made"
  programs=build-fuzz/bin
  street="--quiet --config demo.ini --length 40"
  drive="--quiet build --config demo.ini --input $made/drive.rawlog --truth $made/drive.tum"
  # shellcheck disable=SC2086 # options
  {
    $programs/pole-simulate $street --poles "$made/drive.rawlog"
    $programs/pole-simulate $street --set simulation.spacing_m=20 --output "$made/drive"
    $programs/pole-map $drive --output "$made/street.polemap"
    $programs/pole-map $drive --keep-scans --output "$made/session.polemap"
  }
  $programs/pole-map convert "$made/street.polemap" --output "$made/street.csv"
  $programs/pole-map convert "$made/session.polemap" --output "$made/session.csv"
  $programs/pole-map convert "$made/street.polemap" --output "$made/street.geojson" --datum 50.5,7.25,30
  $programs/pole-simulate --config demo.ini --print-config --all >"$made/all.ini"
  cp config/hdl32e.ini config/batches/kitti.ini config/batches/year.ini share/models/hdl32e.json "$made"
  samples=/usr/share/mrpt/datasets # package mrpt-common
  for pair in rot_scan_2d:rot_scan_2d test_velodyne_VLP16:velodyne rot_scan_velodyne:rotating tests_rgbd:depth; do
    [ ! -f "$samples/${pair%:*}.rawlog" ] ||
      zcat -f "$samples/${pair%:*}.rawlog" | head -c 65536 >"$made/${pair#*:}.rawlog" # as long as inputs may be
  done
  POLEMCL_FUZZ_MADE=$made $fuzz --seeds="$TMPDIR/seeds"
}

# One target; libFuzzer ends at its first finding.
run_target() {
  name=$1
  corpus=build-fuzz/corpus/$name findings=build-fuzz/findings/$name log=build-fuzz/findings/$name.log
  mkdir -p "$corpus" "$findings"
  found=0
  # shellcheck disable=SC2086 # one option or two
  $fuzz --target="$name" $options -rss_limit_mb=2048 -malloc_limit_mb=1024 -timeout=10 -max_len=65536 \
    -print_final_stats=1 -verbosity=1 -close_fd_mask=3 -artifact_prefix="$findings/" \
    "$corpus" "$TMPDIR/seeds/$name" >"$log" 2>&1 || found=1
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  seconds=$(($(date +%s) - begin))
}

record() {
  [ -s "$POLEMCL_FUZZ_RECORD" ] || echo target,executions,seconds,findings,date >"$POLEMCL_FUZZ_RECORD"
  echo "$1" >>"$POLEMCL_FUZZ_RECORD"
}

make_seeds >"$TMPDIR/seeds.log" 2>&1 || {
  cat "$TMPDIR/seeds.log" >&2
  exit 1
}
# shellcheck disable=SC2046 # names, a word each
[ $# -gt 0 ] || set -- $($fuzz --list 2>"$TMPDIR/list.txt")
printf '%-18s %10s %8s %8s %9s\n' target executions seconds per_s findings
status=0
for target in "$@"; do
  begin=$(date +%s)
  run_target "$target"
  printf '%-18s %10s %8s %8s %9s\n' "$target" "${runs:-0}" "$seconds" \
    $((${runs:-0} / (seconds > 0 ? seconds : 1))) "$found"
  [ -z "${POLEMCL_FUZZ_RECORD-}" ] || record "$target,${runs:-0},$seconds,$found,$(date -u +%F)"
  [ "$found" = 0 ] || {
    status=1
    echo "  see build-fuzz/findings/$target.log"
  }
done
exit $status
