#!/bin/sh
# Builds targets of a preset (CMakePresets.json); a second time only what changed.
# Usage: share/setup/build.sh PRESET TARGET...
set -eu
cd "$(dirname "$0")/../.."
preset=$1
shift

# Ninja for a new folder; a folder that is configured keeps its generator.
export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset "$preset" >"$log" 2>&1; then
  cat "$log" >&2
  echo "build.sh: could not configure the preset $preset (see above)" >&2
  exit 1
fi
cmake --build --preset "$preset" --target "$@" --parallel "$(nproc)"
