#!/bin/sh
# Opens each kind of .3Dscene in MRPT's SceneViewer3D, untouched, and looks at the picture: poles and
# paths in the middle of the window, in the map's frame and at UTM coordinates. Then mrpt-tools.sh: the others;
# player.sh: the window of pole-localize.
# Usage: tests/viewers/run.sh [PICTURES]; skips, and says why, where a program is missing.
# Programs: build/bin, or POLEMCL_BIN. PICTURES: a folder that gets the screenshots.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=tests/viewers/display.sh
. "$top/tests/viewers/display.sh"
find_programs pole-simulate pole-map pole-localize pole-eval
skip_without "xvfb, openbox, mrpt-apps, imagemagick" Xvfb openbox SceneViewer3D import convert
open_folder "$@"

# drive NAME DAY X Y: a day of the street, moved by X, Y: NAME.rawlog, NAME.tum.
drive() {
  "$bin/pole-simulate" --quiet --config "$folder/street.ini" --day "$2" \
    --poles "$folder/$1.rawlog"
  awk -v x="$3" -v y="$4" '/^#/ { print; next }
    { $2 = sprintf("%.6f", $2 + x); $3 = sprintf("%.6f", $3 + y); print }' \
    "$folder/$1.tum" >"$folder/moved"
  mv "$folder/moved" "$folder/$1.tum"
}

# scenes NAME X Y: NAME_map, NAME_diff, NAME_trajectory and NAME_live.3Dscene of a street of 1.5 km.
scenes() {
  at=$folder/$1
  drive "${1}_first" 0 "$2" "$3"
  drive "${1}_second" 1 "$2" "$3"
  for day in first second; do
    "$bin/pole-map" build --quiet --config "$folder/street.ini" --input "${at}_$day.rawlog" \
      --truth "${at}_$day.tum" --output "${at}_$day.polemap" --scene "${at}_map.3Dscene" >/dev/null
  done
  "$bin/pole-map" diff --quiet "${at}_first.polemap" "${at}_second.polemap" \
    --scene "${at}_diff.3Dscene" >/dev/null
  "$bin/pole-localize" --quiet --config "$folder/street.ini" --input "${at}_second.rawlog" \
    --map "${at}_first.polemap" --truth "${at}_second.tum" --output "${at}_runs" --scenes 200
  "$bin/pole-eval" trajectory --quiet --truth "${at}_second.tum" --map "${at}_first.polemap" \
    --estimate "${at}_runs/run_00.tum" --scene "${at}_trajectory.3Dscene" >/dev/null
  mv "${at}_runs/run_00_scenes/000400.3Dscene" "${at}_live.3Dscene"
}

# pixels PICTURE COLOUR...: how many in the middle of the window, where no legend is, have one.
pixels() {
  picture=$1
  shift
  pixels_in "$picture" 60%x60%+0+0 "$@"
}

fuzz=9% # of a colour: cylinders are darker on one side
counts="#46039f #9c179e #d8456c #ed7933 #f5b700"
estimate="#0072b2"
truth="#404854"
same="#9aa2ad"
matched="#009e63"
mapped="#8a939f"
# shows PICTURE KIND: whether it has what such a scene is about, in pixels of 640 x 480.
shows() {
  # shellcheck disable=SC2086 # several colours
  case $2 in
    map) [ "$(pixels "$1" $counts)" -gt 500 ] && [ "$(pixels "$1" $truth)" -gt 1000 ] ;;
    trajectory)
      [ "$(pixels "$1" $counts)" -gt 500 ] && [ "$(pixels "$1" $estimate)" -gt 1000 ] &&
        [ "$(pixels "$1" $truth)" -gt 300 ]
      ;;
    diff) [ "$(pixels "$1" $same)" -gt 500 ] ;;
    live)
      [ "$(pixels "$1" $estimate)" -gt 300 ] && [ "$(pixels "$1" $matched)" -gt 50 ] &&
        [ "$(pixels "$1" $mapped)" -gt 50 ]
      ;;
  esac
}

# pictured PICTURE KIND: takes the picture, and says whether it shows that.
pictured() {
  import -window root "$1" 2>/dev/null && shows "$1" "$2"
}

# look SCENE KIND SECONDS PICTURE: opens it and waits until it shows what it should, no longer than that.
look() {
  SceneViewer3D "$1" >"$folder/viewer.log" 2>&1 &
  viewer=$!
  running="$running $viewer"
  seen=yes
  wait_for "$3" pictured "$4" "$2" || seen=no
  close "$viewer"
  [ $seen = yes ]
}

{
  cat "$top/config/hdl32e.ini"
  printf '\n[world]\nseed = 31\nlength_m = 1500\n[simulation]\nspacing_m = 1\ndetections = %s\n' \
    "$top/share/models/hdl32e.json"
} >"$folder/street.ini"
scenes local 0 0
scenes utm 448000 5417000

open_display

for place in local utm; do
  for kind in map trajectory diff live; do
    look "$folder/${place}_$kind.3Dscene" "$kind" 60 "$pictures/${place}_$kind.png" ||
      fail "SceneViewer3D does not show what ${place}_$kind.3Dscene is about"
  done
done
# Half a file: the viewer shows its own grid.
head -c 300 "$folder/local_map.3Dscene" >"$folder/broken.3Dscene"
if look "$folder/broken.3Dscene" map 10 "$pictures/broken.png"; then
  fail "a broken scene passes: this test sees nothing"
fi
echo "Test of viewers: passed; SceneViewer3D shows maps, trajectories, changes and live scenes"
"$top/tests/viewers/mrpt-tools.sh" "$@"
"$top/tests/viewers/player.sh" "$@"
