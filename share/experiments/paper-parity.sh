#!/bin/sh
# Compares paper mode with the authors' program on a real drive: map from the even scans, localized on the
# odd ones. Odometry is the true motion with 2 % noise; each seed draws odometry and filter anew; the
# filter is updated at every scan, has 1000 particles, and starts uniformly in the radius and within
# 5 deg. Prints a table: settings by poses and start disc, means over the seeds (least to greatest), and
# the figures of the authors' program on kitti_raw_0005. `our-poles`: map and filter of paper mode with our
# poles; `paper-poles`: ours with the poles of paper mode, height corrected. pole-import adds 1 mm and 0.006 deg to the sigma
# of the odometry, which costs that program 0.001 to 0.002 m.
# Usage: share/experiments/paper-parity.sh DATA OUT [SEEDS]
#   DATA   the folder of scans (kitti_raw_0005: velodyne/, times.txt, poses.txt and
#          poses_scan_matching.txt)
#   OUT    gets the maps, results (each seed, a line of JSON), parity.json and table.txt
#   SEEDS  20 unless given
# Programs: build/bin, or POLEMCL_BIN. Needs jq; 5 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 3 "$@"
data=$(cd "$1" && pwd)
make_out "$2"
seeds=${3:-20}
find_programs pole-import pole-map pole-extract pole-localize
find_tools jq
[ "$seeds" -ge 1 ] 2>/dev/null || die "SEEDS must be a number of at least 1, not $seeds"
for file in velodyne times.txt poses.txt poses_scan_matching.txt; do
  [ -e "$data/$file" ] || die "no $file in $data"
done

# Cadence, particles and start of the protocol replace those of the settings.
map_options="--set map.every_scan=true --set map.middle=nearest"
start_options="--set start.positions=radius --set start.heading_deg=5"
paper_options="--set tracking.cadence=scan --set start.particles=1000"

# folder_of POSES: the drive with these poses.
folder_of() {
  folder=$out/$(basename "$1" .txt)
  mkdir -p "$folder"
  ln -sfn "$data/velodyne" "$folder/velodyne"
  ln -sf "$data/times.txt" "$folder/times.txt"
  ln -sf "$data/$1" "$folder/poses.txt"
  echo "$folder"
}

# run NAME CONFIG OPTIONS POSES [EXTRACTION]: a line of results per seed and radius. EXTRACTION: the
# configuration that finds the poles, CONFIG unless given.
run() {
  folder=$(folder_of "$4")
  finds=${5:-$2}
  case $2 in kitti.ini) poses_options= ;; *) poses_options=$map_options ;; esac
  [ -f "$folder/even.rawlog" ] ||
    "$bin/pole-import" folder --quiet --input "$folder" --output "$folder/even.rawlog" --every 2
  "$bin/pole-extract" --quiet --config "$top/config/$finds" --input "$folder/even.rawlog" \
    --output "$folder/even_poles.rawlog"
  # shellcheck disable=SC2086 # options: several words
  "$bin/pole-map" build --quiet --config "$top/config/$2" $poses_options \
    --input "$folder/even_poles.rawlog" --truth "$folder/even.tum" --output "$folder/$1.polemap"
  for seed in $(seq "$seeds"); do
    "$bin/pole-import" folder --quiet --input "$folder" --output "$folder/odd.rawlog" --every 2 \
      --offset 1 --odometry-noise 0.02 --seed "$seed"
    "$bin/pole-extract" --quiet --config "$top/config/$finds" --input "$folder/odd.rawlog" \
      --output "$folder/poles.rawlog"
    for radius in 2.5 0.5; do
      # shellcheck disable=SC2086
      "$bin/pole-localize" --quiet --config "$top/config/$2" $start_options $3 \
        --set start.radius_m=$radius --particles 1000 --seed "$seed" \
        --input "$folder/poles.rawlog" --map "$folder/$1.polemap" --truth "$folder/odd.tum" \
        --output "$folder/run"
      jq -c --arg settings "$1" --arg poses "$4" --argjson radius $radius --argjson seed "$seed" '{settings: $settings,
        poses: $poses, start_radius_m: $radius, seed: $seed, pos_mean, ang_mean_deg}' "$folder/run/summary.json" \
        >>"$out/results"
    done
  done
}

for poses in poses_scan_matching.txt poses.txt; do
  run paper paper/kitti.ini "$paper_options" $poses
  run paper-mended paper/kitti-mended.ini "$paper_options" $poses
  run ours kitti.ini "" $poses
  run our-poles paper/kitti.ini "$paper_options" $poses kitti.ini
  run paper-poles kitti.ini "" $poses paper/kitti-mended.ini
done

# Ten seeds of the authors' program on its own detections; see the README of the data.
jq -s '
  def figures($values): {mean: $values[0], least: $values[1], greatest: $values[2]};
  def spread(key): map(key) | figures([add / length, min, max] | map(. * 10000 | round / 10000));
  ([["poses_scan_matching.txt", 2.5, [0.058, 0.029, 0.143], [0.092, 0.054, 0.184]],
   ["poses_scan_matching.txt", 0.5, [0.032, 0.024, 0.045], [0.056, 0.026, 0.087]],
   ["poses.txt", 2.5, [0.055, 0.032, 0.132], [0.076, 0.045, 0.190]],
   ["poses.txt", 0.5, [0.030, 0.021, 0.045], [0.058, 0.042, 0.088]]]
  | map({settings: "first-implementation", poses: .[0], start_radius_m: .[1], seeds: 10, position_m: figures(.[2]),
      heading_deg: figures(.[3])})) as $authors
  | ["first-implementation", "paper", "paper-mended", "ours", "our-poles", "paper-poles"] as $order
  | $authors + (group_by([.settings, .poses, .start_radius_m]) | map((.[0] | {settings, poses, start_radius_m})
      + {seeds: length, position_m: spread(.pos_mean), heading_deg: spread(.ang_mean_deg)}))
  | sort_by(.settings as $name | .poses != "poses_scan_matching.txt", -.start_radius_m, ($order | index($name)))' \
  "$out/results" >"$out/parity.json"
table "$out/parity.json" '.[] | [.poses, .start_radius_m, .settings, .seeds, (.position_m, .heading_deg | .mean, .least,
  .greatest)]' poses "start m" settings seeds "position m:3" least:3 "to most:3" "heading deg:3" least:3 "to most:3" |
  tee "$out/table.txt"
