#!/bin/sh
# Another day and another's map: the NCLT session 2013-01-10 in the authors' pole map, and poles from a cloud map.
# Usage: share/experiments/nclt-session.sh DATA_DIR KEYFRAMES_GIT_DIR TRUTH OUT
#   DATA_DIR           has published/nclt_map_8_0.50_0.08.npz
#   KEYFRAMES_GIT_DIR  git directory of a repository whose history has data/ch9/keyframes.txt, key frames and map_data/
#                      (liyongliang999/slam_in_autonomous_driving_change)
#   TRUTH              groundtruth_2013-01-10.csv of NCLT; times may be in s
#   OUT                gets result.json
# A key frame has some 2,500 points only, so several are put together; each pose sees the newest ones only.
# Their number and the least confidence are chosen on the first half of the drive. Odometry: of the LiDAR odometry
# program that made the key frames. Used are the key frames within 10 m of the drive that the authors mapped.
# Programs: build/bin, or POLEMCL_BIN. Needs jq, git, Python with NumPy; some ten minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 4 4 "$@"
authors=$1/published/nclt_map_8_0.50_0.08.npz
keyframes=$2
truth=$3
make_out "$4"
find_programs pole-import pole-map pole-localize
find_tools jq git
[ -f "$authors" ] || die "no map of the authors in $authors"
first=219 # key frames, from 1
last=1046

script() (
  name=$1
  shift
  /usr/bin/python3 "$top/share/experiments/$name.py" "$@"
)

# views FOLDER NAME OPTION...: virtual scans of a folder in OUT.
views() (
  folder=$out/$1
  to=$out/$2
  shift 2
  script virtual_scans "$folder" "$to" --compensated --level --height 0.85 "$@"
)

# import_drive NAME RAWLOG POSES...: the mapped stretch of these views, with odometry and true poses.
import_drive() (
  link_scans "$out/$1" "$out/part" $first $last
  rawlog=$2
  shift 2
  "$bin/pole-import" folder --quiet --embed --input "$out/part" --output "$out/$rawlog.rawlog" --turn compensated \
    --sensor-pose "0 0 0 90.703 0 0" --odometry "$out/odometry.tum" --odometry-of sensor --poses "$@"
)

# localize FRAMES CONFIDENCE DRIVE MAP RUNS [OPTION...]: errors as JSON.
localize() (
  settings=$out/$1.ini
  least=$2
  drive=$out/$3
  map=$out/$4.polemap
  runs=$5
  shift 5
  "$bin/pole-localize" --quiet --config "$settings" --set scan_line.min_confidence="$least" --input "$drive.rawlog" \
    --map "$map" --truth "$drive.tum" --output "$out/run" --runs "$runs" "$@" >/dev/null
  script nclt_compare runs "$out/run"
  rm -r "$out/run"
)

# build_map FRAMES DRIVE MAP: map of a drive, also as CSV.
build_map() {
  "$bin/pole-map" build --quiet --config "$out/$1.ini" --set scan_line.min_confidence="$confidence" \
    --input "$out/$2.rawlog" --truth "$out/$2.tum" --output "$out/$3.polemap"
  "$bin/pole-map" convert --quiet "$out/$3.polemap" --output "$out/$3.csv"
}

script nclt_frames "$keyframes" "$truth" "$out"
"$bin/pole-map" convert --quiet "$authors" --output "$out/authors.polemap"
"$bin/pole-map" convert --quiet "$authors" --output "$out/authors.csv"
: >"$out/settings.jsonl"
for frames in 1 10 20 40 80; do
  views frames "views$frames" --last $frames
  cp "$out/views$frames/settings.ini" "$out/$frames.ini"
  import_drive "views$frames" "drive$frames" "$out/truth.tum"
  for confidence in 0.3 0.5 0.65; do
    localize $frames $confidence "drive$frames" authors 3 >"$out/one.json"
    jq --argjson frames $frames --argjson confidence $confidence \
      '{key_frames: $frames, min_confidence: $confidence} + .' "$out/one.json" >>"$out/settings.jsonl"
  done
done
jq -s . "$out/settings.jsonl" >"$out/settings.json"
frames=$(jq 'min_by(.first_half.mean_m).key_frames' "$out/settings.json")
confidence=$(jq 'min_by(.first_half.mean_m).min_confidence' "$out/settings.json")
drive=drive$frames

localize "$frames" "$confidence" "$drive" authors 10 >"$out/started.json"
for joined in 10 20 40 80; do
  localize $joined "$confidence" drive$joined authors 10 --global >"$out/one.json"
  jq --argjson frames $joined '{key_frames: $frames} + .' "$out/one.json"
done | jq -s . >"$out/global.json"
build_map "$frames" "$drive" own
views path views_cloud --cloud "$out"/tiles/*.pcd
"$bin/pole-import" folder --quiet --input "$out/views_cloud" --output "$out/cloud.rawlog" --turn compensated
build_map "$frames" cloud cloud
import_drive "views$frames" through_cloud "$out/map.tum" --poses-of sensor
localize "$frames" "$confidence" through_cloud cloud 10 >"$out/in_cloud.json"

script nclt_compare poses "$out/$drive.tum" "$out/odometry.tum" >"$out/lidar_odometry.json"
script nclt_compare poses "$out/$drive.tum" "$out/map.tum" >"$out/adjusted.json"
script nclt_compare poses "$out/$drive.tum" "$out/rtk.tum" >"$out/rtk.json"
script nclt_compare poles "$out/own.csv" "$out/authors.csv" "$out/$drive.tum" >"$out/own.json"
script nclt_compare poles "$out/cloud.csv" "$out/authors.csv" "$out/$drive.tum" "$out/map.tum" >"$out/cloud.json"
jq -n --argjson frames "$frames" --argjson confidence "$confidence" \
  --slurpfile settings "$out/settings.json" --slurpfile started "$out/started.json" --slurpfile global "$out/global.json" \
  --slurpfile own "$out/own.json" --slurpfile cloud "$out/cloud.json" --slurpfile in_cloud "$out/in_cloud.json" \
  --slurpfile odometry "$out/lidar_odometry.json" --slurpfile adjusted "$out/adjusted.json" --slurpfile rtk "$out/rtk.json" \
  '{chosen: {key_frames: $frames, min_confidence: $confidence}, in_authors_map: $started[0], in_authors_map_global: $global[0],
    settings: $settings[0], poses_against_truth: {lidar_odometry: $odometry[0], adjusted: $adjusted[0], satellites: $rtk[0]},
    session_map_against_authors: $own[0], cloud_map_against_authors: $cloud[0], in_cloud_map: $in_cloud[0]}' \
  >"$out/result.json"
rm -r "$out"/views* "$out/frames" "$out/path" "$out/tiles" "$out/part" "$out"/*.rawlog
jq -c '.chosen, .in_authors_map, .in_authors_map_global[], .in_cloud_map' "$out/result.json"
