#!/bin/sh
# Makes the pictures of share/doc/how-it-works.md. A simulated OS1-64 is cast in a short street: one scan, from
# above and as a range image. The other pictures show a street of 800 m whose poles are drawn from the model of an
# HDL-32E. Five months later it is localized without a start pose, with a detour through a street that is not on
# the map. The changes of a year are those of its first 400 m.
# Usage: share/figures/how-it-works.sh [FOLDER]      share/figures unless given
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 0 1 "$@"
find_programs pole-simulate pole-import pole-extract pole-map pole-localize
find_tools python3 convert
pictures=$(cd "${1:-$top/share/figures}" && pwd)

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

"$bin/pole-simulate" --quiet --config "$top/config/mulran.ini" --sensor os1_64 --seed 7 --length 40 \
  --output "$out/street"
"$bin/pole-import" folder --quiet --input "$out/street" --output "$out/street.rawlog"
"$bin/pole-extract" --quiet --config "$top/config/mulran.ini" --input "$out/street.rawlog" \
  --output "$out/poles.rawlog" --png "$out/scan.png" --png-scan 20
convert "$out/scan.png" +dither -colors 250 "PNG8:$pictures/scan.png" # a third of the size
"$bin/pole-extract" --quiet --config "$top/config/paper/mulran.ini" --input "$out/street.rawlog" \
  --output "$out/poles.rawlog" --range-image "$pictures/range-image.png" --png-scan 20

# street NAME DAY LENGTH [SECTION.KEY=VALUE...]: a drive on that day of the same street, and its map.
street() {
  name=$1 day=$2 length=$3
  shift 3
  draw_drive "$out/$name" "$top/config/hdl32e.ini" 500 "$day" "world.length_m=$length" world.side_streets=1 \
    world.removed_share=0 world.added_share=0 world.replaced_per_year=0.4 world.day_of_year=135 \
    "simulation.drive_seed=$day" "$@"
  map_drive "$out/$name" "$out/$name.polemap"
}
street may 0 800
street october 152 800 simulation.detour=1
localize_drive "$out/october" "$out/may.polemap" "$out/run" --seed 1 --global --frames "$out/frames" --frame-every 10
cp "$out/frames/000010.png" "$pictures/particles.png"
python3 "$top/share/figures/plots.py" health "$out/run/run_00_health.csv" "$pictures/health.svg"
python3 "$top/share/figures/plots.py" year "$top/share/reports/year.json" "$pictures/year.svg"

street first_may 0 400
street next_may 365 400
"$bin/pole-map" diff --quiet "$out/first_may.polemap" "$out/next_may.polemap" --png "$pictures/changes.png" >/dev/null
