#!/bin/sh
# A batch on a real Slurm of two nodes, one of which ends in mid-run: the results are the same bytes
# as without Slurm. Usage: tests/slurm/run.sh; skips, and says why, where no cluster can be started.
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=tests/slurm/cluster.sh
. "$top/tests/slurm/cluster.sh"
POLEMCL_BIN=$(cd "${POLEMCL_BIN:-$top/build/bin}" && pwd)
export POLEMCL_BIN

obstacle=$(cluster_obstacle)
if [ -n "$obstacle" ]; then
  echo "Slurm test: skipped, $obstacle"
  exit 0
fi

folder=$(mktemp -d)
finish() {
  stop_cluster
  sleep 1
  rm -rf "$folder"
}
trap finish EXIT

fail() {
  echo "Slurm test: FAILED: $1" >&2
  tail -n 5 "$folder"/slurm.log "$folder"/cluster/slurmctld.log >&2 || true
  exit 1
}

{
  cat "$top/config/hdl32e.ini"
  printf '\n[world]\nseed = 31\nlength_m = 1000\n[simulation]\ndetections = %s\n' \
    "$top/share/models/hdl32e.json"
} >"$folder/street.ini"
cat >"$folder/try.ini" <<END
[batch]
runs = 4
settings = kept
[sessions]
names = s0 s1 s2 s3
source = simulated
input = street.ini
[session s1]
set = world.day=1
[session s2]
set = world.day=2
[session s3]
set = world.day=3
[setting kept]
config = $top/config/hdl32e.ini
map_sessions = all
sessions = s1 s2 s3
maps = upkeep
END

batch() {
  "$POLEMCL_BIN/pole-batch" --quiet "$folder/try.ini" "$@"
}

batch --output "$folder/here"
start_cluster "$folder/cluster"
batch --output "$folder/there" --slurm >"$folder/slurm.log" 2>&1 &
submitter=$!

# In mid-run: some of its runs are done, the node is at work on another.
runs_done() {
  find "$folder/there/tasks" -maxdepth 1 -name 'run.*' ! -name '*.part' 2>/dev/null | wc -l
}
job_on_node1() {
  squeue --noheader --nodelist=node1 --states=RUNNING --format=%i 2>/dev/null | head -n 1
}
# Held still, it cannot end before its node does.
hold_job_on_node1() {
  held=$(job_processes_of node1)
  [ -n "$held" ] || return 1
  # shellcheck disable=SC2086 # several processes
  kill -STOP $held 2>/dev/null || true
  lost=$(job_on_node1)
  [ -n "$lost" ] && [ -n "$(job_processes_of node1)" ] && return 0
  # shellcheck disable=SC2086
  kill -CONT $held 2>/dev/null || true
  return 1
}
until [ "$(runs_done)" -ge 2 ] && hold_job_on_node1; do
  kill -0 "$submitter" 2>/dev/null || fail "the batch ended before a node could be"
  sleep 0.1
done
end_node node1
echo "Slurm test: node1 ended while it did job $lost; $(runs_done) of 12 runs were done"

wait "$submitter" || fail "the batch failed"
restarts=$(scontrol show job "$lost" 2>/dev/null | sed -n 's/.*Restarts=\([0-9]*\).*/\1/p' | head -n 1)
grep -Eiq "requeu.*JobId=|JobId=.*requeu" "$folder/cluster/slurmctld.log" ||
  [ "${restarts:-0}" -gt 0 ] || fail "job $lost was not requeued"
for result in tasks results.json runs.csv sessions.csv table.tex; do
  diff -r "$folder/here/$result" "$folder/there/$result" >/dev/null ||
    fail "$result differs from that without Slurm"
done
echo "Slurm test: passed; job $lost was requeued, and all results are the same bytes"
