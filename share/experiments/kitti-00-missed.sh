#!/bin/sh
# Labelled poles of KITTI odometry 00 that are not on our map: what the scans hold where they should stand.
# Usage: share/experiments/kitti-00-missed.sh DATA_DIR OUT
#   DATA_DIR  folder with kitti_odom_00_long/ (51 scans) and published/kitti_truth_00.npz
#   OUT       gets the map, labels.csv (all labels near the path, found ones for comparison) and
#             missed.txt (those missed)
# Map, matching and the choice of labels are those of kitti-00.sh: one to one within 1 m, labels within 20 m
# of the path. A label's number is its line among these, from 0. kitti-00-missed.py tells how the columns
# are measured. "weak": the nearest pole of a map without thresholds of count and share, and the number of
# its sightings. "detections": those of all scans, without a threshold of confidence, within 1 m.
# Programs: build/bin, or POLEMCL_BIN. Needs /usr/bin/python3 with numpy (Debian: python3-numpy); half a minute.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
data=$1
find_programs pole-import pole-extract pole-map pole-eval
find_modules numpy
truth=$data/published/kitti_truth_00.npz
drive=$data/kitti_odom_00_long
[ -f "$truth" ] || die "no labelled poles in $truth"
[ -d "$drive" ] || die "no scans in $drive"
config=$top/config/kitti.ini
make_out "$2"

# build NAME [OPTION...]: NAME.polemap and NAME.csv.
build() {
  name=$1
  shift
  "$bin/pole-map" build --quiet --config "$config" "$@" --input "$out/scans.rawlog" --truth "$out/scans.tum" \
    --output "$out/$name.polemap" --csv "$out/$name.csv"
}

"$bin/pole-map" convert --quiet "$truth" --output "$out/truth.csv"
"$bin/pole-import" folder --quiet --input "$drive" --output "$out/scans.rawlog"
build map
build weak --set map.min_count=0.01 --set map.min_share=0
"$bin/pole-extract" --quiet --config "$config" --set scan_line.min_confidence=0 --input "$out/scans.rawlog" \
  --output "$out/poles.rawlog" --csv "$out/poles.csv"
/usr/bin/python3 "$top/share/experiments/kitti-00-missed.py" "$drive" "$out"

# The program that scores maps must count the same labels as found.
score_map 1 "$out/near.csv" "$out/map.polemap" "$out/near.json"
found=$(awk -F , 'NR > 1 && $4 == "yes"' "$out/labels.csv" | wc -l)
[ "$found" -eq "$(json_value "$out/near.json" matches)" ] ||
  die "$found labels found here, not as many by pole-eval: see $out/near.json"
rm "$out/near.json" "$out/poles.rawlog"
cat "$out/missed.txt"
