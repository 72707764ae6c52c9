#!/usr/bin/env bash
# pictures.sh PLIANT: pictures in docs/images that are frames of a run of a shipped level, and its plot
# (`./dev docs pictures`). The editor's come from docs/editor_story.txt, reference_*.png from docs/reference; drawings
# (.svg) are written by hand.
set -euo pipefail
pliant=$1 images=$(cd "$(dirname "$0")/../images" && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# frame LEVEL NUMBER SIZE: that one of twelve.
frame() {
  "$pliant" run "$1" --headless --frames 12 --size "$3" --out "$out/$1" >/dev/null
  convert "$out/$1/frame-$(printf %04d "$2").png" -strip -quality 88 "$images/$1.jpg"
}

frame three_probes 5 960x540
frame glass_heart 3 960x540
frame hand 3 640x360
convert "$out/three_probes/forces.png" -strip -resize 1200x -colors 128 "png8:$images/forces.png"
