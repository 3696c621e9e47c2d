#!/bin/sh
# Builds the documentation site and checks it: links and anchors lead somewhere, commands on the pages have options
# that their programs know, and no page is longer than ten minutes of reading or wider than a phone.
# Usage: tests/site/run.sh [OUT]; skips, and says why, where a program is missing.
#   OUT  a folder that keeps the site
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
check_arguments 0 1 "$@"
find_programs pole-import pole-extract pole-map pole-localize pole-eval pole-simulate pole-batch pole-labels

for tool in mkdocs doxygen chromium python3; do
  if ! command -v "$tool" >/dev/null; then
    echo "Test of the site: skipped, no $tool here (packages mkdocs-material, doxygen, chromium, python3)"
    exit 0
  fi
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
out=${1:-$folder/out}

fail() {
  echo "Test of the site: FAILED: $1" >&2
  exit 1
}

"$top/share/site/build.sh" "$out" >"$folder/build.log" 2>&1 || {
  cat "$folder/build.log" >&2
  fail "share/site/build.sh ends with an error"
}
out=$(cd "$out" && pwd)
python3 "$top/tests/site/links.py" "$out/site" || fail "there are broken links"
python3 "$top/tests/site/commands.py" "$top" "$bin" || fail "there are commands that would be refused"
python3 "$top/tests/site/length.py" "$top" || fail "there are pages that are too long or have no place"

# All pages in frames as wide as a phone; each frame writes the width of its content.
pages=$(cd "$out/site" && find . -name '*.html' ! -path './share/doc/api/*' ! -name 404.html | sort)
{
  cat <<'END'
<pre></pre>
<script>
function measure(frame) {
  const root = frame.contentDocument.documentElement;
  const line = ["width", frame.getAttribute("src"), root.clientWidth, root.scrollWidth].join(" ");
  document.querySelector("pre").append(line, "\n");
}
</script>
END
  for page in $pages; do
    echo "<iframe src=\"$page\" width=\"390\" height=\"800\" onload=\"measure(this)\"></iframe>"
  done
} >"$out/site/phone-test.html"
HOME=$folder chromium --headless --no-sandbox --disable-gpu --allow-file-access-from-files --dump-dom \
  --virtual-time-budget=60000 "file://$out/site/phone-test.html" >"$folder/dom.html" 2>"$folder/chromium.log" ||
  fail "Chromium ends with an error: $(tail -n 1 "$folder/chromium.log")"
rm "$out/site/phone-test.html"
sed 's/<[^>]*>//g' "$folder/dom.html" | grep '^width ' >"$folder/widths" || fail "Chromium shows no page"
count=$(echo "$pages" | wc -l)
[ "$count" -ge 30 ] || fail "fewer than 30 pages were built"
[ "$(wc -l <"$folder/widths")" = "$count" ] || fail "Chromium shows $(wc -l <"$folder/widths") of $count pages"
wide=$(awk '$4 > $3 { print $2 " (" $4 " of " $3 " pixels)" }' "$folder/widths")
[ -z "$wide" ] || fail "wider than a phone: $wide"
echo "Test of the site: passed; $count pages, links, commands, length, width"
