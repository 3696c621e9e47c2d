#!/bin/sh
# Says for each fault in mutations.txt whether the tests that it names notice it.
# Usage: tests/mutation/run.sh [NUMBER...]
#        tests/mutation/run.sh --drawn OUT
#   NUMBER   only these faults, counted from 1
#   --drawn  the faults in drawn.txt instead, which draw.py drew, with all unit tests: notice.py. OUT is a CSV
# All faults go into one copy of the sources (build-mutation/), each behind a switch, so that one build
# serves all of them; POLEMCL_FAULT=NUMBER switches one on. The test programs of build/ are linked with
# the objects that hold faults. Exits with 1 if a fault is not noticed; with --drawn, if fewer than 95 % are.
# Needs python3 and ninja.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
copy=$top/build-mutation
list=mutations.txt
out=
case ${1-} in
  -h | --help)
    sed -n '2,10s/^# //p' "$0"
    exit 0
    ;;
  --drawn)
    list=drawn.txt
    out=$(realpath -m "${2:?a name for the CSV is missing}")
    ;;
esac
export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"

faults=$(python3 -IS "$top/tests/mutation/insert.py" "$top" "$copy" "$top/tests/mutation/$list")
programs=$(echo "$faults" | cut -f 2 | sort -u | sed 's/^/test_/')
[ -z "$out" ] || programs='test_core test_io test_config test_mrpt test_sim test_report test_property test_apps'
{
  # shellcheck disable=SC2086 # several names
  cmake --build "$top/build" --target $programs polemcl-sensors
  cd "$copy"
  cmake --preset ci -DPOLEMCL_WERROR=OFF # of faults
} >"$copy/build.log" || {
  cat "$copy/build.log" >&2
  exit 1
}

# The objects that hold faults: of unity files, some of them of tests, or of a source that is compiled alone.
objects=$(cd "$copy/build" && echo "$faults" | cut -f 4 | sed 's/:.*//' | sort -u | while read -r source; do
  unity=$(grep -l "/$source\"" libpolemcl/src/*/CMakeFiles/*.dir/Unity/*.cxx tests/*/CMakeFiles/*.dir/Unity/*.cxx || :)
  if [ -n "$unity" ]; then
    echo "$unity" | sed 's/$/.o/'
  else
    ninja -t targets all | sed -n "s|:.*||; \\|${source##*/}\\.o$|p"
  fi
done | sort -u)
# shellcheck disable=SC2086 # several names
ninja -C "$copy/build" $objects >"$copy/build.log" || {
  cat "$copy/build.log" >&2
  exit 1
}
# Linked first, they take the place of the same objects in the libraries. Tests load the module of the sensors.
mkdir -p "$copy/build/bin" "$copy/build/lib"
first=$(echo "$objects" | sed "/polemcl-sensors/d; /\/test_/d; s|^|$copy/build/|" | tr '\n' ' ')
others=$(echo "$objects" | sed -n "/polemcl-sensors\|\/test_/s|.*|s# & # $copy/build/& #|p")
for file in $(echo "$programs" | sed 's|test_|bin/&|g'); do
  link=$(ninja -C "$top/build" -t commands "$file" | sed -n "\$s|-o $file|$first -o $copy/build/$file|; \$s/ && cd .*//p" | sed "$others")
  (cd "$top/build" && eval "$link")
done
module=lib/libpolemcl-sensors.so
link=$(ninja -C "$top/build" -t commands $module | sed -n "\$s|-o $module|-o $copy/build/$module|p" | sed "$others")
(cd "$top/build" && eval "$link")

cd "$copy/build/bin" # beside the settings that programs find by name
if [ -n "$out" ]; then
  echo "$faults" >faults.txt
  # shellcheck disable=SC2086 # several names
  exec python3 -B "$top/tests/mutation/notice.py" "$PWD" faults.txt "$out" ${programs}
fi
# passes NUMBER PROGRAM FILTER: whether the tests pass with this fault; 0 is none.
passes() {
  POLEMCL_FAULT=$1 timeout 300 "./test_$2" --gtest_brief=1 --gtest_fail_fast \
    --gtest_filter="$3" >run.log 2>&1
}

status=0
while IFS="$(printf '\t')" read -r number program filter place old new; do
  [ $# = 0 ] || echo " $* " | grep -q " $number " || continue
  passes 0 "$program" "$filter" || {
    echo "tests/mutation/run.sh: test_$program $filter fails without any fault:" >&2
    cat run.log >&2
    exit 1
  }
  grep -q 'PASSED.* [1-9]' run.log || {
    echo "tests/mutation/run.sh: test_$program has no tests $filter" >&2
    exit 1
  }
  if passes "$number" "$program" "$filter"; then
    said='NOT NOTICED' status=1
  else
    said=noticed
  fi
  echo "$number $said: $place: $old -> $new"
done <<END
$faults
END
exit $status
