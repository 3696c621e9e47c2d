#!/bin/sh
# Runs all steps once. A street is simulated on two days. The first day gives the map; the second day is
# localized in it ten times. Installs and builds what is missing.
# Usage: share/demo/run.sh [--keep-scans] [OUT]
#   OUT           gets the results, share/demo/out unless given
#   --keep-scans  keeps the simulated scans there too
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

keep=no
out=$top/share/demo/out
while [ $# -gt 0 ]; do
  case $1 in
    --keep-scans) keep=yes ;;
    -h | --help)
      show_header
      exit 0
      ;;
    -*) usage ;;
    *) out=$1 ;;
  esac
  shift
done

"$top/share/setup/install.sh"
"$top/share/setup/build.sh" release polemcl-programs
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
mkdir -p "$out"
out=$(cd "$out" && pwd)
started=$(date +%s)

# drive NAME DAY: simulates one day; leaves NAME.rawlog with the poles of each scan, and NAME.tum.
drive() {
  copy_settings "$top/config/demo.ini" "$out/$1.ini" "world.day=$2"
  rm -rf "$out/scans_$1"
  "$bin/pole-simulate" --quiet --config "$out/$1.ini" --output "$out/scans_$1"
  "$bin/pole-import" folder --quiet --input "$out/scans_$1" --output "$out/scans_$1.rawlog"
  "$bin/pole-extract" --quiet --config "$out/$1.ini" --input "$out/scans_$1.rawlog" \
    --output "$out/$1.rawlog" --csv "$out/$1_poles.csv"
  mv "$out/scans_$1.tum" "$out/$1.tum"
  cp "$out/scans_$1/poles_gt.csv" "$out/$1_poles_true.csv"
  [ "$keep" = yes ] || rm -r "$out/scans_$1" "$out/scans_$1.rawlog"
}
echo "1/4 Simulating the street and finding its poles, for the map"
drive mapping 0
echo "2/4 The same street on another day"
drive another_day 1
echo "3/4 Building the map and localizing ten times"
"$bin/pole-map" build --quiet --config "$out/mapping.ini" --input "$out/mapping.rawlog" \
  --truth "$out/mapping.tum" --output "$out/map.polemap" --csv "$out/map.csv"
"$bin/pole-localize" --quiet --config "$out/another_day.ini" --input "$out/another_day.rawlog" \
  --map "$out/map.polemap" --truth "$out/another_day.tum" --output "$out/runs" --runs 10 --seed 1
echo "4/4 Evaluating and drawing"
"$bin/pole-eval" map --quiet --one-to-one --truth "$out/mapping_poles_true.csv" \
  --map "$out/map.polemap" --json "$out/map.json" >/dev/null
evaluate_runs "$out/runs" "$out/another_day.tum"
"$bin/pole-eval" trajectory --quiet --truth "$out/another_day.tum" \
  --estimate "$out/runs/run_00.tum" --map "$out/map.polemap" \
  --scene "$out/demo.3Dscene" --png "$out/demo.png" \
  --title "The demo street on another day, run 1 of 10" >/dev/null

echo
printf 'Map: precision %.2f, recall %.2f, F1 %.2f (one to one within 1 m)\n\n' \
  "$(json_value "$out/map.json" precision)" "$(json_value "$out/map.json" recall)" \
  "$(json_value "$out/map.json" f1)"
cat "$out/runs/errors.txt"
cat <<END

Took $(($(date +%s) - started)) s. In $out:
  demo.png            map, truth, estimate and errors of the first run
  demo.3Dscene        the same in 3D, for MRPT's SceneViewer3D
  map.polemap         the map (map.csv: as a table)
  runs/run_NN.tum     estimated trajectories (another_day.tum: the truth)
  runs/run_NN_errors.csv, runs/errors.txt, runs/summary.json   errors
END
