#!/bin/sh
# Checks the syntax of the sources with the headers of another release of MRPT. Compiles nothing.
# Usage: tests/mrpt-release.sh FOLDER...
#   FOLDER  a folder that holds mrpt/*.h: each libs/*/include (MRPT 2) or modules/*/include (MRPT 3)
#           of MRPT's sources, and the folder of the headers that configuring MRPT writes
# Needs a configured build/ (for the version) and Eigen.
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
[ $# -gt 0 ] || {
  sed -n '2,6s/^# //p' "$0" >&2
  exit 2
}
flags=
for folder in "$@"; do
  flags="$flags -isystem $(cd "$folder" && pwd)"
done
cd "$top"
flags="$flags -isystem /usr/include/eigen3 -Ilibpolemcl/include -Ibuild/include"

# check FILE...: all in one go, which reads the headers once.
check() {
  echo "$* " | tr ' ' '\n' | sed -n "s|..*|#include \"$top/&\"|p" |
    g++ -std=c++17 -fsyntax-only -Wno-deprecated-declarations $flags -iquote libpolemcl/src -iquote apps -x c++ - ||
    failed=yes
}

failed=
# The drivers of sensors are a module of their own, with names of their own.
module='live/(CUdpOdometry|SensorModule|SensorThread)'
check $(find libpolemcl/include/polemcl/mrpt libpolemcl/src/mrpt -name '*.h' -o -name '*.cpp' | grep -vE "$module")
check $(find libpolemcl/src/mrpt -name '*.cpp' | grep -E "$module")
check $(find libpolemcl/src/report/scene -name '*.cpp')
check apps/import/DatasetImport.cpp
check apps/simulate/SimulatedPoles.cpp
[ -z "$failed" ] || exit 1
echo "No errors of syntax"
