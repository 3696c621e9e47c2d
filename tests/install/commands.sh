#!/bin/sh
# Runs both commands of the README in an empty Debian, from a copy of the files that git knows: they
# install what they need themselves. Then installs the Python module with pip (trixie), opens what MRPT's
# viewers show, reads here what was written there and there what was written here, makes the Debian
# packages there, and tries them (packages.sh).
# Usage: tests/install/commands.sh bookworm | trixie    Needs root, and a mirror of Debian.
# Programs here: build/bin, or POLEMCL_BIN. With POLEMCL_DATA, the tests on real scans run, too.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
case "$#:${1-}" in
  1:bookworm | 1:trixie) release=$1 ;;
  *)
    echo "usage: tests/install/commands.sh bookworm | trixie" >&2
    exit 2
    ;;
esac
dir=$(mktemp -d)
# shellcheck source=share/setup/debian.sh
. "$top/share/setup/debian.sh"
[ "$(id -u)" = 0 ] || fail "needs root, for chroot"
trap clean_up EXIT

echo "An empty Debian: $release"
make_root
copy_sources
data=
if [ -n "${POLEMCL_DATA-}" ]; then
  mkdir "$root/data"
  mount --bind -o ro "$POLEMCL_DATA" "$root/data"
  data=POLEMCL_DATA=/data
fi
echo "share/demo/run.sh"
inside /polemcl/share/demo/run.sh
echo "tests/run.sh"
inside env $data /polemcl/tests/run.sh
if [ "$release" = trixie ]; then # Debian 12 has no scikit-build-core
  echo "pip install, into a new virtual environment"
  apt_get install python3-scikit-build-core python3-venv
  quietly inside python3 -m venv --system-site-packages /env
  quietly inside /env/bin/pip install --no-build-isolation --no-index /polemcl
  for test in extraction localization maps; do
    quietly inside env POLEMCL_BIN_DIR=/polemcl/build/bin /env/bin/python "/polemcl/tests/python/test_$test.py"
  done
fi
echo "MRPT's viewers"
apt_get install xvfb openbox imagemagick xdotool xclip
inside /polemcl/tests/viewers/run.sh
echo "Files from here to there, and back"
"$top/tests/releases/write.sh" "$root/here"
inside /polemcl/tests/releases/run.sh /here
inside /polemcl/tests/releases/write.sh /there
"$top/tests/releases/run.sh" "$root/there"
echo "Packages"
inside /polemcl/share/setup/build.sh package package
"$top/tests/install/packages.sh" "$release" "$root/polemcl/build-package"
