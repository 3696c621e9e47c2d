#!/bin/sh
# Runs the main ways through the programs and compares their figures with those of the last release.
# Usage: tests/golden/run.sh [--write] [--tolerance SHARE] [BIN]
#   BIN                folder of the programs, build/bin unless given
#   --write            writes the figures to tests/golden/figures.txt, after a wanted change of results
#   --tolerance SHARE  figures may differ by this share, as between instruction sets: 0.05 (default: 0)
# Real scans: POLEMCL_DATA, or the folder shared/data beside the checkout; without them the cases on
# drive 0005 are left out. Needs python3. Prints the figures that differ, and exits with 1 if one does.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

write=no
tolerance=0
while [ $# -gt 0 ]; do
  case $1 in
    --write) write=yes ;;
    --tolerance)
      [ $# -gt 1 ] || usage
      tolerance=$2
      shift
      ;;
    -h | --help)
      show_header
      exit 0
      ;;
    -*) usage ;;
    *)
      [ $# = 1 ] || usage
      POLEMCL_BIN=$1
      ;;
  esac
  shift
done
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
command -v python3 >/dev/null || die "python3 is needed"
drive=${POLEMCL_DATA:-$top/../shared/data}/kitti_raw_0005
[ -d "$drive" ] || echo "no real scans (POLEMCL_DATA): the cases on drive 0005 are left out" >&2

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
mkdir "$work/figures"

# begin CASE SETTINGS: the folder of a case, in which the following works.
begin() {
  case=$1
  mkdir "$work/$case"
  cd "$work/$case"
  cp "$top/config/$2" settings.ini
}

# judge NAME KIND OPTIONS...: the figures of pole-eval KIND count.
judge() {
  name=$1 kind=$2
  shift 2
  "$bin/pole-eval" "$kind" --quiet --json "$work/figures/$case-$name.json" "$@" >/dev/null
}

# localize DRIVE: three runs of it on map.polemap.
localize() {
  "$bin/pole-localize" --quiet --config settings.ini --input "$1.rawlog" --map map.polemap \
    --truth "$1.tum" --output runs --runs 3 --seed 1
  for run in 00 01 02; do judge "run$run" trajectory --truth "$1.tum" --estimate "runs/run_$run.tum"; done
}

# demo: a simulated street; the map of one day, localization on another, and the map kept true with it.
demo() {
  begin demo demo.ini
  for day in 0 1; do
    "$bin/pole-simulate" --quiet --config settings.ini --day $day --output "scans$day"
    "$bin/pole-import" folder --quiet --input "scans$day" --output "day$day.rawlog"
  done
  "$bin/pole-map" build --quiet --config settings.ini --input day0.rawlog --truth day0.tum \
    --date 2026-03-02 --output map.polemap
  judge map map --one-to-one --radius 0.5 --truth scans0/poles_gt.csv --map map.polemap
  localize day1
  "$bin/pole-map" update --quiet --config settings.ini --map map.polemap --input day1.rawlog \
    --truth day1.tum --date 2026-06-01 --output kept.polemap
  judge kept map --one-to-one --radius 0.5 --truth scans1/poles_gt.csv --map kept.polemap
  "$bin/pole-extract" --quiet --config settings.ini --input day0.rawlog --output poles.rawlog
  judge detections detections --scans scans0 --poles poles.rawlog
}

# real_drive CASE SETTINGS: the map from the even scans, localization on the odd ones.
real_drive() {
  begin "$1" "$2"
  "$bin/pole-import" folder --quiet --input "$drive" --output even.rawlog --every 2
  "$bin/pole-import" folder --quiet --input "$drive" --output odd.rawlog --every 2 --offset 1 \
    --odometry-noise 0.02 --seed 7
  "$bin/pole-map" build --quiet --config settings.ini --input even.rawlog --truth even.tum \
    --output map.polemap
  localize odd
  "$bin/pole-extract" --quiet --config settings.ini --input even.rawlog --output poles.rawlog
  judge repeatability repeatability --poles poles.rawlog --truth even.tum
}

demo
if [ -d "$drive" ]; then
  real_drive drive-0005 kitti.ini
  real_drive drive-0005-paper paper/kitti.ini
fi
python3 -IS "$top/tests/golden/figures.py" "$work/figures" "$top/tests/golden/figures.txt" "$tolerance" "$write"
