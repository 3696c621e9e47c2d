#!/bin/sh
# Runs the commands of share/doc/tutorial.md, from its step 0 on, and makes its pictures: tutorial-scan.png and
# tutorial-run.png.
# Usage: share/figures/tutorial.sh [PICTURES]
#   PICTURES  folder of the pictures, share/figures unless given
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 0 1 "$@"
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval pole-batch
pictures=$(cd "${1:-$top/share/figures}" && pwd)

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
awk '/^<!-- steps -->$/ { on = 1 } /^```/ { command = on && $0 == "```sh"; next } command' \
  "$top/share/doc/tutorial.md" >"$out/steps.sh"
[ -s "$out/steps.sh" ] || die "no commands in share/doc/tutorial.md after the line <!-- steps -->"
(cd "$out" && PATH="$bin:$PATH" sh -eux steps.sh)
cp "$out/scan.png" "$pictures/tutorial-scan.png"
cp "$out/run.png" "$pictures/tutorial-run.png"
