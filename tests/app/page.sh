#!/usr/bin/env bash
# page.sh WEIR RESULTS CHECK.js: the page of published results loads in a browser without an error, its tables sort, its links lead
# somewhere, and it reads at 400 and at 1600 pixels. Exit code 77 (skipped) where there is no chromium.
set -euo pipefail
weir=$1 results=$2 check=$3
browser=$(command -v chromium || command -v chromium-browser) || { echo "skipped: no chromium (Debian: apt-get install chromium)"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/project"
cp -r "$results" "$work/project/results"
ln -s "$(dirname "$(realpath "$results")")/cases" "$work/project/cases"
cd "$work/project/results"
"$weir" report .
size=$(stat -c %s index.html)
[ "$size" -lt 8000000 ] || { echo "the page has $size bytes: too many to be opened without a thought"; exit 1; }

grep -o 'href="[^"#]*"' index.html | sed 's/^href="//; s/"$//' | grep -v '^data:' | sort -u >"$work/links" || true
[ -s "$work/links" ] || { echo "the page links to no file"; exit 1; }
while read -r link; do [ -e "$link" ] || { echo "a link leads nowhere: $link"; exit 1; }; done <"$work/links"
! grep -qE '(src|href)="https?:' index.html || { echo "the page asks the network for something"; exit 1; }

{ echo '<!DOCTYPE html><script>'; cat "$check"; echo '</script>'; tail -n +2 index.html; } >check.html
for width in 400 1600; do  # in a frame: chromium's own window is never narrower than 500 pixels
    echo "<!DOCTYPE html><title>nothing came</title><iframe width=$width height=1000 style=\"border:0\" src=check.html></iframe>" \
         "<script>addEventListener('message', e => { document.title = e.data; })</script>" >frame.html
    title=$(timeout 120 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" --virtual-time-budget=20000 \
        --window-size=1700,1100 --dump-dom "file://$PWD/frame.html" 2>"$work/log" | grep -o '<title>[^<]*</title>' | head -1) || true
    echo "$width px: $title"
    [ "$title" = "<title>ok at $width px</title>" ] || { grep -v dbus "$work/log" | tail -5; exit 1; }
done
