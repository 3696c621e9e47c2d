# Sourced by the scripts here and by the demo: where the programs are, and small helpers.
# shellcheck shell=sh

# The folder with the programs: POLEMCL_BIN, else build/bin of the checkout ($top).
find_programs() {
  bin=${POLEMCL_BIN:-$top/build/bin}
  for program in "$@"; do
    [ -x "$bin/$program" ] || {
      echo "$(basename "$0"): no program $bin/$program; build first (share/setup/build.sh release" \
        "programs) or name the folder in POLEMCL_BIN" >&2
      exit 1
    }
  done
}

# set_option FILE SECTION KEY VALUE: changes the value in an INI file, or adds it.
set_option() {
  awk -v section="[$2]" -v key="$3" -v value="$4" '
    function add() { if (inside && !done) { print key " = " value; done = 1 } }
    /^[ \t]*\[/ { add(); inside = index($0, section) > 0 }
    inside && $0 ~ "^[ \t]*" key "[ \t]*=" { print key " = " value; done = 1; next }
    { print }
    END { add(); if (!done) { print section; print key " = " value } }
  ' "$1" >"$1.new"
  mv "$1.new" "$1"
}

# json_value FILE KEY: the number under a key of a flat JSON object.
json_value() {
  sed -n "s/.*\"$2\"[ ]*:[ ]*\\([-+.0-9eE]*\\).*/\\1/p" "$1" | head -n 1
}
