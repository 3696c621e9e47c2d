#!/bin/sh
# Makes the picture of the live view, share/figures/live.png, as pole-localize --live shows it. The street is
# 400 m long and localized on another day; the poles are drawn from the detection model.
# Usage: share/figures/live.sh [PICTURE]
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 0 1 "$@"
find_programs pole-simulate pole-map pole-localize

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for day in 0 1; do
  draw_drive "$out/day$day" "$top/config/hdl32e.ini" 7 $day world.length_m=400 simulation.spacing_m=1
done
"$bin/pole-map" build --quiet --config "$out/day0.ini" --input "$out/day0.rawlog" \
  --truth "$out/day0.tum" --output "$out/map.polemap" >/dev/null
"$bin/pole-localize" --quiet --config "$out/day1.ini" --input "$out/day1.rawlog" \
  --map "$out/map.polemap" --truth "$out/day1.tum" --output "$out/run" --seed 1 \
  --frames "$out/frames" --frame-every 20
cp "$out/frames/000080.png" "${1:-$top/share/figures/live.png}"
