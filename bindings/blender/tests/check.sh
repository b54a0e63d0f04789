#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make check-blender: the extension in Blender 4.5 and 5.2 (PyPI's bpy), from its sources and installed from its file.
#
# usage: check.sh SINGE FOLDER [WHEELS]     WHEELS: a folder of bindings/python/build_wheels.py; the wheel is inside the file then
set -euo pipefail
singe=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
here=$(cd "$(dirname "$0")" && pwd)
failed=0

find_python() {
    local found
    for found in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$1".*/bin/python; do
        "$found" -c "import sys; assert '%d.%d' % sys.version_info[:2] == '$1'" 2> /dev/null || continue
        echo "$found"
        return
    done
    return 1
}

extension() {
    local name=$1
    shift
    echo "== $name"
    if ! PYTHONDONTWRITEBYTECODE=1 "$@" > "$folder/$name.log" 2>&1; then
        failed=1
        tail -20 "$folder/$name.log"
    fi
    grep -a '^passed\|^Blender' "$folder/$name.log" || true
}

tried=0
for version in 3.11:4.5 3.13:5.2; do
    blender=${version#*:}
    if ! python=$(find_python "${version%:*}"); then
        echo "== Blender $blender: python${version%:*} is not installed"
        continue
    fi
    [ -x "$folder/$blender/bin/python" ] || "$python" -m venv "$folder/$blender"
    "$folder/$blender/bin/pip" install --quiet --disable-pip-version-check --require-hashes \
        -r "$here/../../../tests/locks/blender-$blender.txt"
    python=$folder/$blender/bin/python
    tried=1
    "$python" "$here/test_mesh.py"
    "$python" "$here/test_files.py"
    extension "sources-$blender" "$python" "$here/rig.py" "$singe" "$folder/work/sources-$blender"
    extension "attack-$blender" "$python" "$here/attack.py" "$singe" "$folder/work/attack-$blender"
    if [ -n "${3:-}" ]; then
        "$python" "$here/../build.py" --wheels "$3" --out "$folder"
        extension "installed-$blender" "$python" "$here/rig.py" "$singe" "$folder/work/installed-$blender" \
            "$(ls "$folder"/singe-*-linux-x64.zip)"
    fi
done
[ $tried -eq 1 ] || failed=1
exit $failed
