#!/bin/sh
# Measures the figures of share/reports/ again with one build, one experiment after the other.
# Usage: share/experiments/measure-all.sh DATA KILOMETRE OUT [NAME...]
#   DATA       folder of real scans, with tracks/
#   KILOMETRE  the scans of DATA/kitti_odom_00_km as a folder (real-drives.sh)
#   OUT        gets a folder and a log for each experiment, and reports/: the data files, and measured.csv, which
#              tells the commit, the day and the minutes of each. What is there is not measured again
#   NAME       experiments, as measured.csv names them; all unless given
# Copy OUT/reports/ to share/reports/ then. An experiment that fails is told at the end; the others go on.
# Not among them: unseen-drive.sh and nclt-session.sh, which need repositories of others; scan_matching.py and
# train-classifier.sh, which need programs of others or hours. For speed the machine must do nothing else.
# Programs: build/bin, or POLEMCL_BIN, of the commit that is checked out. Needs jq, python3-scipy, mrpt-apps; hours.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 3 any "$@"
data=$(cd "$1" && pwd)
kilometre=$(cd "$2" && pwd)
mkdir -p "$3/reports"
out=$(cd "$3" && pwd)
shift 3
names=$*
find_tools jq git
[ -z "$(git -C "$top" status --porcelain -- libpolemcl apps config share/experiments)" ] ||
  die "commit the changes first: figures are told by their commit"
commit=$(git -C "$top" rev-parse --short=8 HEAD)
[ -e "$out/reports/measured.csv" ] || echo "experiment,commit,day,minutes" >"$out/reports/measured.csv"
export POLEMCL_DATA="$data"

# measure NAME FILE REPORT SCRIPT ARGUMENTS...: runs the script, @ in its arguments is the folder OUT/NAME. FILE in
# that folder becomes REPORT; if FILE is "printed", what the script prints does.
measure() {
  name=$1 file=$2 report=$3
  shift 3
  case " $names " in *" $name "* | "  ") ;; *) return 0 ;; esac
  ! grep -q "^$name," "$out/reports/measured.csv" || return 0
  echo "$name"
  begun=$(date +%s)
  script=$top/share/experiments/$1
  shift
  for argument in "$@"; do
    shift
    [ "$argument" != @ ] || argument=$out/$name
    set -- "$@" "$argument"
  done
  if ! "$script" "$@" >"$out/$name.txt" 2>"$out/$name.log"; then
    failed="${failed-} $name"
    return 0
  fi
  also "$name" "$file" "$report"
  echo "$name,$commit,$(date +%F),$((($(date +%s) - begun + 59) / 60))" >>"$out/reports/measured.csv"
}

# also NAME FILE REPORT: another FILE of the experiment NAME becomes a report.
also() {
  case $2 in printed) file=$out/$1.txt ;; *) file=$out/$1/$2 ;; esac
  [ ! -e "$file" ] || sed "s#$out/##g" "$file" >"$out/reports/$3"
}

# join REPORT JQ_FILTER PART...: one report of several, if all are there.
join() {
  report=$1 filter=$2
  shift 2
  cd "$out/reports"
  for part in "$@"; do [ -e "$part" ] || return 0; done
  jq -s "$filter" "$@" >"$report"
  rm "$@"
}

measure real-drives result.json real-drives.json real-drives.sh "$data" @
measure kilometre result.json kilometre.json real-drives.sh "$data" @ --kilometre "$kilometre"
measure real-odometry-1 result.json real-1.json real-drives.sh "$data" @ --odometry 0.01,0.01
measure real-odometry-5 result.json real-5.json real-drives.sh "$data" @ --odometry 0.05,0.05
join real-odometry.json '{"0.01,0.01": .[0], "0.05,0.05": .[1]}' real-1.json real-5.json
measure visual-odometry result.json visual-odometry.json kitti-split.sh "$data/kitti_raw_0005" @ \
  "$top/config/kitti.ini" visual
measure map-curves result.json map-curves.json map-curves.sh "$data" "$kilometre" @
measure accumulated-cloud result.json accumulated-cloud.json accumulated-cloud.sh "$data" "$kilometre" @
measure range-correction result.json range-correction.json range-correction.sh "$data" "$kilometre" @
measure paper-parity parity.json paper-parity.json paper-parity.sh "$data/kitti_raw_0005" @
measure kitti-00 result.json kitti-00.json kitti-00.sh "$data" @
measure repeatability result.json repeatability.json repeatability.sh "$data" @
measure kitti-00-missed labels.csv kitti-00-missed.csv kitti-00-missed.sh "$data" @
measure map-errors missed.csv map-errors-missed.csv map-errors.sh "$data" "$kilometre" @
also map-errors false.csv map-errors-false.csv
also map-errors ceiling.csv map-errors-ceiling.csv
measure pole-radii printed pole-radii.txt pole_radii.py "$out/real-drives"
measure paper-extraction-parity table.txt paper-extraction.txt paper-extraction-parity.sh "$data" @
measure likelihood table.txt likelihood.txt likelihood-sweep.sh "$data/kitti_raw_0005" @
measure pf-localization result.json pf-localization.json pf-localization.sh @
measure street-7 result.json street-7.json hdl32-street.sh @ 7
measure consistency result.json consistency.json consistency.sh @
measure odometry-bias result.json odometry-bias.json odometry-bias.sh @
measure odometry-bias-cast result.json odometry-bias-cast.json odometry-bias.sh @ --cast 851 10
measure inventory result.json inventory.json inventory.sh @ 961
measure faults faults.json faults.json faults.sh @
measure faults-541 faults.json faults-541.json faults.sh @ 541
measure faults-kilometre faults.json faults-kilometre.json faults-kilometre.sh "$data" "$kilometre" @
measure faults-sparse result.json faults-sparse.json faults-sparse.sh @
measure leaving-the-map result.json leaving-the-map.json leaving-the-map.sh @
measure starts result.json starts.json starts.sh @
measure year result.json year.json year.sh @ 500 2
measure map-upkeep result.json map-upkeep.json map-upkeep.sh @ 811 4
measure global result.json global-default.json global.sh "$data/tracks" @
measure global-dense result.json global-dense.json global.sh "$data/tracks" @ --dense
join global.json '{default: .[0], dense: .[1]}' global-default.json global-dense.json
measure first-map table.txt first-map.txt first-map.sh @
measure first-map-600 table.txt first-map-600.txt first-map.sh @ 600
measure motion-distortion result.json motion-distortion.json motion-distortion.sh @ 824 3 200
measure pole-sides printed pole-sides.txt pole_sides.py "$out/motion-distortion"
measure two-lidars result.json two-lidars.json two-lidars.sh @ 861 3 150
measure crossed-sensors result.json crossed-sensors.json crossed-sensors.sh @ "$kilometre"
measure map-counting result.json map-counting.json map-counting.sh @
measure map-without-truth result.json map-without-truth.json map-without-truth.sh "$data" @ \
  --kilometre "$kilometre" --tracks "$data/tracks"
measure detection-model table.txt detection-model.txt detection-model.sh @
measure realism result.json realism.json realism.sh @
measure range-image-presets table.txt range-image-presets.txt range-image-presets.sh @ 911 3 200
measure speed result.json speed.json speed.sh "$data" @
measure extraction table.txt extraction.txt extraction.sh "$data" @
[ -z "${failed-}" ] || die "failed, see OUT/NAME.log:$failed"
