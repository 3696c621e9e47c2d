#!/bin/sh
# Tries faults on every command that writes. Under a final name there must be the complete new output,
# the complete earlier one, or nothing; the same command again must give the bytes of an undisturbed run.
# Usage: tests/faults/run.sh [COUNT | --long] [NAME...]
#   COUNT   trials of each fault for each command; more of power and error; 3 unless given
#   --long  as COUNT 25: all power cuts, with ten drawn states of the disk after each; takes hours
#   NAME    only these faults or commands (map-build, batch, ...; see commands.py):
#     kill      kill -9 at a random moment, half of them after the first name comes or goes
#     power     the power is cut: of what was not brought to the disk, all, nothing or any part is lost (Preload.cpp,
#               disk.py)
#     error     a call of the system fails: full disk, broken disk, no descriptor
#     limit     too few descriptors, too little memory or space, no right to write
#     together  two at once with one output; updates: two of pole-map update in place
#     replaced  a map that is read is replaced meanwhile
# Prints a table, and exits with 1 if anything was found. Needs python3.
# POLEMCL_FAULTS_RECORD names a CSV that gets a line for each: share/reports/faults-io.csv.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
case ${1-} in
  -h | --help)
    sed -n '2,16s/^# //p' "$0"
    exit 0
    ;;
  --long) count=25 && shift ;;
  [0-9]*) count=$1 && shift ;;
  *) count=3 ;;
esac
"$top/share/setup/build.sh" ci programs faults-preload
# In memory, where syncing takes no time.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm
exec python3 -B "$top/tests/faults/faults.py" --programs "$top/build/bin" --preload "$top/build/tests/faults/faults-preload.so" \
  ${POLEMCL_FAULTS_RECORD:+--record "$POLEMCL_FAULTS_RECORD"} "$count" "$@"
