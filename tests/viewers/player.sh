#!/bin/sh
# Steers the window of pole-localize --live by its keys: pause, steps, times, degraded scans, help. The window's
# title tells what it shows. In the end the results are those of a run without a window, byte for byte.
# Usage: tests/viewers/player.sh [PICTURES]; skips, and says why, where a program is missing.
# Programs: build/bin, or POLEMCL_BIN. PICTURES: a folder that gets the screenshots.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=tests/viewers/display.sh
. "$top/tests/viewers/display.sh"
find_programs pole-simulate pole-map pole-localize
skip_without "xvfb, openbox, imagemagick, xdotool" Xvfb openbox import convert xdotool
open_folder "$@"

for day in 0 1; do
  draw_drive "$folder/day$day" "$top/config/hdl32e.ini" 31 $day world.length_m=400
done
"$bin/pole-map" build --quiet --config "$folder/day0.ini" --input "$folder/day0.rawlog" \
  --truth "$folder/day0.tum" --output "$folder/map.polemap" >/dev/null

# localize OUTPUT OPTIONS...: the second day, without a start pose.
localize() {
  output=$1
  shift
  "$bin/pole-localize" --quiet --config "$folder/day1.ini" --input "$folder/day1.rawlog" --global \
    --map "$folder/map.polemap" --truth "$folder/day1.tum" --output "$folder/$output" "$@"
}
localize alone
last=$(($(wc -l <"$folder/alone/run_00_health.csv") - 2))

open_display
localize watched --live >"$folder/player.log" 2>&1 &
player=$!
running="$running $player"

# title: that of the window.
title() {
  xdotool search --onlyvisible --name '^pole-localize' getwindowname 2>/dev/null
}
# shows PATTERN: whether the title says so.
shows() {
  title | grep -q "$1"
}
# press PATTERN KEYS...: presses them one after the other, and waits until the title says so.
press() {
  pattern=$1
  shift
  xdotool search --onlyvisible --name '^pole-localize' windowactivate --sync
  xdotool key --delay 100 "$@"
  wait_for 60 shows "$pattern" ||
    fail "after the keys $* the title is $(title), not $pattern: $(cat "$folder/player.log")"
}
# scan: the one in the title.
scan() {
  title | sed 's/.*scan \([0-9]*\) of.*/\1/'
}

wait_for 60 shows pole-localize || fail "no window: $(cat "$folder/player.log")"
press 'paused$' space
at=$(scan)
press "scan $((at + 2)) of .* s, paused$" Right Right
press "scan $((at - 1)) of .* s, paused$" Left Left Left
press ', 15\.[0-9] s, paused$' 1 5 Return
at=$(scan)
import -window root "$pictures/player.png"
press ', 5\.[0-9] s, paused$' Down
press "scan $at of" Up
press 'scan 0 of' Home

# To the first scan of each stretch that is not ok, as the file says.
starts=$(awk -F, 'NR > 1 { if ($3 != "ok" && $3 != before && NR > 2) print $1; before = $3 }' \
  "$folder/alone/run_00_health.csv")
[ -n "$starts" ] || fail "the whole drive is ok: this test sees nothing"
for start in $starts; do
  press "scan $start of .* s, paused$" n
done

# The help has its light background where the street was.
fuzz=1%
gravity=NorthEast
help_is_shown() {
  import -window root "$pictures/player_help.png"
  [ "$(pixels_in "$pictures/player_help.png" 500x560+10+140 '#f7f9fa')" -gt 50000 ]
}
if help_is_shown; then fail "there is help before its key: this test sees nothing"; fi
press 'paused$' h
wait_for 30 help_is_shown || fail "the key h shows no help"

press "scan $last of $last, .* s, paused$" 9 9 9 9 Return
press "scan $((last - 1)) of" Left
xdotool key --delay 100 space
wait "$player" || fail "$(cat "$folder/player.log")"
for file in "$folder"/alone/run_00* "$folder"/alone/summary.json; do
  cmp -s "$file" "$folder/watched/${file##*/}" || fail "${file##*/} differs from that without a window"
done
echo "Test of viewers: passed; pole-localize --live can be steered, and changes no result"
