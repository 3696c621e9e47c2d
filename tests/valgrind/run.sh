#!/bin/sh
# Runs the examples that --help shows under Valgrind, in a copy of the sample: no program may use memory that it
# never wrote to, or that is not its own.
# Usage: tests/valgrind/run.sh
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
"$top/share/setup/build.sh" ci programs
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cp -r "$top/share/sample" "$dir/sample"
# Fewer trials: a program takes 30 times as long.
"$top/tests/install/examples.sh" "$top/build/bin" | sed 's/--trials 50/--trials 2/; s/--runs 5/--runs 2/' >"$dir/examples.txt"
[ "$(wc -l <"$dir/examples.txt")" -gt 25 ] || {
  echo "tests/valgrind/run.sh: --help shows few examples: $(cat "$dir/examples.txt")" >&2
  exit 1
}

# Children are followed: pole-batch runs the other programs. Scripts of others are not.
cd "$dir/sample"
status=0
while read -r program options; do
  echo "$program $options"
  # shellcheck disable=SC2086 # as it stands in --help, where quoted words have no blanks
  eval valgrind -q --suppressions="$top/tests/valgrind/libraries.supp" --trace-children=yes \
    --trace-children-skip='*/python3*,/bin/*,/usr/bin/*' --error-exitcode=99 \
    --log-file="$dir/log.%p" "$top/build/bin/$program" $options >"$dir/printed" 2>&1 || {
    status=1
    cat "$dir/printed"
  }
  cat "$dir"/log.*
  [ -z "$(cat "$dir"/log.*)" ] || status=1
  rm "$dir"/log.*
done <"$dir/examples.txt"
exit $status
