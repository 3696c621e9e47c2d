#!/bin/sh
# Checks that need no test program. Each prints what is wrong and where.
# Usage: tests/lint.sh CHECK...
#   format    clang-format would change no source file
#   spelling  codespell knows no misspelling
#   files     text files end with one newline, and have no spaces at line ends (Markdown may)
#   words     no phrases that readers with another first language stumble over
#   faults    each fault of tests/mutation is in the sources once
#   findings  the test of each finding of the fuzzers is there
#   tidy      clang-tidy has nothing to say (.clang-tidy); takes many minutes
# Needs the packages that share/setup/install.sh full installs.
set -eu
cd "$(dirname "$0")/.."

sources() {
  git ls-files '*.cpp' '*.h'
}

# Not pictures, nor what programs wrote.
texts() {
  git ls-files | grep -v '\.png$\|\.pcap$\|\.rawlog$\|\.polemap$\|\.svg$\|\.gif$\|^tests/releases/[0-9]'
}

format() {
  sources | xargs clang-format --dry-run -Werror
}

spelling() {
  texts | xargs codespell
}

files() {
  # The file whose last character is no newline, or whose last line is empty; spaces at a line's end.
  bad=$(texts | while read -r name; do
    [ -s "$name" ] || continue
    [ -z "$(tail -c 1 "$name")" ] || echo "$name: the last line has no newline at its end"
    [ -n "$(tail -n 1 "$name")" ] || echo "$name: empty lines at the end"
    case $name in *.md) continue ;; esac # there, spaces at the end are a line break
    grep -n '[[:blank:]]$' "$name" | sed "s|^\([0-9]*\):.*|$name:\1: spaces at the end of the line|"
  done)
  [ -z "$bad" ] || {
    echo "$bad" >&2
    return 1
  }
}

words() {
  # "there is none", as "is None" is Python. The list itself does not count.
  ! git grep -niwE \
    'so many|by so much|there is none|likewise|borne out|all the same|of no consequence|as it were' \
    -- ':!tests/lint.sh' ':!tests/releases' ':!*.svg'
}

faults() {
  copy=$(mktemp -d)
  good=yes
  for list in mutations drawn; do
    python3 -IS tests/mutation/insert.py . "$copy" "tests/mutation/$list.txt" >/dev/null || good=
  done
  rm -r "$copy"
  [ "$good" ]
}

findings() {
  found=$(cut -d, -f4 share/reports/fuzz-findings.csv | tail -n +2 | tr . ' ' | while read -r suite name; do
    git grep -qE "^TEST(_F)?\($suite, $name\)" -- tests || echo "fuzz-findings.csv: no test is called $suite.$name"
  done)
  [ -z "$found" ] || {
    echo "$found" >&2
    return 1
  }
}

tidy() {
  cmake --preset clang -G Ninja >/dev/null
  # Not the tests, nor the generated identity of the build.
  run-clang-tidy -quiet -p build-clang -j "$(nproc)" '^(?!.*(/tests/|BuildIdentity)).*/(libpolemcl|apps)/'
}

[ $# -gt 0 ] || set -- --help
for check in "$@"; do
  case $check in
    format | spelling | files | words | faults | findings | tidy) ;;
    *)
      sed -n '2,11s/^# //p' "$0"
      [ "$check" = -h ] || [ "$check" = --help ] || exit 2
      exit 0
      ;;
  esac
done
status=0
for check in "$@"; do
  "$check" || {
    echo "tests/lint.sh: the check '$check' failed" >&2
    status=1
  }
done
exit $status
