#!/bin/bash
# make check-clients: other programs, installed by name into a folder of their own, on what a fresh burn leaves.
#
# usage: check.sh SINGE FOLDER [GROUP...]     FOLDER/NAME is the environment of a client, FOLDER/work/NAME what it made
#
# The groups are usd, newton, vtk, paraview, alembic, rerun, gltf, vat and blender; all of them without one. gltf and vat read images with
# vtk's Python.
#
# Exit codes: 0 all is good; 1 a client found a fault; 3 none did, but some could not be installed.
set -euo pipefail
singe=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
shift 2
groups=" ${*:-usd newton vtk paraview alembic rerun gltf vat blender} "
here=$(cd "$(dirname "$0")" && pwd)
locks=$here/../locks
python=${PYTHON:-python3}
failed=0
absent=0

# environment NAME: a Python of its own, made by $python, with what locks/NAME.txt has, and nothing of another hash
environment() {
    [ -x "$folder/$1/bin/python" ] || "$python" -m venv "$folder/$1" || return
    "$folder/$1/bin/pip" install --quiet --disable-pip-version-check --require-hashes -r "$locks/$1.txt"
}

# lacking NAME WHAT
lacking() {
    echo "== $1: needs $2, which is not to be had"
    absent=1
}

# find_python VERSION: one in PATH that runs, or one of pyenv's, whatever version is chosen there
find_python() {
    local found
    for found in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$1".*/bin/python; do
        "$found" -c "import sys; assert '%d.%d' % sys.version_info[:2] == '$1'" 2> /dev/null || continue
        echo "$found"
        return
    done
    return 1
}

# client NAME SCRIPT [WORK]     WORK: the folder of what it makes, NAME by default
client() {
    local work=${3:-$1}
    echo "== $work"
    if ! PYTHONDONTWRITEBYTECODE=1 timeout -k 5 150 "$folder/$1/bin/python" "$here/$2" "$singe" "$folder/work/$work" \
        > "$folder/$work.log" 2>&1; then
        failed=1
        tail -30 "$folder/$work.log"
        echo "$work: failed; all of it is in $folder/$work.log"
    else
        grep -v '^Fra:\|^Saved:\|^Time:\|^Info:\|INFO\|^$' "$folder/$work.log" || true
    fi
}

mkdir -p "$folder/work"
usd_client() {
    if environment usd; then client usd usd.py; else lacking usd "PyPI's usd-core"; fi
}

newton_client() {
    if environment newton; then client newton newton_client.py; else lacking newton "PyPI's newton"; fi
}

vtk_client() {
    if environment vtk; then client vtk vtk_client.py; else lacking vtk "PyPI's vtk"; fi
}

paraview_client() {
    [ -f "$folder/work/vtk/out/burn.pvd" ] || vtk_client # which writes what ParaView reads
    echo "== paraview"
    # Debian's packages: only root installs them
    if [ "$(id -u)" -eq 0 ] && command -v apt-get > /dev/null && ! command -v pvpython > /dev/null; then
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends paraview python3-paraview \
            python3-numpy xvfb xauth > "$folder/paraview.log" 2>&1 || true
    fi
    if ! command -v pvpython > /dev/null || ! command -v xvfb-run > /dev/null; then
        lacking paraview "pvpython and xvfb-run (packages paraview, python3-paraview, xvfb)"
    # ParaView asks the X server what it can and leaves it; a server that begins anew then refuses its window
    elif PYTHONDONTWRITEBYTECODE=1 xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
        pvpython "$here/paraview_client.py" "$singe" "$folder/work/paraview" > "$folder/paraview.log" 2>&1 &&
        grep '^ParaView' "$folder/paraview.log"; then :
    else
        failed=1
        tail -30 "$folder/paraview.log"
    fi
}

alembic_client() {
    if environment alembic; then client alembic alembic_client.py; else lacking alembic "PyPI's alembic3d"; fi
}

rerun_client() {
    if environment rerun; then client rerun rerun_client.py; else lacking rerun "PyPI's rerun-sdk"; fi
}

# those of the lock file, once; no package runs a script of its own
npm_packages() {
    cmp -s "$locks/package-lock.json" "$folder/npm/done" && return
    mkdir -p "$folder/npm"
    cp "$locks/package.json" "$locks/package-lock.json" "$folder/npm"
    npm ci --prefix "$folder/npm" --ignore-scripts --no-audit --no-fund --silent > "$folder/npm.log" 2>&1 || return
    cp "$locks/package-lock.json" "$folder/npm/done"
}

gltf_client() {
    echo "== gltf"
    if ! { npm_packages && environment vtk; }; then lacking gltf "npm's gltf-validator and @gltf-transform, and PyPI's vtk"
    elif NODE_PATH="$folder/npm/node_modules" PYTHON="$folder/vtk/bin/python" PYTHONDONTWRITEBYTECODE=1 \
            node "$here/gltf.js" "$singe" "$folder/work/gltf" > "$folder/gltf.log" 2>&1; then cat "$folder/gltf.log"
    else
        failed=1
        tail -30 "$folder/gltf.log"
    fi
}

vat_client() {
    echo "== vat"
    browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
    if [ -z "$browser" ]; then lacking vat chromium
    elif ! { npm_packages && environment vtk; }; then lacking vat "npm's three and PyPI's vtk"
    elif NODE_PATH="$folder/npm/node_modules" PYTHON="$folder/vtk/bin/python" PYTHONDONTWRITEBYTECODE=1 \
            node "$here/vat.js" "$singe" "$folder/work/vat" "$browser" > "$folder/vat.log" 2>&1; then cat "$folder/vat.log"
    else
        failed=1
        tail -30 "$folder/vat.log"
    fi
}

# each bpy is for one Python
blender_client() {
    local version
    for version in 3.11:4.5 3.13:5.2; do
        if ! python=$(find_python "${version%:*}"); then
            lacking "Blender ${version#*:}" "python${version%:*}"
            continue
        fi
        if environment "blender-${version#*:}"; then
            client "blender-${version#*:}" blender.py
            client "blender-${version#*:}" blender_meshes.py "meshes-${version#*:}"
            client "blender-${version#*:}" blender_alembic.py "alembic-${version#*:}"
        else
            lacking "Blender ${version#*:}" "PyPI's bpy"
        fi
    done
}

for group in usd newton vtk paraview alembic rerun gltf vat blender; do
    if [[ $groups == *" $group "* ]]; then "${group}_client"; fi
done
[ $failed -eq 0 ] || exit 1
[ $absent -eq 0 ] || exit 3
