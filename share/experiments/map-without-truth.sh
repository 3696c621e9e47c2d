#!/bin/sh
# Maps from LiDAR and odometry alone: errors of the poses that `pole-map build` finds without --truth.
# Usage: share/experiments/map-without-truth.sh DATA_DIR OUT [--kilometre SCANS] [--tracks DIR]
#   DATA_DIR     folder with kitti_raw_0005/, vlp16_loop/ and nuscenes_scene/
#   OUT          gets maps, pictures, trajectories, result.json and table.txt
#   --kilometre  the scans of DATA_DIR/kitti_odom_00_km as a folder (228 of Jichao-Peng/multi-sensor_fusion_learning)
#   --tracks     folder of the road kaist01.txt.gz (sensor poses, 12 numbers a line)
# Odometry is the true motion with 2 % noise, 1 % too long and 0.01 deg/m off (seeds 7 to 11 on the VLP-16 loop, 7 on
# the others); on the kilometre also that of a real laser odometry, and the same in a wrong frame (x to the left:
# "-turned"). nuScenes has the poses by the planes in its scans
# (plane_adjustment.py); "sides_apart" is how far those by the points on the left and on the right end apart.
# "street": worlds 701 to 720, drawn, 600 m, wheels: no place is passed again, so each loop is false.
# "-alone": without any odometry, by the poles alone; "cast-630" to "cast-633" also: streets of 400 m, a scan a metre,
# the next numbers that nothing was looked at on.
# "-clock": the clock of the scans, off by these seconds; "-uncorrected": scans of a turning LiDAR whose
# motion is not corrected. "timing": what the program says of it, for all drives.
# "cast-kaist01": 2 km of KAIST 01 where it passes streets again, cast.
# "several drives": the even and the odd key frames of the kilometre, each with an odometry of its own (seeds 7, 8),
# at once and the odd ones added to the map of the even; two days of the streets 701 to 704 at once. "apart": each
# street and the next one, which are different places: 20 pairs that must be refused. "gnss": fixes drawn by
# gnss_fixes.py (seed 7) for the streets 701 to 704 and KAIST 01.
# "localized": a second day of the streets 701 to 704 in the map without truth and in that of the true poses: share
# of the scans that are ok, and errors after the best rigid motion within 60 m (local_error.py).
# Programs: build/bin, or POLEMCL_BIN. Needs jq, python3-numpy and python3-scipy; 30 minutes.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 6 "$@"
data=$(cd "$1" && pwd)
make_out "$2"
shift 2
kilometre="" tracks=""
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || usage
  case $1 in
    --kilometre) kilometre=$(cd "$2" && pwd) ;;
    --tracks) tracks=$(cd "$2" && pwd) ;;
    *) usage ;;
  esac
  shift 2
done
find_programs pole-simulate pole-import pole-extract pole-map pole-localize
find_tools jq
find_modules scipy
biased="--odometry-noise 0.02 --odometry-scale 0.01 --odometry-yaw-deg-m 0.01"
cd "$out"

# with_ending ENDING SEPARATOR NAME...: names of files.
with_ending() {
  ending=$1 separator=$2 files=""
  shift 2
  for file in "$@"; do files="$files${files:+$separator}$file$ending"; done
  echo "$files"
}

# map NAME CONFIG "DRIVE..." "TRUTH..." SIGMAS [OPTION...]: a line of results. Drives and truths without endings.
# shellcheck disable=SC2086,SC2046 # lists of words
map() {
  name=$1 drives=$3 truths=$4 sigmas=$5
  config=$2
  shift 5
  found=$(for drive in $drives; do echo "$name-$drive-found"; done)
  begin=$(date +%s)
  "$bin/pole-map" build --config "$config" "$@" --input $(with_ending .rawlog " " $drives) --output "$name.polemap" \
    --trajectory $(with_ending .tum " " $found) --png "$name.png" >"$name.txt" 2>"$name.warnings"
  seconds=$(($(date +%s) - begin))
  loops=$(sed -n 's/.*; \([0-9]*\) places passed again.*/\1/p' "$name.txt")
  timing=$(sed -n 's/.*clock_offset_s = \([-0-9.]*\).*/clock: set \1/p; s/.*not look corrected.*/not corrected/p' "$name.warnings")
  /usr/bin/python3 "$top/share/experiments/aligned_error.py" "$(with_ending .tum , $truths)" \
    "$(with_ending .tum , $found)" "$(with_ending _cov.csv , $found)" "$sigmas" |
    jq -c --arg drive "$name" --argjson loops "$loops" --argjson seconds $seconds --arg timing "$timing" \
      '{drive: $drive, loops: $loops} + . + {seconds: $seconds, timing: $timing}' >>results
}

# real NAME FOLDER CONFIG SIGMAS MOUNTING "IMPORT OPTIONS" [OPTION...]
real() {
  name=$1 folder=$2 config=$3 sigmas=$4 mounting=$5 options=$6
  shift 6
  # shellcheck disable=SC2086 # several words
  "$bin/pole-import" folder --quiet --input "$folder" --output "$name.scans.rawlog" --sensor-pose "$mounting" $options
  "$bin/pole-extract" --quiet --config "$config" "$@" --input "$name.scans.rawlog" --output "$name.rawlog"
  map "$name" "$config" "$name" "$name.scans" "$sigmas" "$@"
  rm "$name.scans.rawlog"
}

# alone NAME FOLDER CONFIG SIGMAS MOUNTING "IMPORT OPTIONS" [OPTION...]: real() without any odometry.
alone() {
  name=$1 folder=$2
  shift 2
  link_scans "$folder" "$out/alone" 1 99999
  real "$name-alone" alone "$@"
  rm -r alone
}

cast_street() {
  "$bin/pole-simulate" --quiet --config "$top/config/hdl32e.ini" --seed "$1" --length 400 \
    --set simulation.spacing_m=1 --output cast >/dev/null
  alone "cast-$1" "$out/cast" "$top/config/hdl32e.ini" 0,0 "0 0 0 0 0 0" ""
  rm -r cast
}

# Metres 3000 to 5000 of KAIST 01, cast, world 601, a scan a metre, wheels.
cast_kaist() {
  gunzip -c "$tracks/kaist01.txt.gz" | awk '
    NR > 1 { way += sqrt(($4 - x) ^ 2 + ($8 - y) ^ 2) }
    { x = $4; y = $8 }
    way >= 3000 && way <= 5000' >kaist.txt
  # shellcheck disable=SC2086 # several words
  copy_settings "$top/config/hdl32e.ini" kaist.ini $wheels world.seed=601 world.track=kaist.txt simulation.spacing_m=1
  "$bin/pole-simulate" --quiet --config kaist.ini --output kaist >/dev/null
  real cast-kaist01 kaist "$top/config/hdl32e.ini" 0,0 "0 0 0 0 0 0" ""
  rm -r kaist kaist.*
}

# planes_apart POSES POSES: how far the last poses are apart when the first ones are laid on each other.
planes_apart() {
  paste -d ' ' "$1" "$2" | awk '
    function yaw(k) { return atan2($(k + 4), $k) }
    function away(k, own) { own["x"] = $(k + 3) - begin[k]; own["y"] = $(k + 7) - begin[k + 1] }
    NR == 1 { for (k = 1; k <= 13; k += 12) { begin[k] = $(k + 3); begin[k + 1] = $(k + 7); turn[k] = yaw(k) } }
    { away(1, a); away(13, b); angle = turn[1] - turn[13]
      x = cos(angle) * b["x"] - sin(angle) * b["y"] - a["x"]; y = sin(angle) * b["x"] + cos(angle) * b["y"] - a["y"]
      deg = (yaw(13) - turn[13] - yaw(1) + turn[1]) * 180 / 3.14159265 }
    END { printf "{\"truth\": \"nuscenes-planes\", \"sides_apart_m\": %.3f, \"sides_apart_deg\": %.3f}\n",
      sqrt(x * x + y * y), sqrt(deg * deg) }'
}

# nuScenes with the poses by planes.
nuscenes() {
  set -- --set sensor.height_m=1.84 --set sensor.min_range_m=2.5
  "$bin/pole-import" folder --quiet --input "$data/nuscenes_scene" --output planes.rawlog
  "$bin/pole-extract" --quiet --config "$top/config/hdl32e.ini" "$@" --input planes.rawlog --output planes-poles.rawlog \
    --csv planes.csv
  for side in "" left right; do
    # shellcheck disable=SC2086 # one word or none
    /usr/bin/python3 "$top/share/experiments/plane_adjustment.py" "$data/nuscenes_scene" planes.csv "planes$side.txt" 0 \
      $side >"planes$side.log"
  done
  planes_apart planesleft.txt planesright.txt >>results
  rm -rf planes planes*.rawlog
  link_scans "$data/nuscenes_scene" "$out/planes" 1 39
  cp planes.txt planes/poses.txt
  real nuscenes-planes planes "$top/config/hdl32e.ini" 0.01,0.03 "0 0 0 0 0 0" "$biased --seed 7" "$@"
  alone nuscenes-planes "$out/planes" "$top/config/hdl32e.ini" 0.01,0.03 "0 0 0 0 0 0" "" "$@"
}

# The second day of a street in both maps of the first.
localized() {
  draw_drive "$out/again-$1" "$top/config/hdl32e.ini" "$1" 1 world.length_m=600
  map_drive "street-$1" "true-$1.polemap"
  for kind in street true; do
    "$bin/pole-localize" --quiet --config "again-$1.ini" --input "again-$1.rawlog" --map "$kind-$1.polemap" --global \
      --output "localized-$kind-$1" >/dev/null
    error=$(/usr/bin/python3 "$top/share/experiments/local_error.py" "again-$1.tum" "localized-$kind-$1/run_00.tum")
    awk -F, -v kind=$kind -v world="$1" -v error="$error" 'FNR > 1 { n++; ok += $3 == "ok" }
      END { printf "{\"localized\": %d, \"map\": \"%s\", \"ok\": %.4f, \"local\": %s}\n", world,
            kind == "true" ? "true poses" : "without truth", ok / n, error }' "localized-$kind-$1/run_00_health.csv" >>results
  done
}

# gnss DRIVE: the same with fixes; "earth": rms of the positions as they are on the plane, m, and their NEES.
gnss() {
  /usr/bin/python3 "$top/share/experiments/gnss_fixes.py" "$1.tum" 7 >"$1.csv"
  map "gnss-$1" "$1.ini" "$1" "$1" 0,0 --gnss "$1.csv" --datum 48,9
  earth=$(/usr/bin/python3 "$top/share/experiments/plane_error.py" "$1.tum" "gnss-$1-$1-found.tum" "gnss-$1-$1-found_cov.csv")
  jq -c --argjson earth "$earth" '.nees = null | . + $earth' <<END >results.last
$(tail -n 1 results)
END
  sed -i '$d' results
  cat results.last >>results
  rm results.last
}

# apart WORLD OTHER: whether one map of both is refused.
apart() {
  refused=true
  "$bin/pole-map" build --quiet --config "street-$1.ini" --input "street-$1.rawlog" "street-$2.rawlog" \
    --output "apart-$1.polemap" >/dev/null 2>"apart-$1.txt" && refused=false
  grep -q "none of its places was found" "apart-$1.txt" || refused=false
  echo "{\"apart\": \"$1 $2\", \"refused\": $refused}" >>results
}

# Even and odd key frames of the kilometre as two drives, at once and one after the other.
two_halves() {
  for half in even:0:7 odd:1:8; do
    IFS=: read -r part offset seed <<END
$half
END
    # shellcheck disable=SC2086 # several words
    find_poles "$kilometre" "$part" "$top/config/kitti.ini" --every 2 --offset "$offset" --seed "$seed" $clockwise $biased
  done
  map kilometre-two "$top/config/kitti.ini" "even odd" "even odd" 0.025,0.03
  map kilometre-even "$top/config/kitti.ini" even even 0.025,0.03 --keep-scans
  map kilometre-added "$top/config/kitti.ini" odd odd 0.025,0.03 --add kilometre-even.polemap
}

for seed in 7 8 9 10 11; do
  real "vlp16-$seed" "$data/vlp16_loop" "$top/config/vlp16.ini" 0.015,0.03 "0 0 0 0 2.513 0.028" \
    "$clockwise $biased --seed $seed" --set sensor.height_m=1.77
done
real kitti_raw_0005 "$data/kitti_raw_0005" "$top/config/kitti.ini" 0.01,0.03 "0 0 0 0 0 0" "$clockwise $biased --seed 7"
for offset in -0.1 -0.05 -0.03 0.03 0.05 0.1; do
  real "vlp16-clock$offset" "$data/vlp16_loop" "$top/config/vlp16.ini" 0.015,0.03 "0 0 0 0 2.513 0.028" \
    "$clockwise $biased --seed 7" --set sensor.height_m=1.77 --set sensor.clock_offset_s=$offset
  real "kitti_raw_0005-clock$offset" "$data/kitti_raw_0005" "$top/config/kitti.ini" 0.01,0.03 "0 0 0 0 0 0" \
    "$clockwise $biased --seed 7" --set sensor.clock_offset_s=$offset
done
real vlp16-uncorrected "$data/vlp16_loop" "$top/config/vlp16.ini" 0.015,0.03 "0 0 0 0 2.513 0.028" \
  "--turn compensated $biased --seed 7" --set sensor.height_m=1.77
real kitti_raw_0005-uncorrected "$data/kitti_raw_0005" "$top/config/kitti.ini" 0.01,0.03 "0 0 0 0 0 0" \
  "--turn compensated $biased --seed 7"
nuscenes
alone vlp16 "$data/vlp16_loop" "$top/config/vlp16.ini" 0.015,0.03 "0 0 0 0 2.513 0.028" "$clockwise" \
  --set sensor.height_m=1.77
alone kitti_raw_0005 "$data/kitti_raw_0005" "$top/config/kitti.ini" 0.01,0.03 "0 0 0 0 0 0" "$clockwise"
for world in 630 631 632 633; do cast_street $world; done
if [ -n "$kilometre" ]; then
  alone kilometre "$kilometre" "$top/config/kitti.ini" 0.025,0.03 "0 0 0 0 0 0" "$clockwise"
  real kilometre "$kilometre" "$top/config/kitti.ini" 0.025,0.03 "0 0 0 0 0 0" "$clockwise $biased --seed 7"
  real kilometre-uncorrected "$kilometre" "$top/config/kitti.ini" 0.025,0.03 "0 0 0 0 0 0" \
    "--turn compensated $biased --seed 7"
  link_scans "$kilometre" "$out/laser" 1 228
  /usr/bin/python3 "$top/share/experiments/planar_odometry.py" "$data/kitti_odom_00_km/laser_odometry.txt" \
    laser/times.txt laser.tum
  real kilometre-laser laser "$top/config/kitti.ini" 0.025,0.03 "0 0 0 0 0 0" "$clockwise --odometry laser.tum"
  # As if x were to the left: half of a right angle to each quaternion.
  awk '{ h = sqrt(0.5); print $1, $2, $3, $4, $5, $6, h * ($7 + $8), h * ($8 - $7) }' OFMT=%.10f CONVFMT=%.10f laser.tum >turned.tum
  real kilometre-turned laser "$top/config/kitti.ini" 0.025,0.03 "0 0 0 0 0 0" "$clockwise --odometry turned.tum"
  two_halves
fi
if [ -n "$tracks" ]; then
  draw_drive "$out/kaist01" "$top/config/hdl32e.ini" 601 0 "world.track=$tracks/kaist01.txt.gz"
  map kaist01 kaist01.ini kaist01 kaist01 0,0
  gnss kaist01
  cast_kaist
fi
for world in $(seq 701 720); do
  draw_drive "$out/street-$world" "$top/config/hdl32e.ini" "$world" 0 world.length_m=600
  map "street-$world" "street-$world.ini" "street-$world" "street-$world" 0,0
done
for world in $(seq 701 704); do
  localized "$world"
  map "days-$world" "street-$world.ini" "street-$world again-$world" "street-$world again-$world" 0,0
  gnss "street-$world"
done
for world in $(seq 701 720); do apart "$world" $((world == 720 ? 701 : world + 1)); done

collect_results .
{
  table result.json '.[] | select(.drive) | [.drive, .loops, .length, .rms, .max, .local, .end_percent, .nees, .seconds,
    .timing]' drive loops "way m:1" "rms m:4" "max m:4" "local m:4" "end %:3" NEES:2 seconds timing
  jq -r '.[] | select(.localized) | "localized in \(.localized), \(.map): ok \(.ok), \(.local) m"' result.json
  jq -r '[.[] | select(.apart) | .refused] | "two streets, refused: \(map(select(.)) | length) of \(length)"' result.json
  jq -r '.[] | select(.truth) | "\(.truth): poses by the points on each side end \(.sides_apart_m) m and \(.sides_apart_deg) degrees apart"' result.json
  jq -r '.[] | select(.earth_rms) | "\(.drive) on Earth: \(.earth_rms) m, NEES \(.earth_nees)"' result.json
} | tee table.txt
