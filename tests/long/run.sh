#!/bin/sh
# A drive of 24 hours at 10 Hz, from file and live, and a batch of a million scans: does memory stay flat, is no
# step slow, is no pose NaN, are the bytes the same?
# Usage: tests/long/run.sh [--hours N] [--speed N] [--minutes N] [--runs N] [OUT [PART...]]
#   --hours    of the drive; 24 unless given
#   --speed    of the live drive, in times that of the vehicle; 50 unless given
#   --minutes  of packets of a LiDAR; 10 unless given
#   --runs     of the batch, a thousand scans each; 1000 unless given, at least 10
#   OUT        folder for the results, long.json among them; drives in it are used again
#   PART       of these, all unless given:
#     file     the drive from file twice, one after the other: with one thread and with two
#     live     the drive through the queue of --sensors, from a driver that plays the rawlog (Player.cpp)
#     packets  a standing HDL-32E, whose packets come by UDP at the rate of the sensor
#     batch    the runs by pole-batch
# The vehicle goes round and round a closed road of 3 km at 5 m/s, in the map of its first lap on another day.
# Memory is VmRSS, once a second; of the batch that of pole-batch, and its largest child is told. Exits with 1 when
# memory grows by more than 5 MB after the first hour (live packets: minute; batch: run), a pose is NaN or missing,
# bytes differ, or a run fails; also when 99.9 % of the steps of a drive, from file or live, take up to more than 5
# times the median: give the machine nothing else to do. Other latencies are reported only. Programs: build/bin, or
# POLEMCL_BIN; the driver: build/tests/long/long-player.so, or POLEMCL_LONG_PLAYER. Needs 4 GB on the disk; two
# hours on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

hours=24 speed=50 minutes=10 runs=1000
while :; do
  case ${1-} in
    -h | --help) show_header && exit 0 ;;
    --hours) hours=${2-} ;;
    --speed) speed=${2-} ;;
    --minutes) minutes=${2-} ;;
    --runs) runs=${2-} ;;
    -*) usage ;;
    *) break ;;
  esac
  case ${2-} in '' | *[!0-9]*) usage ;; esac
  shift 2
done
if [ $# -gt 0 ]; then
  out=$1
  shift
else
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
fi
[ $# -gt 0 ] || set -- file live packets batch
for part in "$@"; do
  case $part in
    file | packets | batch) ;;
    live) [ -n "${POLEMCL_LONG_PLAYER-}" ] || "$top/share/setup/build.sh" ci long-player ;;
    *) usage ;;
  esac
done
[ -n "${POLEMCL_BIN-}" ] || "$top/share/setup/build.sh" ci programs
find_programs pole-simulate pole-map pole-localize pole-batch
mkdir -p "$out"
out=$(cd "$out" && pwd)

# draw NAME DAY SCANS: a drive on the long road.
draw() {
  [ -f "$out/$1.rawlog" ] || draw_drive "$out/$1" "$top/config/hdl32e.ini" 7 "$2" "world.track=$out/track.txt" \
    "simulation.scans=$3"
}

draw_drives() {
  if [ ! -f "$out/street.polemap" ] || [ ! -f "$out/drive.rawlog" ]; then
    python3 -B "$top/tests/long/track.py" $((hours * 3600 * 5)) >"$out/track.txt"
    draw mapped 0 6200
    draw drive 1 $((hours * 36000))
  fi
  "$bin/pole-map" build --quiet --config "$top/config/hdl32e.ini" --input "$out/mapped.rawlog" \
    --truth "$out/mapped.tum" --output "$out/street.polemap"
}

# batch_file: 10 sessions in one street of 510 m, on a map of their first.
batch_file() {
  cat <<END
[batch]
title = A million scans
runs = $((runs / 10))
settings = kept
[sessions]
names = mapped s0 s1 s2 s3 s4 s5 s6 s7 s8 s9
source = simulated
input = $top/config/hdl32e.ini
set = simulation.detections=$top/share/models/hdl32e.json $wheels world.length_m=510
END
  for i in 0 1 2 3 4 5 6 7 8 9; do
    printf '[session s%s]\nset = simulation.detections=%s %s world.length_m=510 world.day=%s\n' \
      "$i" "$top/share/models/hdl32e.json" "$wheels" $((i + 1))
  done
  cat <<END
[setting kept]
config = $top/config/hdl32e.ini
map_sessions = mapped
sessions = later
END
}

status=0
measure() {
  python3 -B "$top/tests/long/measure.py" --bin "$bin" --out "$out" "$@" || status=1
}
for part in "$@"; do
  echo "long: $part"
  case $part in
    file) draw_drives && measure file --config "$top/config/hdl32e.ini" ;;
    live)
      draw_drives
      measure live --config "$top/config/hdl32e.ini" --speed "$speed" \
        --player "${POLEMCL_LONG_PLAYER-$top/build/tests/long/long-player.so}"
      ;;
    packets) measure packets --config "$top/config/hdl32e.ini" --minutes "$minutes" ;;
    batch) batch_file >"$out/million.ini" && measure batch --runs $((runs / 10 * 10)) ;;
  esac
done
exit $status
