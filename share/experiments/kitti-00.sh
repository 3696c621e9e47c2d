#!/bin/sh
# Maps of the beginning of KITTI odometry 00 against the published poles of that sequence (labelled in
# SemanticKITTI): ours, and the paper's method with the authors' settings, mended and as they are.
# Usage: share/experiments/kitti-00.sh DATA_DIR OUT
#   DATA_DIR  folder with kitti_odom_00/ (16 scans), kitti_odom_00_long/ (51 scans) and
#             published/kitti_truth_00.npz
#   OUT       gets the maps, result.json and table.txt
# "polemcl-C-N": the 51 scans with poles and [map] min_confidence of C, and [map] min_count of N.
# One to one within 1 m. Precision: map poles with a labelled pole, of all map poles. Recall: labelled
# poles within 20 m of the path that are on the map.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; one minute.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
data=$1
find_programs pole-import pole-map pole-eval
find_tools jq
truth=$data/published/kitti_truth_00.npz
[ -f "$truth" ] || die "no labelled poles in $truth"
make_out "$2"

"$bin/pole-map" convert --quiet "$truth" --output "$out/truth.csv"

# near TUM: the labelled poles within 20 m of the path.
near() {
  awk -F '[ ,]+' 'NR == FNR { if ($0 !~ /^#/) { x[++n] = $2; y[n] = $3 } next }
    FNR == 1 { print; next }
    { for (i = 1; i <= n; ++i) if (($1 - x[i]) ^ 2 + ($2 - y[i]) ^ 2 <= 400) { print; next } }' \
    "$1" "$out/truth.csv"
}

# score DRIVE NAME CONFIG [OPTION...]: one JSON object.
score() {
  drive=$1 name=$2 config=$3
  shift 3
  map=$out/$drive-$name.polemap
  "$bin/pole-map" build --quiet --config "$config" "$@" --input "$out/$drive.rawlog" --truth "$out/$drive.tum" \
    --output "$map"
  score_map 1 "$truth" "$map" "$out/all.json"
  score_map 1 "$out/$drive-near.csv" "$map" "$out/near.json"
  jq -n --arg drive "$drive" --arg method "$name" --slurpfile a "$out/all.json" \
    --slurpfile n "$out/near.json" --argjson labelled "$(($(wc -l <"$out/$drive-near.csv") - 1))" \
    '{drive: $drive, method: $method, true: $a[0].matches, precision: $a[0].precision,
      map_poles: $a[0].map_poles, found_near: $n[0].matches,
      labelled_near: $labelled, recall: $n[0].recall}'
}

for drive in kitti_odom_00 kitti_odom_00_long; do
  [ -d "$data/$drive" ] || die "no scans in $data/$drive"
  "$bin/pole-import" folder --quiet --input "$data/$drive" --output "$out/$drive.rawlog"
  near "$out/$drive.tum" >"$out/$drive-near.csv"
  score "$drive" polemcl "$top/config/kitti.ini"
  score "$drive" paper-mended "$top/config/paper/kitti-mended.ini"
  score "$drive" paper "$top/config/paper/kitti.ini"
done >"$out/results"
for confidence in 0.65 0.5 0.4 0.3 0.2; do
  for count in 1 2 3 4; do
    score kitti_odom_00_long "polemcl-$confidence-$count" "$top/config/kitti.ini" --set map.min_count=$count \
      --set map.min_confidence=$confidence --set scan_line.min_confidence=$confidence >>"$out/results"
  done
done
collect_results .
rm "$out/all.json" "$out/near.json" "$out"/*.rawlog

table "$out/result.json" '.[] | [.drive, .method, .map_poles, .true, .precision, .labelled_near, .found_near, .recall]' \
  drive method "map poles" true precision:2 "labelled within 20 m" "of these found" recall:2 | tee "$out/table.txt"
