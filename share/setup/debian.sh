# An empty Debian in a folder, for the scripts that source this. They run as root, set `top` (of the sources), `dir`
# (a new folder of their own) and `release` (bookworm or trixie), and call clean_up at their end.
# shellcheck shell=sh disable=SC2154 # top, dir and release are the caller's
root=$dir/root

fail() {
  echo "$0: $1" >&2
  exit 1
}

clean_up() {
  for folder in data dev/pts proc; do
    umount "$root/$folder" 2>/dev/null || :
  done
  rm -rf --one-file-system "$dir"
}

# quietly COMMAND...: shows what it prints only when it fails.
quietly() {
  "$@" >"$dir/log" 2>&1 || {
    tail -n 40 "$dir/log" >&2
    fail "this failed: $*"
  }
}

# inside COMMAND...: as root in the new Debian.
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}
apt_get() {
  quietly inside apt-get -qq -y --no-install-recommends -o Dpkg::Use-Pty=0 "$@"
}

# The mirror that this machine uses.
mirror() {
  cat /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources 2>/dev/null |
    sed -n 's/^URIs: *\([^ ]*\/debian\/*\) *$/\1/p; s/^deb \(\[.*\] \)*\([^ ]*\/debian\/*\) [a-z]* .*/\2/p' |
    head -n 1
}

# make_root: the empty Debian, as debootstrap left it in ~/.cache/polemcl the first time.
make_root() {
  base=${XDG_CACHE_HOME:-$HOME/.cache}/polemcl/$release.tar
  mkdir "$root"
  if [ -s "$base" ]; then
    tar -C "$root" -xf "$base"
  else
    mirror=$(mirror)
    mkdir -p "$(dirname "$base")"
    quietly debootstrap --variant=minbase "$release" "$root" "${mirror:-http://deb.debian.org/debian}"
    tar -C "$root" -cf "$base.new" .
    mv "$base.new" "$base"
  fi
  cp /etc/resolv.conf "$root/etc/"
  [ ! -d /etc/apt/apt.conf.d ] ||
    grep -rhi '^[^/]*proxy' /etc/apt/apt.conf.d >"$root/etc/apt/apt.conf.d/90proxy" || :
  printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # no services here
  chmod 755 "$root/usr/sbin/policy-rc.d"
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # it need not survive a crash
  mount -t proc proc "$root/proc"
  mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
  [ -e "$root/dev/ptmx" ] || ln -s pts/ptmx "$root/dev/ptmx"
  apt_get update
}

# copy_sources: the files that git knows, in /polemcl of the new Debian.
copy_sources() {
  mkdir "$root/polemcl"
  (cd "$top" && git ls-files -z | tar -c --null -T - --ignore-failed-read) | tar -C "$root/polemcl" -x
}
