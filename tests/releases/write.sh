#!/bin/sh
# Writes the files by which later versions check that they still read those of this one: a step of every release
# (share/doc/releasing.md). Usage: tests/releases/write.sh OUT
#   OUT  a new folder, tests/releases/VERSION
# Two days of a short street whose poles are drawn, and two scans of a coarse LiDAR. About 300 kB.
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 1 "$@"
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
[ ! -e "$1" ] || die "$1 is there already: files of a release are never written again"
mkdir "$1"
out=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# Maps: with histories, with the scans they were made from, and as other kinds of file.
cp "$top/share/models/hdl32e.json" .
cp hdl32e.json "$out/model.json"
for day in 0 1; do
  draw_drive "day$day" "$top/config/hdl32e.ini" 7 "$day" world.length_m=60 simulation.spacing_m=2 \
    simulation.detections=hdl32e.json
done
"$bin/pole-map" build --quiet --config day0.ini --input day0.rawlog --truth day0.tum --keep-scans \
  --datum 50.7,7.1,30 --date 2026-03-02 --output "$out/scans.polemap" --csv "$out/scans.csv" >/dev/null
"$bin/pole-map" update --quiet --config day1.ini --map "$out/scans.polemap" --input day1.rawlog --truth day1.tum \
  --date 2026-03-06 --output "$out/street.polemap" --csv "$out/street.csv" >/dev/null
"$bin/pole-map" convert --quiet "$out/street.polemap" --output "$out/street.geojson" >/dev/null

# A drive and its results; of the settings, all keys.
cp "$out/street.polemap" .
cp day1.rawlog "$out/poles.rawlog"
cp day1.tum "$out/poles.tum"
"$bin/pole-localize" --quiet --config day1.ini --input day1.rawlog --map street.polemap --truth day1.tum \
  --output results --seed 1 --stream stream.json --set start.particles=2000 >/dev/null
mkdir "$out/results"
cp results/config.ini "$out/config.ini"
cp results/summary.json results/timings.json results/run_00.tum results/run_00_*.csv stream.json "$out/results"
"$bin/pole-eval" trajectory --quiet --truth day1.tum --estimate results/run_00.tum \
  --json "$out/results/trajectory.json" >/dev/null

# Scans, and the poles found in them.
copy_settings "$top/config/hdl32e.ini" coarse.ini sensor.model=uniform sensor.rings=24 sensor.columns=600 \
  world.length_m=20 world.seed=7 simulation.spacing_m=15
"$bin/pole-simulate" --quiet --config coarse.ini --output scans >/dev/null
"$bin/pole-import" folder --quiet --input scans --embed --output scans.rawlog >/dev/null
gzip -9n <scans.rawlog >"$out/scans.rawlog"
"$bin/pole-extract" --quiet --config coarse.ini --input scans.rawlog --output extracted.rawlog --csv "$out/poles.csv" \
  >/dev/null
"$bin/pole-extract" --print-config --all --config coarse.ini >"$out/coarse.ini"
