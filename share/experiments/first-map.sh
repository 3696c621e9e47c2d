#!/bin/sh
# A first map without true poses: that of a short drive whose odometry is taken for the truth. Two days of a simulated
# street are cast (demo.ini, world 3), with the odometry of wheels, 1 % too long and 0.01 deg/m off. The map comes
# from the odometry of the first day, and for comparison from its true poses; the second day is localized in both.
# Usage: share/experiments/first-map.sh OUT [LENGTH]     LENGTH of the street, m; 200 unless given
# Prints, and writes to OUT/table.txt: poles of the map; share of the scans that are ok; mean and greatest error
# against the true poses.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 2 "$@"
find_programs pole-simulate pole-import pole-map pole-localize
mkdir -p "$1"
cd "$1"

for day in 0 1; do
  # shellcheck disable=SC2086 # several words
  copy_settings "$top/config/demo.ini" "day$day.ini" $wheels world.seed=3 "world.day=$day" "world.length_m=${2-200}"
  "$bin/pole-simulate" --quiet --config "day$day.ini" --output "scans$day"
  "$bin/pole-import" folder --quiet --input "scans$day" --output "day$day.rawlog"
done

# The first true pose, and the motions after it one behind the other; headings in degrees do not occur.
awk '
  function pose(time) { printf "%s %.9f %.9f 0 0 0 %.9f %.9f\n", time, x, y, sin(yaw / 2), cos(yaw / 2) }
  /^#/ { next }
  NR == FNR { time[++n] = $1; if (n == 1) { x = $2; y = $3; yaw = 2 * atan2($7, $8); pose($1) } next }
  { x += $1 * cos(yaw) - $2 * sin(yaw); y += $1 * sin(yaw) + $2 * cos(yaw); yaw += $3; pose(time[++m + 1]) }
' day0.tum scans0/odometry.txt >odometry.tum

printf '%-10s %6s %6s %8s %8s\n' map poles ok mean max >table.txt
for truth in odometry day0; do
  "$bin/pole-map" build --quiet --config day0.ini --input day0.rawlog --truth $truth.tum --output $truth.polemap \
    --csv $truth.csv >/dev/null
  "$bin/pole-localize" --quiet --config day1.ini --input day1.rawlog --map $truth.polemap --truth day1.tum \
    --output $truth >/dev/null
  awk -F, -v name=$truth -v poles="$(($(wc -l <$truth.csv) - 1))" '
    FNR == 1 { next }
    FILENAME ~ /health/ { scans++; ok += $3 == "ok"; next }
    { sum += $3; n++; if ($3 > most) most = $3 }
    END { printf "%-10s %6d %5.1f%% %8.3f %8.3f\n", name, poles, 100 * ok / scans, sum / n, most }
  ' $truth/run_00_health.csv $truth/run_00_errors.csv >>table.txt
done
cat table.txt
