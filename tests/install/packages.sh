#!/bin/sh
# Checks the Debian packages with lintian, installs them in an empty Debian and tries them there as a
# user without the sources: the commands of the start page, man pages, completion, an example against
# the headers, the Python module. Then removes them and looks for what was left behind.
# Usage: tests/install/packages.sh bookworm | trixie FOLDER
#   FOLDER  holds the packages, which were made on that release (commands.sh does both)
# Needs root, and a mirror of Debian (that of this machine).
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
names="libpolemcl1.0 polemcl libpolemcl-dev polemcl-doc python3-polemcl"
case "$#:${1-}" in
  2:bookworm | 2:trixie) release=$1 ;;
  *)
    echo "usage: tests/install/packages.sh bookworm | trixie FOLDER" >&2
    exit 2
    ;;
esac
dir=$(mktemp -d)
# shellcheck source=share/setup/debian.sh
. "$top/share/setup/debian.sh"
[ "$(id -u)" = 0 ] || fail "needs root, for chroot"
trap clean_up EXIT

# as_user SCRIPT: as a normal user in the new Debian.
as_user() {
  chroot "$root" env -i PATH=/usr/bin:/bin LANG=C.UTF-8 su -s /bin/bash walker -c "cd && set -e && $1"
}
# files: all files of the new Debian that are not of apt, dpkg or caches, nor of the kernel.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./home -o -path ./packages \
    -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log \
    -o -path ./tmp -o -path ./run \) -prune -o -print | LC_ALL=C sort)
}

echo "1/7 Packages"
mkdir "$dir/packages"
for name in $names; do
  cp "$2/$name"_*.deb "$dir/packages/" || fail "no package $name in $2"
done
# Nobody has asked for the packages in Debian's list of bugs.
quietly lintian --allow-root --fail-on error,warning --tag-display-limit 0 \
  --suppress-tags initial-upload-closes-no-bugs,maintscript-calls-ldconfig "$dir"/packages/*.deb

echo "2/7 An empty Debian: $release"
make_root
quietly inside useradd --create-home walker
# What only this test needs is there before, and systemd, which every real Debian has: MRPT's packages bring it, and
# apt never removes it.
apt_get install g++ cmake make man-db bash-completion adduser systemd-sysv
files >"$dir/before"
inside dpkg --get-selections | cut -f1 | LC_ALL=C sort >"$dir/installed"

echo "3/7 Installing the packages"
cp -r "$dir/packages" "$root/packages"
# shellcheck disable=SC2046 # one name a word
apt_get install $(find "$root/packages" -name '*.deb' -printf '/packages/%f ')
# shellcheck disable=SC2086 # word splitting wanted
quietly inside dpkg --verify $names

echo "4/7 The start page, as a user"
page=/usr/share/doc/polemcl/share/doc/start.md
# shellcheck disable=SC2016 # for awk
quietly as_user "awk '/^## In one minute/ { on = 1 } /^\`\`\`/ { take = on && /sh\$/; next } take' $page >start.sh && bash -ex start.sh"
quietly as_user '
  pole-eval trajectory --truth tuesday.tum --estimate out/run_00.tum --json error.json
  pole-simulate --quiet --config hdl32e.ini --length 60 --poles poles.rawlog --set simulation.detections=hdl32e.json'
error=$(jq .pos_mean "$root/home/walker/error.json") || fail "no errors were written"
awk "BEGIN { exit !($error > 0 && $error < 0.02) }" || fail "the mean error is $error m"
[ -s "$root/home/walker/run.png" ] || fail "no picture was drawn"
# Without sensors there is a message of the module that drives them, not one that it is missing.
as_user 'pole-localize --config vlp16.ini --sensors live/vlp16.ini --map street.polemap --start 0,0,0,2,5 \
  --output live --for 1' >"$dir/live" 2>&1 && fail "a drive without sensors was no error"
! grep -qi 'module\|cannot open shared' "$dir/live" || fail "the drivers of sensors cannot be loaded: $(cat "$dir/live")"

echo "5/7 Man pages, completion, Python, the example against the headers"
for page in pole-simulate pole-map pole-map-build pole-eval-faults; do
  quietly as_user "man -w $page && man $page | grep -q EXAMPLES"
done
# shellcheck disable=SC2016 # for the bash inside
offered=$(as_user 'set +e; source /usr/share/bash-completion/bash_completion; _completion_loader pole-map
  COMP_WORDS=(pole-map build --config hdl) COMP_CWORD=3; _polemcl; echo "${COMPREPLY[*]}"') || :
[ "$offered" = hdl32e.ini ] || fail "completion offers '$offered' instead of hdl32e.ini"
quietly as_user 'python3 -c "import polemcl; polemcl.PoleExtractor(\"hdl32e.ini\")"'
for example in extract map; do
  quietly as_user "cmake -S /usr/share/doc/polemcl/share/examples/$example -B $example && cmake --build $example"
done
quietly as_user './extract/extract monday/velodyne/000040.bin | grep -q . && ./map/map monday example.polemap'

echo "6/7 Removing the packages"
# shellcheck disable=SC2086 # word splitting wanted
apt_get purge $names
# Debian 13 keeps what others merely recommend or suggest.
apt_get -o APT::AutoRemove::RecommendsImportant=0 -o APT::AutoRemove::SuggestsImportant=0 autoremove --purge
inside dpkg --get-selections | cut -f1 | LC_ALL=C sort >"$dir/left"
diff "$dir/installed" "$dir/left" >"$dir/log" || {
  cat "$dir/log" >&2
  fail "packages were left behind"
}

echo "7/7 What is left behind"
files >"$dir/after"
LC_ALL=C comm -13 "$dir/before" "$dir/after" | grep -i pole >"$dir/log" && {
  cat "$dir/log" >&2
  fail "files were left behind"
}
echo "Packages: all checks passed"
