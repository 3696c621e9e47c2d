#!/bin/sh
# Builds TBB with the thread sanitizer, from Debian's sources of the version that is installed: what it hands from
# thread to thread is then seen as guarded, and what our own code shares in its loops without a guard is found.
# Usage: tests/sanitize/tbb.sh FOLDER
#   FOLDER   gets lib/libtbb.so.12 (for LD_LIBRARY_PATH); when it is there, for the same compiler, nothing is done
# Takes a minute of one core and 10 MB from the mirror of Debian that apt knows; changes nothing of apt's.
set -eu
[ $# = 1 ] || {
  sed -n '2,6s/^# //p' "$0" >&2
  exit 2
}

fail() {
  echo "tests/sanitize/tbb.sh: $1" >&2
  exit 1
}

version=$(dpkg-query -W -f '${Version}' libtbb-dev)
source=$(dpkg-query -W -f '${source:Package}=${source:Version}' libtbb-dev)
wanted="$source $(clang++ --version | head -n 1)"
[ "$(cat "$1/version" 2>/dev/null)" != "$wanted" ] || exit 0
rm -rf "$1"
mkdir -p "$1"
out=$(cd "$1" && pwd)

# Where apt would take the package from, as an entry for its sources: "deb-src URI SUITE COMPONENT".
entry=$(apt-cache madison libtbb-dev | awk -F ' *[|] *' -v version="$version" \
  '$2 == version && / Packages$/ { split($3, words, " "); suite = component = words[2]
     sub("/[^/]*$", "", suite); sub(".*/", "", component); print "deb-src", words[1], suite, component; exit }')
[ -n "$entry" ] || fail "no mirror in apt's lists has libtbb-dev $version, which is installed: try apt-get update, then upgrade"

dir=$out/work
mkdir -p "$dir/lists/partial" "$dir/cache/archives/partial"
echo "$entry" >"$dir/sources.list"

# quietly COMMAND...: shows what it prints only when it fails.
quietly() {
  (cd "$dir" && "$@") >"$dir/log" 2>&1 || {
    tail -n 20 "$dir/log" >&2
    return 1
  }
}

# Lists of its own, so that it needs not be root.
apt_get() {
  quietly apt-get -q -o Dir::Etc::SourceList="$dir/sources.list" -o Dir::Etc::SourceParts=/dev/null \
    -o Dir::State::Lists="$dir/lists" -o Dir::Cache="$dir/cache" -o APT::Sandbox::User=root "$@"
}

echo "Building $source with the thread sanitizer"
apt_get update --error-on=any || fail "the list of sources could not be fetched ($entry)"
# Debian's patches are for its tests and for other processors, so the archive of the authors is enough.
apt_get source --download-only --tar-only "$source" || fail "the sources of $source could not be fetched ($entry)"
mkdir "$dir/source"
quietly tar -xf "$dir"/onetbb_*.orig.tar.* -C "$dir/source" --strip-components 1 || fail "the sources of $source could not be unpacked"
# Without libtbbmalloc beside it, TBB allocates with malloc, which the sanitizer knows.
quietly cmake -G Ninja -S "$dir/source" -B "$dir/build" -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only -DNDEBUG" \
  -DCMAKE_CXX_FLAGS=-fno-omit-frame-pointer -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF \
  -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON -DCMAKE_INSTALL_LIBDIR=lib ||
  fail "TBB could not be configured"
quietly cmake --build "$dir/build" --target tbb --parallel "$(nproc)" || fail "TBB could not be built"
quietly cmake --install "$dir/build" --component runtime --prefix "$out" || fail "TBB could not be installed in $out"
rm -rf "$dir"
echo "$wanted" >"$out/version"
