#!/bin/sh
# Makes the Debian packages of each release, in an empty Debian of its own, from the files that git knows.
# Usage: share/setup/make-packages.sh OUT [trixie | bookworm]...    both unless named
#   OUT   gets a folder with the packages of each
# Needs root, debootstrap, and a mirror of Debian (that of this machine).
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
[ $# -ge 1 ] || {
  sed -n '2,5s/^# //p' "$0" >&2
  exit 2
}
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
[ $# -gt 0 ] || set -- trixie bookworm

# shellcheck source=share/setup/debian.sh
. "$top/share/setup/debian.sh"
[ "$(id -u)" = 0 ] || fail "needs root, for chroot"
for release in "$@"; do
  case $release in
    trixie | bookworm) ;;
    *) fail "$release: known are trixie and bookworm" ;;
  esac
  dir=$(mktemp -d)
  root=$dir/root
  trap clean_up EXIT
  echo "$release: an empty Debian"
  make_root
  copy_sources
  echo "$release: packages"
  quietly inside /polemcl/share/setup/install.sh
  quietly inside /polemcl/share/setup/build.sh package package
  mkdir -p "$out/$release"
  cp "$root"/polemcl/build-package/*.deb "$out/$release/"
  clean_up
  trap - EXIT
done
ls "$out"/*/*.deb
