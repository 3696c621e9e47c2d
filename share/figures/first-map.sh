#!/bin/sh
# Makes first-map.png: the map of a simulated drive round two blocks, twice along the street between them and a third
# time to its end, from odometry and poles alone. Poles are drawn from the model of an HDL-32E, world 801, the first
# that was tried.
# Usage: share/figures/first-map.sh [PICTURES]
#   PICTURES  folder of the picture, share/figures unless given
# Needs ImageMagick.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 0 1 "$@"
find_programs pole-simulate pole-map
find_tools convert
pictures=$(cd "${1:-$top/share/figures}" && pwd)

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
awk '
  function pose() { printf "%.6f %.6f 0 %.3f %.6f %.6f 0 %.3f 0 0 1 0\n", cos(yaw), -sin(yaw), x, sin(yaw), cos(yaw), y }
  function go(metres, turn, i) {
    for (i = 0; i < metres; i++) { pose(); x += cos(yaw); y += sin(yaw) }
    for (i = 0; i < 20; i++) { pose(); yaw += turn * atan2(0, -1) / 80; x += cos(yaw); y += sin(yaw); yaw += turn * atan2(0, -1) / 80 }
  }
  function block(turn) { go(240, turn); go(140, turn); go(240, turn); go(140, turn) }
  BEGIN { block(1); block(-1); go(240, 1) }' >"$out/track.txt"
draw_drive "$out/drive" "$top/config/hdl32e.ini" 801 0 world.track="$out/track.txt"
"$bin/pole-map" build --quiet --config "$out/drive.ini" --input "$out/drive.rawlog" --output "$out/street.polemap" \
  --png "$out/map.png"
convert "$out/map.png" -resize 1000x +dither -colors 64 "$pictures/first-map.png"
