# A Slurm cluster of one controller and two nodes on this machine, loopback only. To be sourced.
#   start_cluster DIR    starts it; SLURM_CONF is set, its files are in DIR
#   end_node NAME        ends a node as if its power had failed: daemon and jobs
#   stop_cluster         ends all of it
# shellcheck shell=sh

# Sets what keeps a cluster from being started here; empty if nothing does.
cluster_obstacle() {
  for tool in munged slurmctld slurmd sbatch squeue; do
    PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null 2>&1 || {
      echo "no $tool: install slurm-wlm and munge"
      return
    }
  done
  [ "$(id -u)" = 0 ] || echo "not root"
}

start_cluster() {
  cluster=$1
  PATH=$PATH:/usr/sbin
  mkdir -p "$cluster/state" "$cluster/spool/node1" "$cluster/spool/node2" /run/munge
  chown munge: /run/munge
  pgrep -x munged >/dev/null || su -s /bin/sh munge -c "$(command -v munged)"
  host=$(hostname -s)
  cat >"$cluster/slurm.conf" <<END
ClusterName=polemcl
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=17000
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd-%n.pid
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool/%n
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd-%n.log
AuthType=auth/munge
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmdTimeout=5
JobRequeue=1
NodeName=node[1-2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[17001-17002] CPUs=1 RealMemory=4000
PartitionName=all Nodes=node[1-2] Default=YES State=UP
END
  export SLURM_CONF="$cluster/slurm.conf"
  slurmctld -f "$SLURM_CONF"
  slurmd -f "$SLURM_CONF" -N node1
  slurmd -f "$SLURM_CONF" -N node2
  for _ in $(seq 60); do
    [ "$(sinfo --noheader --format=%T 2>/dev/null | sort -u)" = idle ] && return 0
    sleep 0.5
  done
  echo "the cluster did not start; see $cluster" >&2
  return 1
}

# Processes of jobs carry the name of their node in their environment.
job_processes_of() {
  for process in $(pgrep -f pole-batch) $(pgrep -x slurm_script) $(pgrep pole-); do
    if tr '\0' '\n' 2>/dev/null <"/proc/$process/environ" | grep -qx "SLURMD_NODENAME=$1"; then
      echo "$process"
    fi
  done
}

# The keepers of the steps first: they would tell the controller how their jobs ended.
kill_jobs_of() {
  processes=$(job_processes_of "$1")
  for process in $processes; do
    parent=$(sed -n 's/^PPid:[^0-9]*//p' "/proc/$process/status" 2>/dev/null) || continue
    grep -qs slurmstepd "/proc/$parent/comm" && kill -9 "$parent" 2>/dev/null
  done
  for process in $processes; do
    kill -9 "$process" 2>/dev/null || true
  done
}

end_node() {
  kill -9 "$(cat "$cluster/slurmd-$1.pid")"
  kill_jobs_of "$1"
}

stop_cluster() {
  for pid in "$cluster"/*.pid; do
    [ -e "$pid" ] && kill "$(cat "$pid")" 2>/dev/null || true
  done
}
