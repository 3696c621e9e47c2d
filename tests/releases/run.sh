#!/bin/sh
# Reads the files that releases wrote (tests/releases/VERSION, made by write.sh) with the programs of today:
# maps, drives, settings and results, as share/doc/files.md promises.
# Usage: tests/releases/run.sh [FOLDER]     Programs: build/bin, or POLEMCL_BIN. Needs python3.
#   FOLDER  only these files, which this version wrote on another system (write.sh); the values must be the same, too
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 0 1 "$@"
[ $# = 0 ] || only=$(cd "$1" && pwd)
find_programs pole-simulate pole-extract pole-map pole-localize pole-eval
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "tests/releases/run.sh: files of $release: $1" >&2
  exit 1
}

# try WHAT COMMAND...: shows what it prints only when it fails.
try() {
  what=$1
  shift
  "$@" >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    fail "$what"
  }
}

# compare HOW OLD NEW
compare() {
  try "$(basename "$2"): not as it was" python3 "$top/tests/releases/compare.py" "$@"
}

# read_maps: each map has the poles of the table beside it, in whatever kind of file.
read_maps() {
  for map in "$old"/*.polemap "$old"/*.npz "$old"/*.geojson; do
    [ -f "$map" ] || continue # a kind that this release did not write
    try "$(basename "$map") is not read" "$bin/pole-map" convert "$map" --output map.csv
    how=places
    [ "${map##*.}" != polemap ] || how=values
    compare "$how" "${map%.*}.csv" map.csv
  done
}

# read_drive: poles, settings and truth make a drive that ends where it did.
read_drive() {
  try "the drive is not localized" "$bin/pole-localize" --config "$settings" --input "$old/poles.rawlog" \
    --map "$old/street.polemap" --truth "$old/poles.tum" --output results --seed 1 --stream stream.json
  mv stream.json results
  try "the new run is not read" "$bin/pole-eval" trajectory --truth "$old/poles.tum" --estimate results/run_00.tum \
    --json results/trajectory.json
  error=$(json_value results/trajectory.json pos_mean)
  awk "BEGIN { exit !($error > 0 && $error < 0.03) }" || fail "the mean error of the drive is $error m"
  for result in "$old"/results/*; do
    compare keys "$result" "results/$(basename "$result")"
  done
  try "the old run is not read" "$bin/pole-eval" trajectory --truth "$old/poles.tum" --estimate "$old/results/run_00.tum"
  try "the map is not updated" "$bin/pole-map" update --config "$settings" --map "$old/street.polemap" \
    --input "$old/poles.rawlog" --truth "$old/poles.tum" --date 2026-03-09 --output updated.polemap
}

# read_model: poles are drawn from the model of detections.
read_model() {
  try "the model of detections is not read" "$bin/pole-simulate" --config hdl32e.ini --length 20 --poles drawn.rawlog \
    --set "simulation.detections=$old/model.json"
}

# read_scans: a map that kept its scans takes another session, and scans give poles.
read_scans() {
  try "no session is added" "$bin/pole-map" build --config "$settings" --add "$old/scans.polemap" \
    --input "$old/poles.rawlog" --truth "$old/poles.tum" --output added.polemap
  try "the scans are not read" "$bin/pole-extract" --config "$old/coarse.ini" --input "$old/scans.rawlog" \
    --output extracted.rawlog --csv poles.csv
  compare keys "$old/poles.csv" poles.csv
}

# same_values: poses and poles are those of the other system; compare.py has the tolerance.
same_values() {
  compare values "$old/results/run_00_errors.csv" results/run_00_errors.csv
  compare values "$old/poles.csv" poles.csv
}

# shellcheck disable=SC2048 # each folder that matches
for old in ${only:-"$top"/tests/releases/*/}; do
  old=${old%/}
  release=$(basename "$old")
  mkdir "$work/$release"
  cd "$work/$release"
  settings=$old/config.ini
  if [ -f "$old/old-names.ini" ]; then # a release before 1.0: its keys had other names
    settings=$top/config/hdl32e.ini
    "$bin/pole-localize" --config "$old/old-names.ini" --print-config >"$work/log" 2>&1 && fail "old names are accepted"
    grep -q 'old-names.ini: \[extraction\] method = native' "$work/log" || fail "the message does not name the key: $(cat "$work/log")"
  fi
  read_maps
  read_drive
  read_model
  [ ! -f "$old/scans.polemap" ] || read_scans
  [ -z "${only-}" ] || same_values
  echo "Files of $release: read"
done
