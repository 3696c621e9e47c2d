# Functions of the tests of viewers, sourced after share/experiments/common.sh.
# shellcheck shell=sh disable=SC2034,SC2154

fail() {
  echo "Test of viewers: FAILED: $1" >&2
  exit 1
}

# skip_without "PACKAGES" PROGRAM...: ends the script, and says why, where a program is missing.
skip_without() {
  packages=$1
  shift
  for tool in "$@"; do
    if ! command -v "$tool" >/dev/null; then
      echo "Test of viewers: skipped, no $tool here (packages $packages)"
      exit 0
    fi
  done
}

# open_folder [PICTURES]: $folder is removed at the end, with the programs in $running; $pictures gets screenshots.
open_folder() {
  folder=$(mktemp -d)
  pictures=$folder
  if [ $# -gt 0 ]; then
    mkdir -p "$1"
    pictures=$(cd "$1" && pwd)
  fi
  running=
  trap finish EXIT
}
finish() {
  # shellcheck disable=SC2086 # several processes
  [ -z "$running" ] || kill $running 2>/dev/null || true
  rm -rf "$folder"
}

# open_display: an empty screen of 1280 x 860 with a window manager, drawn by software.
open_display() {
  HOME=$folder LIBGL_ALWAYS_SOFTWARE=1
  export HOME LIBGL_ALWAYS_SOFTWARE
  mkfifo "$folder/display"
  Xvfb -displayfd 3 -screen 0 1280x860x24 +extension GLX -nolisten tcp 3>"$folder/display" \
    2>"$folder/xvfb.log" &
  running="$running $!"
  read -r display <"$folder/display" || fail "no display: $(tail -n 1 "$folder/xvfb.log")"
  DISPLAY=:$display
  export DISPLAY
  openbox >/dev/null 2>&1 &
  running="$running $!"
  wait_for 60 xdotool get_num_desktops >/dev/null 2>&1 || fail "openbox does not start"
}

# wait_for SECONDS COMMAND...: repeats the command until it succeeds, no longer than that.
wait_for() {
  end=$(($(date +%s) + $1))
  shift
  while ! "$@"; do
    [ "$(date +%s)" -lt "$end" ] || return 1
    sleep 1
  done
}

# close PROCESS: ends a program that this script started.
close() {
  kill "$1" 2>/dev/null || true
  wait "$1" 2>/dev/null || true
}

# pixels_in PICTURE AREA COLOUR...: how many in the area, WIDTHxHEIGHT+X+Y or with per cents of the middle, have
# one of the colours. $fuzz is the tolerance, as a share; $gravity, the corner that the area is counted from.
pixels_in() {
  picture=$1
  area=$2
  shift 2
  total=0
  for colour in "$@"; do
    found=$(convert "$picture" -gravity "${gravity:-center}" -crop "$area" +repage -fuzz "$fuzz" \
      -transparent "$colour" -alpha extract -negate -format '%[fx:round(mean*w*h)]' info:)
    total=$((total + found))
  done
  echo "$total"
}
