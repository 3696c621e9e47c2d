#!/bin/sh
# Installs into a folder of its own, builds the examples against that and checks what they print.
# Also: programs and the Python module find settings, models and the window from where they are
# installed; there are man pages; the libraries export the project's own symbols only; the examples of
# --help run in the sample.
# Usage: tests/install/run.sh [BUILD]
#   BUILD  folder of a complete build, build/ unless given
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
build=$(cd "${1-$top/build}" && pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
prefix=$dir/prefix

fail() {
  echo "tests/install/run.sh: $1" >&2
  exit 1
}

# quietly COMMAND...: shows what it prints only when it fails.
quietly() {
  "$@" >"$dir/log" 2>&1 || {
    cat "$dir/log" >&2
    fail "this failed: $*"
  }
}

# example NAME OPTION...: builds an example against the installed tree.
example() {
  name=$1
  shift
  quietly cmake -S "$top/share/examples/$name" -B "$dir/$name" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF "$@"
  quietly cmake --build "$dir/$name"
}

quietly cmake --install "$build" --prefix "$prefix"
lib=$(find "$prefix" -name libpolemcl.so -exec dirname {} \;)
[ -n "$lib" ] || fail "libpolemcl.so was not installed"
bin=$prefix/bin

echo "1/9 Headers and symbols"
headers=$(find "$prefix/include/polemcl" -mindepth 2 -name '*.h' | wc -l)
if [ "$headers" -lt 12 ] || [ "$headers" -gt 18 ]; then
  fail "$headers public headers; 12 to 18 in the rooms were meant"
fi
grep -rhoE '#include "[^"]*"' "$prefix/include" && fail "a public header includes a private one"
own=$(nm -DC --defined-only "$lib/libpolemcl.so" | grep -c 'polemcl::' || :)
foreign=$(nm -DC --defined-only "$lib/libpolemcl.so" | cut -d' ' -f3- |
  grep -cvE '^((typeinfo|typeinfo name|vtable|VTT) for |(non-virtual|virtual) thunk to )?polemcl::' || :)
[ "$own" -ge 100 ] || fail "libpolemcl.so exports $own symbols of polemcl; at least 100 were meant"
[ "$foreign" -eq 0 ] || fail "libpolemcl.so exports $foreign symbols of other libraries"

echo "2/9 Installed programs, with installed settings, models and batches by their names"
cd "$dir"
quietly "$bin/pole-simulate" --quiet --config demo.ini --length 60 --output scans
quietly "$bin/pole-simulate" --quiet --config hdl32e.ini --length 60 --poles poles.rawlog \
  --set simulation.detections=hdl32e.json
[ -s poles.rawlog ] || fail "no poles were simulated by the installed model"
# The names of a source tree are found as well; a batch by its name, with what it names.
quietly "$bin/pole-simulate" --quiet --config config/demo.ini --length 20 --output named
quietly "$bin/pole-batch" batches/year.ini --quiet --output year --set batch.settings=never --set batch.runs=1 \
  --set 'sessions.names=may june' --set 'sessions.set=simulation.detections=hdl32e.json world.length_m=120'
[ -s year/report.html ] || fail "the installed batch left no report"
mkdir -p nclt/2012-01-08 nclt/2012-01-15
quietly "$bin/pole-batch" config/batches/nclt.ini --data nclt --dry-run --set 'sessions.names=2012-01-08 2012-01-15'
if "$bin/pole-simulate" --quiet --config nobody.ini --output none 2>error.txt; then
  fail "settings that do not exist were read"
fi
grep -q '^pole-simulate: .*nobody\.ini' error.txt || fail "the message does not name the file: $(cat error.txt)"

# All programs are one file.
[ "$(find "$bin" -type f)" = "$bin/polemcl" ] || fail "more than one program was installed: $(ls "$bin")"
if "$bin/polemcl" 2>error.txt; then fail "polemcl ran without the name of a program"; fi
grep -q '^polemcl: .* pole-map pole-localize' error.txt || fail "polemcl does not name the programs: $(cat error.txt)"

# Each subcommand has its page; mandoc has nothing to say of any.
pages=$prefix/share/man/man1
[ "$(find "$pages" -name 'pole-*.1' | wc -l)" -gt 25 ] || fail "there are few man pages; is help2man installed?"
quietly mandoc -Tlint -W warning "$pages"/pole-*.1
mandoc -Tascii "$pages/pole-map-build.1" | sed 's/.\x08//g' >page.txt
for text in 'pole-map-build - Builds a map' '--keep-scans' '\$ pole-map build --config' NO_COLOR 'pole-localize(1)'; do
  grep -q -e "$text" page.txt || fail "the man page of pole-map build lacks '$text'"
done
[ -s "$prefix/share/bash-completion/completions/pole-map" ] || fail "completion was not installed"

echo "3/9 extract: poles of one scan, without MRPT"
example extract -DCMAKE_DISABLE_FIND_PACKAGE_mrpt-obs=ON -DCMAKE_DISABLE_FIND_PACKAGE_mrpt-maps=ON
! ldd extract/extract | grep -q mrpt || fail "the example of polemcl::core links MRPT"
extract/extract scans/velodyne/000040.bin >extracted.txt
awk 'NF != 3 || $3 <= 0 || $3 > 0.5 { exit 1 } END { if (NR < 3) exit 1 }' extracted.txt ||
  fail "extract did not print three poles or more: $(cat extracted.txt)"

echo "4/9 map: scans at known poses to a map"
example map
map/map scans street.polemap >mapped.txt
"$bin/pole-eval" map --quiet --one-to-one --truth scans/poles_gt.csv --map street.polemap \
  --json score.json >/dev/null
jq -e '.precision > 0.7 and .recall > 0.4' score.json >/dev/null ||
  fail "the map of the example is poor: $(cat mapped.txt score.json)"

echo "5/9 localize: points to poses"
example localize
# The true poses as x, y; the start is 0.5 m off.
awk '{ print $4, $8, atan2($5, $1) }' scans/poses.txt >true.txt
read -r x y yaw <true.txt
localize/localize scans street.polemap "$(awk "BEGIN { print $x + 0.3 }")" "$(awk "BEGIN { print $y - 0.4 }")" \
  "$yaw" >poses.txt
[ "$(wc -l <poses.txt)" = "$(wc -l <true.txt)" ] || fail "not every scan got a pose"
paste -d' ' poses.txt true.txt | tail -n 40 |
  awk '{ e = sqrt(($2 - $5) ^ 2 + ($3 - $6) ^ 2); if (e > most) most = e }
       END { if (!(NR == 40 && most < 0.3)) { print most; exit 1 } }' ||
  fail "the poses of the example are more than 0.3 m off"
if localize/localize scans missing.polemap 0 0 0 2>error.txt; then fail "a missing map was read"; fi
grep -q '^localize: .*missing\.polemap' error.txt ||
  fail "polemcl::Error was not caught outside the library: $(cat error.txt)"

echo "6/9 rawlog: a rawlog of poles to poses, those of pole-localize"
example rawlog
start=$(awk "BEGIN { print $x + 0.3, $y - 0.4, $yaw * 57.29577951308232 }" | tr ' ' ',')
quietly "$bin/pole-localize" --quiet --config demo.ini --input poles.rawlog --map street.polemap --output run \
  --start "$start,1,5" --seed 7
rawlog/rawlog poles.rawlog street.polemap run/config.ini >same.txt
cut -d' ' -f1-3 run/run_00.tum | grep -v '^#' >tum.txt
cut -d' ' -f1-3 same.txt | cmp -s - tum.txt || fail "the poses of the example are not those of pole-localize"
[ "$(wc -l <tum.txt)" -ge 40 ] || fail "pole-localize gave few poses"
[ "$(awk '$6 == "ok"' same.txt | wc -l)" -gt 20 ] || fail "the poses of the example are not ok: $(cat same.txt)"
# The program of the README, as it stands.
mkdir readme
sed 's/rawlog/readme/g' "$top/share/examples/rawlog/CMakeLists.txt" >readme/CMakeLists.txt
awk '/^```/ { on = /cpp$/; next } on' "$top/README.md" >readme/readme.cpp
quietly cmake -S readme -B readme/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
quietly cmake --build readme/build
cp poles.rawlog another_day.rawlog
cp street.polemap map.polemap
readme/build/readme >readme.txt
[ "$(wc -l <readme.txt)" -gt 20 ] || fail "the program of the README gave $(wc -l <readme.txt) poses"
# Installed settings by their name, with sections of other programs; what they lack is a start.
if rawlog/rawlog poles.rawlog street.polemap demo.ini 2>error.txt; then fail "it started without a pose"; fi
grep -q '^rawlog: the localizer has not been started' error.txt || fail "demo.ini was refused: $(cat error.txt)"

echo "7/9 mrpt: MRPT's filter on a pole map, known by name, with a linker that drops unused libraries"
example mrpt -DCMAKE_EXE_LINKER_FLAGS=-Wl,--as-needed
mrpt/mrpt poles.rawlog "$prefix/share/polemcl/config/mrpt/pf-localization.ini" "$x" "$y" "$yaw" >filtered.txt ||
  fail "MRPT does not know the classes of the library"
paste -d' ' filtered.txt tum.txt | tail -n 40 |
  awk '{ e = sqrt(($2 - $6) ^ 2 + ($3 - $7) ^ 2); if (e > most) most = e }
       END { if (!(NR == 40 && most < 0.3)) { print most; exit 1 } }' ||
  fail "the poses of MRPT's filter are more than 0.3 m from those of pole-localize"
# The lines at the head of the settings, and the program itself.
mkdir pf
cp "$prefix/share/polemcl/config/mrpt/pf-localization.ini" pf
sed -n 's/^;   \(pole-\|awk \)/\1/p' pf/pf-localization.ini >pf/example.sh
[ "$(wc -l <pf/example.sh)" -eq 4 ] || fail "pf-localization.ini has no example of four lines"
(cd pf && PATH="$bin:$PATH" quietly sh -e example.sh)
(cd pf && LD_PRELOAD="$lib/libpolemcl.so" quietly pf-localization pf-localization.ini </dev/null)
awk 'NR > 40 { sum += $1; ++n } END { if (!(n > 300 && sum / n < 0.05)) { print n, sum / n; exit 1 } }' \
  pf/pf_000_*/GT_error.txt || fail "the example of pf-localization.ini misses the truth by more than 0.05 m"
module=$(find "$prefix" -path '*/dist-packages/polemcl.*.so')
if grep -q '^POLEMCL_PYTHON:BOOL=ON' "$build/CMakeCache.txt"; then
  echo "8/9 Python: scans to a map and to poses; installed settings by their names"
  [ -n "$module" ] || fail "the Python module was not installed"
  python=$(sed -n 's/^POLEMCL_PYTHON_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
  PYTHONPATH=$(dirname "$module")
  export PYTHONPATH
  "$python" "$top/share/examples/python/drive.py" scans scans python.polemap >python.txt
  [ "$(awk '$5 == "ok"' python.txt | wc -l)" -gt 40 ] || fail "the poses of the example are not ok: $(cat python.txt)"
  "$python" -c 'import polemcl; polemcl.PoleExtractor("hdl32e.ini")' || fail "installed settings were not found"
  entries=$(nm -D --defined-only "$module" | cut -d' ' -f3-)
  [ "$entries" = PyInit_polemcl ] || fail "the Python module exports more than its entry: $entries"
else
  echo "8/9 Python: the module was not built (POLEMCL_PYTHON)"
  [ -z "$module" ] || fail "a Python module was installed that was not to be built"
fi

echo "9/9 The examples that --help shows, as they stand, in a copy of the sample"
cp -r "$prefix/share/polemcl/sample" sample
"$top/tests/install/examples.sh" "$bin" >sample/examples.sh
[ "$(wc -l <sample/examples.sh)" -gt 25 ] || fail "--help shows few examples: $(cat sample/examples.sh)"
(cd sample && PATH="$bin:$PATH" quietly sh -ex examples.sh)
echo "Installed tree: all checks passed"
