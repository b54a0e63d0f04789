#!/bin/bash
# make check-clients: other programs, installed by name into a folder of their own, on what a fresh burn leaves.
#
# usage: check.sh SINGE FOLDER     FOLDER/NAME is the environment of a client, FOLDER/work/NAME what it made
set -euo pipefail
singe=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
here=$(cd "$(dirname "$0")" && pwd)
python=${PYTHON:-python3}
failed=0

# environment NAME PACKAGE...: a Python of its own with these packages
environment() {
    local name=$1
    shift
    [ -x "$folder/$name/bin/python" ] || "$python" -m venv "$folder/$name"
    "$folder/$name/bin/pip" install --quiet --disable-pip-version-check "$@"
}

# client NAME SCRIPT
client() {
    echo "== $1"
    if ! PYTHONDONTWRITEBYTECODE=1 "$folder/$1/bin/python" "$here/$2" "$singe" "$folder/work/$1" > "$folder/$1.log" 2>&1; then
        failed=1
        tail -30 "$folder/$1.log"
        echo "$1: failed; all of it is in $folder/$1.log"
    else
        grep -v '^Fra:\|^Saved:\|^Time:\|^$' "$folder/$1.log" || true
    fi
}

mkdir -p "$folder/work"
environment usd usd-core numpy
client usd usd.py
environment vtk vtk numpy
client vtk vtk_client.py
echo "== gltf"
mkdir -p "$folder/gltf"
if npm install --prefix "$folder/gltf" --no-audit --no-fund --silent gltf-validator > "$folder/gltf.log" 2>&1 &&
    NODE_PATH="$folder/gltf/node_modules" PYTHON="$folder/vtk/bin/python" PYTHONDONTWRITEBYTECODE=1 \
        node "$here/gltf.js" "$singe" "$folder/work/gltf" >> "$folder/gltf.log" 2>&1; then cat "$folder/gltf.log"
else
    failed=1
    tail -30 "$folder/gltf.log"
fi
# bpy has a Python of its own choice: 4.5 is for 3.11
if environment blender 'bpy==4.5.*'; then client blender blender.py
else echo "== blender: this Python has no bpy 4.5; it is for Python 3.11 (PYTHON=python3.11)"; failed=1; fi
exit $failed
