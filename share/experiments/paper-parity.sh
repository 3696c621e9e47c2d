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
#   OUT    gets the maps, parity.csv (each seed), parity.json (the table) and table.md
#   SEEDS  20 unless given
# Programs: build/bin, or POLEMCL_BIN. 5 minutes on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 3 "$@"
data=$(cd "$1" && pwd)
make_out "$2"
seeds=${3:-20}
find_programs pole-import pole-map pole-extract pole-localize
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

# run NAME CONFIG OPTIONS POSES [EXTRACTION]: a row of parity.csv per seed and radius. EXTRACTION: the
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
  seed=1
  while [ "$seed" -le "$seeds" ]; do
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
      printf '%s,%s,%s,%s,%s,%s\n' "$1" "$4" "$radius" "$seed" \
        "$(json_value "$folder/run/summary.json" pos_mean)" \
        "$(json_value "$folder/run/summary.json" ang_mean_deg)" >>"$out/parity.csv"
    done
    seed=$((seed + 1))
  done
}

echo 'settings,poses,start_radius_m,seed,position_m,heading_deg' >"$out/parity.csv"
for poses in poses_scan_matching.txt poses.txt; do
  run paper paper/kitti.ini "$paper_options" $poses
  run paper-mended paper/kitti-mended.ini "$paper_options" $poses
  run ours kitti.ini "" $poses
  run our-poles paper/kitti.ini "$paper_options" $poses kitti.ini
  run paper-poles kitti.ini "" $poses paper/kitti-mended.ini
done

# Ten seeds of the authors' program on its own detections; see the README of the data.
reference='first-implementation,poses_scan_matching.txt,2.5,0.058,0.029,0.143,0.092,0.054,0.184
first-implementation,poses_scan_matching.txt,0.5,0.032,0.024,0.045,0.056,0.026,0.087
first-implementation,poses.txt,2.5,0.055,0.032,0.132,0.076,0.045,0.190
first-implementation,poses.txt,0.5,0.030,0.021,0.045,0.058,0.042,0.088'
{
  printf '%s\n' "$reference" | sed 's/^/10,/'
  awk -F , 'NR > 1 {
      key = $1 "," $2 "," $3
      if (!(key in n)) { order[++keys] = key; p0[key] = h0[key] = 1e9 }
      ++n[key]; p[key] += $5; h[key] += $6
      if ($5 < p0[key]) p0[key] = $5
      if ($5 > p1[key]) p1[key] = $5
      if ($6 < h0[key]) h0[key] = $6
      if ($6 > h1[key]) h1[key] = $6
    }
    END { for (i = 1; i <= keys; ++i) { k = order[i]
      printf "%d,%s,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", n[k], k, p[k] / n[k], p0[k], p1[k], \
        h[k] / n[k], h0[k], h1[k] } }' "$out/parity.csv"
} | sort -s -t , -k 3,3r -k 4,4r >"$out/rows"

awk -F , '
  BEGIN { print "[" }
  { printf "%s  {\"settings\": \"%s\", \"poses\": \"%s\", \"start_radius_m\": %s, \"seeds\": %s,\n", \
      (NR > 1 ? ",\n" : ""), $2, $3, $4, $1
    printf "   \"position_m\": {\"mean\": %s, \"least\": %s, \"greatest\": %s},\n", $5, $6, $7
    printf "   \"heading_deg\": {\"mean\": %s, \"least\": %s, \"greatest\": %s}}", $8, $9, $10 }
  END { print "\n]" }' "$out/rows" >"$out/parity.json"
{
  echo '| poses | start | settings | seeds | position m | heading deg |'
  echo '|---|---|---|---|---|---|'
  awk -F , '{ printf "| %s | %s m | %s | %d | %.3f (%.3f to %.3f) | %.3f (%.3f to %.3f) |\n", \
    $3, $4, $2, $1, $5, $6, $7, $8, $9, $10 }' "$out/rows"
} >"$out/table.md"
rm "$out/rows"
cat "$out/table.md"
