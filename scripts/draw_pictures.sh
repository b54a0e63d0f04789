#!/bin/bash
# Draws the pictures of the documentation: runs the examples and keeps a frame of each.
set -euo pipefail
cd "$(dirname "$0")/.."
for picture in letter:0100 letter-hanging:0110 hot-sphere:0066; do
    name=${picture%:*} frame=${picture#*:}
    build/cli/singe run "examples/$name/$name.yaml" -o "out/pictures/$name" --frames "$((10#$frame))"
    ffmpeg -loglevel error -y -i "out/pictures/$name/frames/$name.$frame.png" -qscale:v 3 -update 1 "docs/pictures/$name.jpg"
done
