#!/bin/sh
# Writes the man pages of programs and of their subcommands from what they print for --help.
# Usage: share/man/write.sh OUT VERSION DATE PROGRAM...
#   OUT   folder of the pages; those of an earlier run are removed
#   DATE  of the pages, YYYY-MM-DD
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1 version=$2 date=$3
shift 3
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

# write_page COMMAND...: the page of `pole-map build` is pole-map-build.1. For help2man, a program of that
# name prints the help; with a mark, the examples stay as they are.
write_page() {
  title=$(basename "$1")${2:+-$2}
  "$@" --help >"$dir/help"
  printf "#!/bin/sh\nsed 's/^  pole-/  $ pole-/' '%s'\n" "$dir/help" >"$dir/$title"
  chmod +x "$dir/$title"
  name=$(sed '/^$/Q' "$dir/help" | tr '\n' ' ' | sed 's/[. ]*$//')
  help2man --no-info --include="$here/common.h2m" --version-string="$version" --name="$name" \
    --output="$dir/page" "$dir/$title"
  sed "/^\.TH /s/\"[A-Z][a-z]* [0-9]*\" \"[^\"]*\"/\"$date\" \"polemcl $version\"/" "$dir/page" >"$out/$title.1"
}

rm -rf "$out"
mkdir -p "$out"
for program in "$@"; do
  write_page "$program"
  # shellcheck disable=SC2013 # one word a line
  for command in $(sed -n '/^Subcommands:/,/^[^ ]*$/s/^  \([a-z][a-z0-9-]*\).*/\1/p' "$dir/help"); do
    write_page "$program" "$command"
  done
done
echo '.so man1/pole-localize.1' >"$out/polemcl.1" # the file that holds all programs
