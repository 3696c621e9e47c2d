# Small helpers, sourced by the scripts here and by the demo, which set $top.
# shellcheck shell=sh disable=SC2034,SC2154

die() {
  echo "$(basename "$0"): $1" >&2
  exit 1
}

# show_header: the comment at the head of the script, without the line that names the shell.
show_header() {
  awk 'NR > 1 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "$0"
}

# usage: ends a script that was called wrongly.
usage() {
  show_header >&2
  exit 2
}

# check_arguments LEAST MOST "$@": ends the script with its header on -h or --help, or when it has fewer or more
# arguments; MOST may be "any".
check_arguments() {
  least=$1
  most=$2
  shift 2
  for argument in "$@"; do
    case $argument in
      -h | --help)
        show_header
        exit 0
        ;;
    esac
  done
  [ $# -ge "$least" ] || usage
  [ "$most" = any ] || [ $# -le "$most" ] || usage
}

# find_programs NAME...: sets $bin to POLEMCL_BIN, else build/bin of the checkout.
find_programs() {
  bin=$(cd "${POLEMCL_BIN:-$top/build/bin}" 2>/dev/null && pwd) || bin=${POLEMCL_BIN:-$top/build/bin}
  for program in "$@"; do
    [ -x "$bin/$program" ] || die "no program $bin/$program: build first \
(share/setup/build.sh release programs), or name its folder in POLEMCL_BIN"
  done
}

# find_tools NAME...: ends the script where one of these programs of others is missing.
find_tools() {
  for tool in "$@"; do
    command -v "$tool" >/dev/null || die "$tool is needed: share/setup/install.sh"
  done
}

# find_modules NAME...: the same for modules of Python.
find_modules() {
  for module in "$@"; do
    /usr/bin/python3 -c "import $module" 2>/dev/null || die "$module is needed: install python3-$module"
  done
}

# make_out FOLDER: makes the folder of the results, and sets $out. Lines of a run that was stopped are removed.
make_out() {
  mkdir -p "$1"
  out=$(cd "$1" && pwd)
  rm -f "$out/results"
}

# collect_results FILTER: $out/result.json from the lines of $out/results, as an array, by this filter of jq.
collect_results() {
  jq -s "$1" "$out/results" >"$out/result.json"
  rm "$out/results"
}

# copy_settings FROM TO SECTION.KEY=VALUE...: copies an INI file, with these values changed or added. Works in a
# shell of its own, as draw_drive does, so that its variables are not those of the script.
copy_settings() (
  to=$2
  cp "$1" "$to"
  shift 2
  for assignment in "$@"; do
    key=${assignment%%=*}
    awk -v section="[${key%%.*}]" -v key="${key#*.}" -v value="${assignment#*=}" '
      function add() { if (inside && !done) { print key " = " value; done = 1 } }
      /^[ \t]*\[/ { add(); inside = index($0, section) > 0 }
      inside && $0 ~ "^[ \t]*" key "[ \t]*=" { print key " = " value; done = 1; next }
      { print }
      END { add(); if (!done) { print section; print key " = " value } }
    ' "$to" >"$to.new"
    mv "$to.new" "$to"
  done
)

# json_value FILE KEY: the number under a key of a flat JSON object.
json_value() {
  sed -n "s/.*\"$2\"[ ]*:[ ]*\\([-+.0-9eE]*\\).*/\\1/p" "$1" | head -n 1
}

# table FILE FILTER COLUMN...: a table of the rows, arrays, that this filter of jq makes of the JSON file. A column is
# NAME or NAME:DIGITS, the digits after the point. Columns of numbers stand at the right, others at the left.
table() (
  file=$1
  filter=$2
  shift 2
  {
    printf '%s\t' "$@"
    echo
    jq -r "$filter | @tsv" "$file"
  } | awk -F '\t' '
    NR == 1 { columns = NF - 1 }
    {
      for (i = 1; i <= columns; ++i) {
        value = $i == "" ? "-" : $i
        if (NR == 1) {
          split(value, parts, ":")
          value = parts[1]
          digits[i] = parts[2]
        } else if (value !~ /^-?[0-9][-+.0-9eE]*$/) {
          if (value != "-") left[i] = "-"
        } else if (digits[i] != "") value = sprintf("%." digits[i] "f", value)
        cell[NR, i] = value
        if (length(value) > width[i]) width[i] = length(value)
      }
    }
    END {
      for (row = 1; row <= NR; ++row) {
        line = ""
        for (i = 1; i <= columns; ++i) line = line sprintf("%" left[i] width[i] "s  ", cell[row, i])
        sub(/ *$/, "", line)
        print line
      }
    }'
)

# fault_results NAME FILE...: results of pole-eval faults, without the list of those that failed, under a name.
fault_results() {
  kind=$1
  shift
  jq -s --arg kind "$kind" '{($kind): map(del(.failed))}' "$@"
}

# fault_table FILE: faults.json, of all but healthy drives, a line for each fault.
fault_table() {
  table "$1" 'del(.healthy, .half) | to_entries[] | [.key] + (.value | [(map(.trials) | add), (map(.passed) | add),
    (map(.ok_before) | add), (map(.degraded.max_s) | max), (map(.lost.max_s) | max), (map(.lost.max_m) | max),
    (map(.ok.max_m) | max), (map(.error_after_max_m) | max), (map(.ok_wrong_max_m) | max),
    (map(.ok_beyond_5_sigma_max_s) | max)])' fault trials "as demanded" "ok before" "degraded max s:1" "lost max s:1" \
    "lost max m:1" "ok max m:1" "error after max m:3" "ok wrong max m:1" "beyond 5 sigma max s:1"
}

# Faults that last for a while, of pole-eval faults.
lasting="blind stuck slip jump clock moved half-gone snow late"

# Odometry of simulated drives, unless a script says otherwise: wheel ticks and a gyroscope, with errors that
# their covariances do not know (simulation.md).
wheels="simulation.odometry=wheels simulation.odometry_scale=0.01 simulation.odometry_yaw_deg_m=0.01"
# The true motion with noise of 2 % and that standard deviation, as the paper has it.
noise="simulation.odometry=noise simulation.odometry_noise=0.02 simulation.odometry_scale=0 simulation.odometry_yaw_deg_m=0"

# draw_drive PATH SETTINGS WORLD DAY [SECTION.KEY=VALUE...]: a drive whose poles are drawn from the model of an
# HDL-32E, a scan every 0.5 m and odometry of wheels unless given. Leaves PATH.ini, PATH.rawlog (poles) and PATH.tum.
draw_drive() (
  path=$1
  from=$2
  seed=$3
  day=$4
  shift 4
  # shellcheck disable=SC2086 # several words
  copy_settings "$from" "$path.ini" "simulation.detections=$top/share/models/hdl32e.json" \
    simulation.spacing_m=0.5 $wheels "$@" "world.seed=$seed" "world.day=$day"
  "$bin/pole-simulate" --quiet --config "$path.ini" --poles "$path.rawlog"
)

# simulate_day SETTINGS FOLDER WORLD LENGTH DAY [SECTION.KEY=VALUE...]: a day of a simulated street, a scan
# every 0.5 m and odometry of wheels unless given. Leaves dayN.ini, dayN.rawlog (poles), dayN.tum,
# poles_dayN.csv in the folder; the scans are removed.
simulate_day() (
  from=$1
  folder=$2
  seed=$3
  length=$4
  day=$5
  shift 5
  mkdir -p "$folder"
  # shellcheck disable=SC2086 # several words
  copy_settings "$from" "$folder/day$day.ini" simulation.spacing_m=0.5 $wheels \
    "world.length_m=$length" "world.seed=$seed" "world.day=$day" "$@"
  cd "$folder" || exit
  "$bin/pole-simulate" --quiet --config "day$day.ini" --output scans
  find_poles scans "day$day" "day$day.ini"
  mv scans/poles_gt.csv "poles_day$day.csv"
  rm -r scans
)

# evaluate_runs FOLDER TRUTH: errors of every FOLDER/run_NN.tum as run_NN.json; errors.json has their mean, to four
# digits, and all runs; errors.txt is the same as a table.
evaluate_runs() {
  for estimate in "$1"/run_[0-9]*.tum; do
    [ -f "$estimate" ] || die "no runs in $1"
    "$bin/pole-eval" trajectory --quiet --truth "$2" --estimate "$estimate" --json "${estimate%.tum}.json" >/dev/null
  done
  jq -s '. as $runs | {mean: (.[0] | {pos_mean, pos_rmse, lat_mean, lon_mean, ang_mean_deg, ang_rmse_deg, pos_max}
    | with_entries(.key as $key | .value = ($runs | map(.[$key]) | add / length * 10000 | round / 10000))), runs: .}' \
    "$1"/run_[0-9]*.json >"$1/errors.json"
  table "$1/errors.json" '(.runs | to_entries[]), {key: "mean", value: .mean} | [.key, (.value | .pos_mean, .pos_rmse,
    .lat_mean, .lon_mean, .ang_mean_deg, .ang_rmse_deg, .pos_max)]' run "position m:4" "RMSE m:4" "lateral m:4" \
    "longit. m:4" "heading deg:4" "RMSE deg:4" "largest m:4" >"$1/errors.txt"
}

# find_poles FOLDER DRIVE CONFIG [OPTION...]: DRIVE.rawlog with the poles of these scans, and DRIVE.tum. The options
# are those of pole-import.
find_poles() (
  folder=$1
  drive=$2
  config=$3
  shift 3
  "$bin/pole-import" folder --quiet --input "$folder" --output "$drive.scans.rawlog" "$@"
  "$bin/pole-extract" --quiet --config "$config" --input "$drive.scans.rawlog" --output "$drive.rawlog"
  mv "$drive.scans.tum" "$drive.tum"
  rm "$drive.scans.rawlog"
)

# map_drive DRIVE MAP [OPTION...]: the map of DRIVE.rawlog at its true poses, with the settings DRIVE.ini.
map_drive() (
  drive=$1
  map=$2
  shift 2
  "$bin/pole-map" build --quiet --config "$drive.ini" --input "$drive.rawlog" --truth "$drive.tum" --output "$map" "$@"
)

# localize_drive DRIVE MAP FOLDER [OPTION...]: runs of DRIVE.rawlog in the map, with the settings DRIVE.ini.
localize_drive() (
  drive=$1
  map=$2
  folder=$3
  shift 3
  "$bin/pole-localize" --quiet --config "$drive.ini" --input "$drive.rawlog" --map "$map" --truth "$drive.tum" \
    --output "$folder" "$@"
)

# score_map RADIUS TRUTH MAP JSON: a map against true poles, one to one within this radius.
score_map() {
  "$bin/pole-eval" map --quiet --one-to-one --radius "$1" --truth "$2" --map "$3" --json "$4" >/dev/null
}

# score_near RADIUS TRUTH NEAR MAP: precision against all true poles, recall of those near the path, and F1, as JSON.
score_near() {
  score_map "$1" "$2" "$4" "$4.all.json"
  score_map "$1" "$3" "$4" "$4.near.json"
  jq -s '{precision: .[0].precision, recall: .[1].recall} | .f1 = 2 * .precision * .recall / (.precision + .recall)' \
    "$4.all.json" "$4.near.json"
}

# LiDARs that turn clockwise, begin at the back, and are stamped when they face forward: options of pole-import.
clockwise="--turn clockwise --cut-deg 180 --stamp-turn 0.5"

# link_scans DRIVE FOLDER FIRST LAST: the scans FIRST to LAST (from 1) of a drive as a folder of their own, as links.
link_scans() (
  from=$(cd "$1" && pwd)
  rm -rf "$2"
  mkdir -p "$2/velodyne"
  for file in times.txt poses.txt; do grep -v '^#' "$from/$file" | sed -n "$3,$4p" >"$2/$file"; done
  find "$from/velodyne/" -name '*.bin' | sort | sed -n "$3,$4p" | while read -r scan; do ln -s "$scan" "$2/velodyne/"; done
)

# kilometre_arguments DATA_DIR KILOMETRE OUT: sets labels, kilometre and out, which is made.
kilometre_arguments() {
  check_arguments 3 3 "$@"
  labels=$(cd "$1/kitti_odom_00_km" && pwd)
  kilometre=$(cd "$2" && pwd)
  make_out "$3"
}
