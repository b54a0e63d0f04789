#!/bin/bash
# Draws docs/gallery with the command in build/: burns every example, draws its best frame, a contact sheet and four
# seconds around that frame, prints how long it took, and stores the output of `singe measure`, also in the table of
# docs/gallery/README.md.
# Usage: scripts/draw_gallery.sh [EXAMPLE...]
set -euo pipefail
cd "$(dirname "$0")/.."
declare -A best=([letter]=0087 [letter-hanging]=0146 [hot-sphere]=0060 [page-hot]=0045 [newspaper]=0084
    [curtain]=0098 [stack-edge]=0068 [stack]=0108 [crumpled-ball]=0140 [hot-iron]=0098 [tear]=0024 [shirt]=0102
    [burning-torus]=0046 [macro]=0024 [note]=0062 [title]=0112)
declare -A measured=([letter]=50-59 [letter-hanging]=100-109 [hot-sphere]=50-59 [page-hot]=40-49 [newspaper]=80-89
    [curtain]=100-109 [stack-edge]=60-69 [stack]=66-79 [crumpled-ball]=100-109 [hot-iron]=70-79 [tear]=30-39
    [shirt]=60-69 [burning-torus]=60-69 [macro]=40-49 [note]=70-79 [title]=70-79)
order=(note letter macro letter-hanging hot-sphere page-hot newspaper curtain stack-edge stack crumpled-ball hot-iron tear
    shirt burning-torus title)
[ $# -gt 0 ] && order=("$@")
mkdir -p docs/gallery
jpeg() { ffmpeg -loglevel error -y -i "$1" -qscale:v 3 -update 1 "$2"; }
# half as large again as the scene's picture
large() { ffprobe -v error -show_entries stream=width,height -of csv=p=0 "$1" | awk -F, '{ print int(1.5 * $1) "," int(1.5 * $2) }'; }
third() { ffprobe -v error -show_entries stream=width,height -of csv=p=0 "$1" | awk -F, '{ print int($1 / 3) "," int($2 / 3) }'; }
for name in "${order[@]}"; do
    frame=${best[$name]} out=out/gallery/$name
    begun=$EPOCHREALTIME
    build/singe run "examples/$name/$name.yaml" -o "$out" --no-preview --quiet
    burnt=$EPOCHREALTIME
    build/singe render "$out" --frames "$((10#$frame))" --quiet
    drawn=$EPOCHREALTIME
    build/singe render "$out" --sheet 4x2 --only-sheet --quiet
    build/singe render "$out" --frames "$((10#$frame))" --quiet -o "$out/large" \
        --set "preview.size=[$(large "$out/frames/$name.$frame.png")]" --set preview.samples=64
    jpeg "$out/large/frames/$name.$frame.png" "docs/gallery/$name.jpg"
    ffmpeg -loglevel error -y -i "$out/sheet.png" -qscale:v 7 -update 1 "docs/gallery/$name-sheet.jpg"
    last=$(ls "$out/ply" | wc -l) end=$((10#$frame + 36))
    end=$((end < last ? end : last))
    rm -rf "$out/clip" # no frames of an earlier one
    build/singe render "$out" --frames "$((end > 96 ? end - 95 : 1))-$end" --quiet -o "$out/clip" \
        --set "preview.size=[$(third "$out/frames/$name.$frame.png")]" --set preview.samples=8
    ffmpeg -loglevel error -y -f image2 -framerate 24 -pattern_type glob -i "$out/clip/frames/*.png" -vf fps=12 -c:v libwebp_anim \
        -quality 45 -compression_level 4 -loop 0 "docs/gallery/$name-clip.webp"
    build/singe measure "$out" --frames "${measured[$name]}" > "docs/gallery/$name.txt"
    awk -v name="$name" -v a="$begun" -v b="$burnt" -v c="$drawn" -v frames="$(ls "$out/ply" | wc -l)" -v n="$(nproc)" \
        'BEGIN { printf "%-15s %3d frames in %5.1f s, a picture in %.2f s, on %d threads\n", name, frames, b - a, c - b, n }'
done
scripts/gallery_table.py
