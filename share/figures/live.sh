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
cp "$top/config/hdl32e.ini" "$out/street.ini"
set_option "$out/street.ini" world seed 7
set_option "$out/street.ini" world length_m 400
set_option "$out/street.ini" simulation spacing_m 1
set_option "$out/street.ini" simulation detections "$top/share/models/hdl32e.json"
for day in 0 1; do
  "$bin/pole-simulate" --quiet --config "$out/street.ini" --day $day --poles "$out/day$day.rawlog"
done
"$bin/pole-map" build --quiet --config "$out/street.ini" --input "$out/day0.rawlog" \
  --truth "$out/day0.tum" --output "$out/map.polemap" >/dev/null
"$bin/pole-localize" --quiet --config "$out/street.ini" --input "$out/day1.rawlog" \
  --map "$out/map.polemap" --truth "$out/day1.tum" --output "$out/run" --seed 1 \
  --frames "$out/frames" --frame-every 20
cp "$out/frames/000080.png" "${1:-$top/share/figures/live.png}"
