#!/bin/sh
# Builds the documentation site: pages from share/doc, README and reports, what the programs print for --help, and the
# C++ reference from the headers.
# Usage: share/site/build.sh OUT      OUT/site/index.html is its first page; it opens without a server
# Needs Debian's mkdocs-material and doxygen. Broken links and faults in comments are errors.
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)

[ $# = 1 ] || {
  echo "usage: share/site/build.sh OUT" >&2
  exit 2
}
for tool in mkdocs doxygen; do
  command -v "$tool" >/dev/null || {
    echo "build.sh: no $tool here: install the Debian packages mkdocs-material and doxygen" >&2
    exit 1
  }
done
bin=${POLEMCL_BIN:-$top/build/bin}
[ -x "$bin/pole-map" ] || {
  echo "build.sh: no program $bin/pole-map: build first (share/setup/build.sh release programs)" >&2
  exit 1
}
mkdir -p "$1"
out=$(cd "$1" && pwd)
rm -rf "$out/source" "$out/site"
mkdir -p "$out/source/share"
cp "$top/README.md" "$top/CONTRIBUTING.md" "$top/CHANGELOG.md" "$out/source"
for folder in doc examples figures reports; do
  cp -R "$top/share/$folder" "$out/source/share"
done
cp "$top/share/site/mkdocs.yml" "$top/share/site/lists.py" "$out"
cp "$top/share/site/extra.css" "$out/source"

# help_of PROGRAM [SUBCOMMAND]: a block with what it prints.
help_of() {
  printf '\n```text\n'
  "$@" --help
  printf '```\n'
}
mkdir "$out/source/help"
for name in import extract map localize eval batch simulate labels; do
  {
    echo "# pole-$name"
    help_of "$bin/pole-$name"
    # shellcheck disable=SC2013 # one word a line
    for command in $("$bin/pole-$name" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\).*/\1/p'); do
      printf '\n## pole-%s %s\n' "$name" "$command"
      help_of "$bin/pole-$name" "$command"
    done
  } >"$out/source/help/pole-$name.md"
done

(cd "$top" && {
  cat share/site/Doxyfile
  echo "INPUT = libpolemcl/include share/site/reference.md"
  echo "USE_MDFILE_AS_MAINPAGE = share/site/reference.md"
  echo "OUTPUT_DIRECTORY = $out/source/share/doc"
  echo "HTML_OUTPUT = api"
} | doxygen -)
mkdocs build --strict --config-file "$out/mkdocs.yml" >"$out/mkdocs.log" 2>&1 || {
  grep -v '^INFO' "$out/mkdocs.log" >&2
  exit 1
}
echo "$out/site/index.html"
