#!/bin/sh
# Runs MRPT's programs, untouched, on a rawlog of poles, with the library as a plugin: rawlog-edit describes, cuts
# and filters it; rawlog-grabber records odometry; RawLogViewer lists the poles, draws them and shows their text;
# icp-slam and observations2map make a pole map of it, which SceneViewer3D shows.
# Usage: tests/viewers/mrpt-tools.sh [PICTURES]; skips, and says why, where a program is missing.
# Programs: build/bin, or POLEMCL_BIN. PICTURES: a folder that gets the screenshots.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=tests/viewers/display.sh
. "$top/tests/viewers/display.sh"
find_programs pole-simulate
skip_without "xvfb, openbox, mrpt-apps, imagemagick, xdotool, xclip" Xvfb openbox import convert xdotool \
  xclip rawlog-edit rawlog-grabber RawLogViewer icp-slam observations2map SceneViewer3D
library=$(cd "$bin/../lib" && pwd)/libpolemcl.so
[ -f "$library" ] || die "no $library: build first"
open_folder "$@"

# tool NAME OPTIONS...: a program of MRPT that has no option for plugins, in $folder.
tool() {
  (cd "$folder" && LD_PRELOAD=$library "$@" </dev/null >"$1.log" 2>&1) ||
    fail "$1: $(tail -n 3 "$folder/$1.log")"
}

# edit OPTIONS...: rawlog-edit with the plugin, in $folder.
edit() {
  (cd "$folder" && rawlog-edit -p "$library" "$@" </dev/null 2>&1) || fail "rawlog-edit $*"
}

# says TEXT FILE: whether a line of the file has the text.
says() {
  grep -a -q -F "$1" "$2"
}

draw_drive "$folder/drive" "$top/config/hdl32e.ini" 31 0 world.length_m=200
scans=$(grep -v -c '^#' "$folder/drive.tum")

# rawlog-edit
edit --info -i drive.rawlog >"$folder/info"
says "lidar /" "$folder/info" || fail "rawlog-edit --info does not know the label of the poles"
objects=$(sed -n 's/^Overall number of objects *: //p' "$folder/info")
[ "$objects" = $((2 * scans)) ] || fail "rawlog-edit --info counts $objects objects for $scans scans"
# poles_of RAWLOG: what rawlog-edit says about the poles of all scans.
poles_of() {
  edit --describe -i "$1" | sed -n '/^Poles: /,/^---/p'
}
poles_of drive.rawlog >"$folder/described"
edit --cut --to-index 39 -i drive.rawlog -o few.rawlog >/dev/null
poles_of few.rawlog >"$folder/few"
left=$(grep -c '^Poles: ' "$folder/few")
# Entries 0 to 39 are 20 pairs of motion and scan; MRPT counts one more or less.
{ [ "$left" -ge 19 ] && [ "$left" -le 21 ]; } || fail "rawlog-edit --cut leaves $left scans, not 20"
head -n "$(wc -l <"$folder/few")" "$folder/described" | cmp -s - "$folder/few" ||
  fail "rawlog-edit --cut changes poles"
edit --keep-label lidar -i few.rawlog -o kept.rawlog >/dev/null
poles_of kept.rawlog | cmp -s - "$folder/few" || fail "rawlog-edit --keep-label changes poles"
edit --remove-label lidar -i few.rawlog -o none.rawlog >/dev/null
# From MRPT 2.12 on it removes nothing from sensory frames (share/doc/mrpt.md).
if rawlog-edit --version | grep -q 'MRPT 2\.[0-9]\.'; then
  [ -z "$(poles_of none.rawlog)" ] || fail "rawlog-edit --remove-label leaves poles"
fi

# rawlog-grabber records odometry that comes from the network, until it gets a key. It says nothing when
# it is ready: packets go on until it has saved some.
sensors=$(find "$bin/.." -name libpolemcl-sensors.so | head -n 1)
cat >"$folder/grab.ini" <<END
[global]
rawlog_prefix = $folder/grabbed
time_between_launches = 300
SF_max_time_span = 0.25
use_sensoryframes = 0
GRABBER_PERIOD_MS = 100
[odometry]
driver = CUdpOdometry
sensorLabel = wheels
process_rate = 100
udp_port = 9871
END
python3 - <<'END' &
import socket, time
sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for i in range(1200):
    sender.sendto(b"%d 2 0.5 %.3f" % (i, time.time() - 1), ("127.0.0.1", 9871))
    time.sleep(0.05)
END
running=$!
mkfifo "$folder/keys"
rawlog-grabber -p "$sensors" "$folder/grab.ini" <"$folder/keys" >"$folder/grab.log" 2>&1 &
grabber=$!
running="$running $grabber"
exec 4>"$folder/keys"
wait_for 60 says "Saved 2 objects" "$folder/grab.log" || fail "rawlog-grabber: $(tail -n 3 "$folder/grab.log")"
echo >&4
wait "$grabber" || fail "rawlog-grabber: $(tail -n 3 "$folder/grab.log")"
exec 4>&-
(cd "$folder" && rawlog-edit --info -i grabbed*.rawlog >info)
says "wheels" "$folder/info" || fail "rawlog-grabber records no odometry of CUdpOdometry"

open_display

# text_at X Y: clicks there, and prints the text of the observation that RawLogViewer then shows.
text_at() {
  xdotool mousemove --window "$window" "$1" "$2" click 1
  sleep 1
  xdotool mousemove --window "$window" 700 300 click 1 key ctrl+a
  sleep 1
  timeout 5 xclip -o -selection primary 2>/dev/null || true
}

# find_window NAME: sets $window when it is there.
find_window() {
  window=$(xdotool search --onlyvisible --name "$1" 2>/dev/null | head -n 1)
  [ -n "$window" ]
}

# red PICTURE: pixels of poles in the lower right part, where RawLogViewer draws.
red() {
  fuzz=15%
  pixels_in "$1" 860x240+410+450 '#c02200' '#8f1900'
}

# view RAWLOG PICTURE OPTIONS...: opens it in RawLogViewer, closes the tip of the day, and clicks down the list
# until the text of an observation of poles appears, which goes to $folder/text.
view() {
  rawlog=$1
  picture=$2
  shift 2
  RawLogViewer "$@" "$folder/$rawlog" >"$folder/viewer.log" 2>&1 &
  viewer=$!
  running="$running $viewer"
  wait_for 60 find_window 'Tip of the Day' || fail "RawLogViewer does not start"
  xdotool windowactivate --sync "$window" key Escape
  wait_for 10 find_window '^RawlogViewer' || fail "RawLogViewer has no window"
  found=no
  for row in 92 109 126 143 160 177 194 92 109 126 143 160 177 194; do # twice: a busy machine is slow
    text_at 190 "$row" >"$folder/text"
    says polemcl::CObservationPoles "$folder/text" && found=yes && break
  done
  import -window root "$picture"
  close "$viewer"
  [ $found = yes ]
}

gravity=NorthWest
view few.rawlog "$pictures/rawlogviewer.png" -l "$library" ||
  fail "RawLogViewer -l shows no text of poles"
# The text of the first scan is that of rawlog-edit, pole for pole.
sed '/^---/,$d;/^$/d' "$folder/few" >"$folder/first"
grep -v -x -F -f "$folder/text" "$folder/first" >"$folder/missing" || true
{ [ -s "$folder/first" ] && [ ! -s "$folder/missing" ]; } || fail "RawLogViewer -l does not show: $(cat "$folder/missing")"
[ "$(red "$pictures/rawlogviewer.png")" -gt 300 ] || fail "RawLogViewer -l draws no poles"
# Without the plugin it shows neither: this test sees something.
if view few.rawlog "$pictures/rawlogviewer_without.png"; then
  fail "RawLogViewer knows poles without the plugin: this test sees nothing"
fi
[ "$(red "$pictures/rawlogviewer_without.png")" -lt 20 ] ||
  fail "red without the plugin: this test sees nothing"

# Key frames along the odometry, from icp-slam; a pole map of them, from observations2map.
copy_settings "$top/config/mrpt/icp-slam.ini" "$folder/icp-slam.ini"
tool icp-slam icp-slam.ini
cp "$folder/icp-slam/_finalmap_.simplemap" "$folder/drive.simplemap"
tool observations2map "$top/config/mrpt/observations2map.ini" drive.simplemap map -s Map
made=$(grep -c -v '^#' "$folder/map_polemcl__CPoleMap_00.csv")
[ "$made" -gt 20 ] || fail "observations2map makes a map of $made poles"

# map_is_shown: steps back with the wheel of the mouse, as the map is in metres; takes a picture of the screen,
# and says whether there are poles in it.
map_is_shown() {
  xdotool mousemove 640 450 click --repeat 2 5 2>/dev/null || return 1
  sleep 1
  import -window root "$pictures/observations2map.png" 2>/dev/null || return 1
  fuzz=9%
  gravity=center
  [ "$(pixels_in "$pictures/observations2map.png" 60%x60%+0+0 '#46039f' '#9c179e' '#d8456c' '#ed7933' \
    '#f5b700')" -gt 300 ]
}
SceneViewer3D "$folder/map_polemcl__CPoleMap_00.3Dscene" >"$folder/viewer.log" 2>&1 &
viewer=$!
running="$running $viewer"
wait_for 60 map_is_shown || fail "SceneViewer3D does not show the map of observations2map"
close "$viewer"
echo "Test of viewers: passed; rawlog-edit, RawLogViewer, icp-slam and observations2map work on poles"
