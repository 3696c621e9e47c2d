#!/bin/sh
# Makes the animation of the live view, share/figures/live.gif, as pole-localize --live shows it. The street is
# 400 m long and localized on another day, without a start pose; the poles are drawn from the detection model.
# Usage: share/figures/live.sh [GIF]     Needs ImageMagick.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 0 1 "$@"
find_programs pole-simulate pole-map pole-localize
find_tools convert

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for day in 0 1; do
  draw_drive "$out/day$day" "$top/config/hdl32e.ini" 7 $day world.length_m=400 simulation.spacing_m=1
done
map_drive "$out/day0" "$out/map.polemap"
"$bin/pole-localize" --quiet --config "$out/day1.ini" --input "$out/day1.rawlog" --global \
  --map "$out/map.polemap" --output "$out/run" --seed 1 --frames "$out/frames" >/dev/null

# The search, slowly, then every fourth scan.
set -- "${1:-$top/share/figures/live.gif}" "$out"/frames/00000[0234].png -delay 20
for scan in $(seq -f %06.0f 6 4 62); do
  set -- "$@" "$out/frames/$scan.png"
done
gif=$1
shift
convert -delay 70 "$@" -resize 640x +dither -colors 64 -layers OptimizePlus -loop 0 "$gif"
