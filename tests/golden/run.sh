#!/bin/sh
# Runs every way through the programs once and prints a checksum of the numbers in each result.
# Usage: tests/golden/run.sh [--check] [--keep FOLDER] [BIN]
#   BIN            folder of the programs, build/bin unless given
#   --check        compares with tests/golden/checksums.txt; prints the lines that differ and exits with 1
#   --keep FOLDER  leaves the results there, a folder for each case; numbers.py FILE shows what counts
# Names, effective settings, build identity and timings do not count, see numbers.py.
# Real scans: POLEMCL_DATA, or the folder shared/data beside the checkout; without them the cases on
# drive 0005 are left out. Needs python3; 4 minutes on 2 cores.
# After a change of results that is wanted: tests/golden/run.sh >tests/golden/checksums.txt
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
golden=$top/tests/golden
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

# Names of settings, of files in config/ and of the map program's options stand from here on to the line
# that ends this part, and nowhere else in this script.

sensors="hdl32e kitti mulran nclt vlp16"
papers="paper/kitti paper/kitti-mended paper/mulran paper/nclt"
demo_settings=config/demo.ini

# cast_street SENSOR: settings of a short street for that sensor.
cast_street() {
  cat "$top/config/$1.ini"
  cat <<END

[world]
seed = 11
length_m = 60

[simulation]
spacing_m = 1
odometry_noise = 0.02
END
}

# drawn_street: settings of a longer street, its poles drawn from the model of detections.
drawn_street() {
  cat "$top/config/hdl32e.ini"
  cat <<END

[world]
seed = 31
length_m = 400
removed_share = 0.1
added_share = 0.1

[simulation]
odometry_noise = 0.02
detections = $top/share/models/hdl32e.json
END
}

# small_batch: three sessions, two settings, two runs; STREET.ini and TRUTH.csv are in its folder.
small_batch() {
  cat <<END
[batch]
runs = 2
settings = kept once

[sessions]
names = s0 s1 s2
source = simulated
input = street.ini
set = world.length_m=120

[session s0]
date = 2026-01-01
truth_map = truth.csv

[session s1]
date = 2026-02-01
set = world.day=1

[session s2]
date = 2026-03-01
set = world.day=2
truth_map = truth.csv

[setting kept]
config = $top/config/hdl32e.ini
set = filter.particles=200
map_sessions = all
sessions = s1 s2
maps = upkeep

[setting once]
config = $top/config/hdl32e.ini
set = filter.particles=200
sessions = s1 s2
END
}

map_build() { "$bin/pole-map" build --quiet "$@"; }
map_update() { # MAP OPTIONS...
  before=$1
  shift
  "$bin/pole-map" update --quiet --map "$before" "$@"
}
map_add() { # MAP OPTIONS...
  before=$1
  shift
  "$bin/pole-map" build --quiet --add "$before" "$@"
}
map_diff() { # A B OPTIONS...
  first=$1 second=$2
  shift 2
  "$bin/pole-map" diff --quiet "$first" "$second" "$@"
}
map_convert() { # FROM TO OPTIONS...
  from=$1 to=$2
  shift 2
  "$bin/pole-map" convert --quiet "$from" --output "$to" "$@"
}

# Here the names end.

check=no
keep=
while [ $# -gt 0 ]; do
  case $1 in
    --check) check=yes ;;
    --keep)
      [ $# -gt 1 ] || usage
      keep=$2
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
      export POLEMCL_BIN
      ;;
  esac
  shift
done
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval pole-labels \
  pole-batch
bin=$(cd "$bin" && pwd)
export POLEMCL_BIN="$bin"  # pole-batch works in folders of its own
command -v python3 >/dev/null || die "python3 is needed"

data=${POLEMCL_DATA:-$top/../shared/data}
drive=$data/kitti_raw_0005
if [ ! -d "$drive" ]; then
  [ -z "${POLEMCL_DATA-}" ] || die "no drive 0005 in $drive"
  drive=
  echo "no real scans (POLEMCL_DATA): the cases on drive 0005 are left out" >&2
else
  drive=$(cd "$drive" && pwd)
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
work=$folder
if [ -n "$keep" ]; then
  mkdir "$keep"
  work=$(cd "$keep" && pwd)
fi
[ "$check" = no ] || exec 3>&1 >"$folder/found"

# begin CASE: the folder of a case, in which the following works.
begin() {
  case=$1
  mkdir "$work/$case"
  cd "$work/$case"
  : >results
}

# result NAME [FILE...]: these files, or the file NAME, count.
result() {
  name=$1
  [ $# = 1 ] || shift
  echo "$case/$name $*" >>results
}

# finish: prints the lines of the case.
finish() { python3 -IS "$golden/numbers.py" --checksums results; }

# cast DAY: the scans of settings.ini on that day: folder scansDAY, scansDAY.rawlog, scansDAY.tum.
cast() {
  "$bin/pole-simulate" --quiet --config settings.ini --day "$1" --output "scans$1"
  "$bin/pole-import" folder --quiet --input "scans$1" --output "scans$1.rawlog"
  result "scans$1" "scans$1"/velodyne/*.bin "scans$1"/labels/*.label
  result "scans$1/drive" "scans$1/times.txt" "scans$1/poses.txt" "scans$1/odometry.txt" "scans$1.tum"
  result "scans$1/poles_gt.csv"
}

# draw DAY: the poles of settings.ini on that day, without scans: dayDAY.rawlog, dayDAY.tum.
draw() {
  "$bin/pole-simulate" --quiet --config settings.ini --day "$1" --poles "day$1.rawlog"
  for file in "day$1.rawlog" "day$1.tum" "day$1_poles_gt.csv"; do result "$file"; done
}

# extract SCANS NAME: the poles of SCANS.rawlog: NAME.rawlog, NAME.csv.
extract() {
  "$bin/pole-extract" --quiet --config settings.ini --input "$1.rawlog" --output "$2.rawlog" \
    --csv "$2.csv"
  result "$2.rawlog"
  result "$2.csv"
}

# build NAME DRIVE TRUTH OPTIONS...: the map NAME.polemap, NAME.csv of DRIVE.rawlog.
build() {
  map=$1 rawlog=$2 truth=$3
  shift 3
  map_build --config settings.ini --input "$rawlog.rawlog" --truth "$truth.tum" \
    --output "$map.polemap" --csv "$map.csv" "$@"
  result "$map.polemap"
  result "$map.csv"
}

# localize FOLDER DRIVE TRUTH RUNS OPTIONS...: runs on map.polemap, and the errors of the first.
localize() {
  runs=$1 rawlog=$2 truth=$3 count=$4
  shift 4
  "$bin/pole-localize" --quiet --config settings.ini --input "$rawlog.rawlog" --map map.polemap \
    --truth "$truth.tum" --output "$runs" --runs "$count" --seed 1 "$@"
  result "$runs/poses" "$runs"/run_[0-9][0-9].tum
  for kind in cov errors health; do result "$runs/$kind" "$runs"/run_[0-9][0-9]_$kind.csv; done
  result "$runs/summary.json"
  for per in pose metre; do
    judge "$runs-per-$per" trajectory --per $per --truth "$truth.tum" --estimate "$runs/run_00.tum"
  done
}

# judge NAME KIND OPTIONS...: the figures of pole-eval KIND, NAME.json.
judge() {
  figures=$1 kind=$2
  shift 2
  "$bin/pole-eval" "$kind" --quiet --json "$figures.json" "$@" >/dev/null
  result "$figures.json"
}

# judge_map TRUTH: precision and recall of map.polemap.
judge_map() {
  judge map map --truth "$1" --map map.polemap
  judge map-one-to-one map --one-to-one --radius 0.5 --truth "$1" --map map.polemap
}

# two_days RUNS: the map of one day, localization on another.
two_days() {
  for day in 0 1; do
    cast $day
    extract scans$day day$day
  done
  build map day0 scans0
  judge_map scans0/poles_gt.csv
  localize runs day1 scans1 "$1"
}

demo() {
  begin demo
  cp "$top/$demo_settings" settings.ini
  two_days 10
  finish
  rm -r scans[01]
}

# street SENSOR: its scans stay, for the cases that follow.
street() {
  begin "street-$1"
  cast_street "$1" >settings.ini
  two_days 2
  judge detections detections --scans scans0 --poles day0.rawlog --visible visible.csv
  result visible.csv
  judge repeatability repeatability --poles day0.rawlog --truth scans0.tum
  judge rotation rotation --config settings.ini --input scans0.rawlog --every 16
  "$bin/pole-extract" --inspect scans0.rawlog >inspection.txt
  result inspection.txt
  finish
}

# paper_street SETTINGS: the paper's method on the scans of its sensor's street.
paper_street() {
  sensor=${1##*/}
  begin "paper-street-$sensor"
  cp "$top/config/$1.ini" settings.ini
  at=../street-${sensor%-mended}
  for day in 0 1; do
    ln -s "$at/scans$day.rawlog" "$at/scans$day.tum" "$at/scans$day" .
    extract scans$day day$day
  done
  build map day0 scans0
  judge_map scans0/poles_gt.csv
  localize runs day1 scans1 2
  finish
}

# real_drive CASE SETTINGS: the map from the even scans, localization on the odd ones.
real_drive() {
  begin "$1"
  cp "$top/config/$2.ini" settings.ini
  "$bin/pole-import" folder --quiet --input "$drive" --output even.rawlog --every 2
  "$bin/pole-import" folder --quiet --input "$drive" --output odd.rawlog --every 2 --offset 1 \
    --odometry-noise 0.02 --seed 7
  "$bin/pole-import" folder --quiet --input "$drive" --output all.rawlog
  result truth all.tum even.tum odd.tum
  extract all poles
  extract odd odd-poles
  judge repeatability repeatability --poles poles.rawlog --truth all.tum
  judge motion motion --poles poles.rawlog --truth all.tum
  build map even even
  localize runs odd odd 3
  localize runs-on-poles odd-poles odd 1
  localize runs-visual-odometry poles all 1
  finish
}

# A map over three days: kept true, compared, added to, and as other kinds of file.
upkeep() {
  begin update
  drawn_street >settings.ini
  for day in 0 1 2; do draw $day; done
  build map day0 day0 --date 2026-03-02 --keep-scans
  judge sightings sightings --poles day0.rawlog
  map_update map.polemap --config settings.ini --input day1.rawlog day2.rawlog \
    --truth day1.tum day2.tum --date 2026-06-01 2026-09-01 --output kept.polemap --csv kept.csv
  result kept.polemap
  result kept.csv
  judge kept map --one-to-one --radius 0.5 --truth day2_poles_gt.csv --map kept.polemap
  map_diff map.polemap kept.polemap --csv diff.csv >/dev/null
  result diff.csv
  map_add map.polemap --config settings.ini --input day1.rawlog --truth day1.tum \
    --date 2026-06-01 --output added.polemap
  result added.polemap
  map_convert kept.polemap earth.geojson --datum 49.01,8.4,30
  map_convert kept.polemap plain.csv
  map_convert plain.csv again.polemap
  for file in earth.geojson plain.csv again.polemap; do result $file; done
  finish
}

# No start pose, faults, and how uncertain poses are: on the map of the case before.
starts() {
  begin starts
  ln -s ../update/map.polemap ../update/kept.polemap ../update/settings.ini ../update/day1.* .
  localize runs-global day1 day1 2 --global
  localize runs day1 day1 2
  judge consistency consistency --truth day1.tum --cov runs/run_00_cov.csv runs/run_01_cov.csv
  judge global global --config settings.ini --map map.polemap --input day1.rawlog \
    --truth day1.tum --trials 8 --seed 1
  drawn_street >other.ini
  "$bin/pole-simulate" --quiet --config other.ini --seed 32 --poles other.rawlog
  build other other other
  for fault in none kidnap wrong-map blind stuck slip; do
    other=
    [ $fault != wrong-map ] || other="--other-map other.polemap"
    # shellcheck disable=SC2086 # an option and its value
    judge fault-$fault faults --config settings.ini --map map.polemap --input day1.rawlog \
      --truth day1.tum --fault $fault --trials 2 --seed 1 --lead 10 --duration 10 --tail 100 $other
  done
  finish
}

# The model of detections, fitted to two cast days without scans.
model() {
  begin model
  cast_street hdl32e >settings.ini
  for day in 0 1; do draw $day; done
  judge sightings sightings --poles day0.rawlog
  "$bin/pole-eval" model --quiet --drives day0.rawlog day1.rawlog --model model.json >/dev/null
  result model.json
  finish
}

# The poles that stand in a street, from labels; the class of each pole there is its number.
labels() {
  begin labels
  cp -r ../street-kitti/scans0 sequence
  printf 'P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 1 0 0 0 0 1 0 0 0 0 1 0\n' >sequence/calib.txt
  # shellcheck disable=SC2046 # several numbers
  "$bin/pole-labels" --quiet --input sequence --output labels.csv \
    --stems $(awk -F , 'NR > 1 { print $1 }' sequence/poles_gt.csv)
  result labels.csv
  finish
}

batch() {
  begin batch
  drawn_street >street.ini
  "$bin/pole-simulate" --quiet --config street.ini --length 120 --poles truth.rawlog
  mv truth_poles_gt.csv truth.csv
  small_batch >small.ini
  "$bin/pole-batch" --quiet small.ini --output out >/dev/null
  for file in results.json runs.csv sessions.csv maps.csv; do result out/$file; done
  finish
}

demo
for sensor in $sensors; do street "$sensor"; done
for settings in $papers; do paper_street "$settings"; done
model
labels
upkeep
starts
batch
if [ -n "$drive" ]; then
  real_drive drive-0005 kitti
  for settings in paper/kitti paper/kitti-mended; do
    real_drive "drive-0005-${settings##*/}-paper" "$settings"
  done
fi

[ $check = yes ] || exit 0
exec 1>&3
expected=$golden/checksums.txt
[ -n "$drive" ] || {
  grep -v '  drive-0005' "$expected" >"$folder/expected"
  expected=$folder/expected
}
if diff "$expected" "$folder/found" >"$folder/differences"; then
  echo "golden results: $(wc -l <"$folder/found") checksums, none differs"
else
  echo "golden results: these differ (<: as committed, >: now)"
  grep '^[<>]' "$folder/differences"
  exit 1
fi
