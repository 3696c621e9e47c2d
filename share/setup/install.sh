#!/bin/sh
# Installs the packages of packages.txt that are missing; does nothing when none is.
# Usage: install.sh [full]   full: also what only tests/run.sh --full needs, the lines "#full NAME"
# Needs Debian 13 or 12 (or another system with these packages) and root, or sudo.
set -eu
list=$(dirname "$0")/packages.txt
wanted='s/#.*//'
[ "${1-}" != full ] || wanted="s/^#full //;$wanted"

fail() {
  echo "install.sh: $1" >&2
  exit 1
}

for tool in dpkg-query apt-get; do
  command -v "$tool" >/dev/null 2>&1 ||
    fail "no $tool here: install the equivalents of the packages in $list by hand"
done

missing=
# shellcheck disable=SC2013 # words, one or none a line
for package in $(sed "$wanted" "$list"); do
  status=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null) || status=
  case $status in
    ?i\ *) ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
  as_root=
elif command -v sudo >/dev/null 2>&1 && { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; }; }; then
  as_root=sudo
else
  fail "missing packages, and neither root nor sudo to install them; ask for: apt-get install$missing"
fi

echo "Installing, which takes some minutes and is silent:$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# A source list that cannot be refreshed need not matter: the installation decides.
$as_root apt-get update -qq >"$log" 2>&1 || true
# shellcheck disable=SC2086 # word splitting wanted: a list of packages, an optional sudo
if ! $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
  --no-install-recommends -o Dpkg::Use-Pty=0 $missing >>"$log" 2>&1; then
  tail -n 20 "$log" >&2
  fail "apt-get could not install:$missing (its last words are above)"
fi
