#!/bin/bash
# abi.py accepts the present interface, and none in which a name, a size or a symbol has changed:
# test_abi.sh ABI.PY CC INCLUDE FILE ARCHIVE...
set -euo pipefail
abi=$1 cc=$2 include=$3 file=$4
shift 4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 "$abi" --cc "$cc" --include "$include" "$file" "$@"

refused() {
    if python3 "$abi" --cc "$cc" --include "$work/include" "$work/abi.txt" "${@:2}" >"$work/out" 2>&1; then
        echo "passed: $1"; exit 1
    fi
    grep -q "$1" "$work/out" || { cat "$work/out"; echo "does not say: $1"; exit 1; }
}
cp -r "$include" "$work/include"
cp "$file" "$work/abi.txt"
sed -i 's/float time_step; /double time_step; /' "$work/include/singe/types.h"
refused 'SingeSimDef.pace 88' "$@"
cp -r "$include/." "$work/include"
sed -i 's/SINGE_COLLIDER_BOX = 2/SINGE_COLLIDER_BOX = 9/' "$work/include/singe/types.h"
refused 'enum SINGE_COLLIDER_BOX 9' "$@"
cp -r "$include/." "$work/include"
grep -v 'singe_sim_step$' "$file" >"$work/abi.txt"
refused '+libsinge.a singe_sim_step' "$@"
echo "changed sizes, enumerators and symbols are noticed"
