#!/bin/bash
# check_arrows.sh must notice every kind of wrong include: test_arrows.sh SCRIPT
set -euo pipefail
script=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{common,src/heat,src/burn,src/dynamics,src/collision,src/reference,formats,preview,analysis,experiments,cli,scene,include/singe}

# expect RESULT FILE INCLUDE: a tree whose FILE holds that one include
expect() {
    echo "#include $3" >"$tree/$2"
    local result=good
    "$script" "$tree" >/dev/null 2>&1 || result=bad
    rm "$tree/$2"
    [ $result = "$1" ] || { echo "$2 with $3: expected $1, was $result"; exit 1; }
}

expect good src/heat/a.c '"common/error.h"'
expect good src/heat/a.c '"heat/heat.h"'
expect bad src/heat/a.c '"burn/burn.h"'
expect bad src/heat/a.c '"sim/sim_internal.h"'
expect bad src/heat/a.c '"../burn/burn.h"'
expect bad src/heat/a.c '<png.h>'
expect good formats/a.c '"singe/sim.h"'
expect bad formats/a.c '"common/error.h"'
expect bad formats/a.c '"scene/scene.h"'
expect good scene/a.c '"preview/preview.h"'
expect bad scene/a.c '"preview/internal.h"'
expect bad cli/a.c '"shell/shell.h"'
expect bad cli/a.c '<shell/shell.h>'
expect bad include/singe/a.h '"common/error.h"'
expect good src/dynamics/a.c '"collision/collision.h"'
expect bad src/collision/a.c '"dynamics/dynamics.h"'
expect bad src/reference/a.c '"dynamics/dynamics_plan.h"'
expect bad common/a.c '"shell/shell.h"'
expect good preview/a.c '"common/float3.h"'
expect bad preview/a.c '"common/pool.h"'
expect good experiments/a.c '"analysis/rim.h"'
expect bad cli/a.c '"experiments/paper.h"'

# headers that include each other
echo '#include "heat/b.h"' >"$tree/src/heat/c.h"
expect good src/heat/b.h '"common/error.h"'
expect bad src/heat/b.h '"heat/c.h"'

# two files with the same name
rm "$tree/src/heat/c.h"
echo >"$tree/src/burn/volume.h"
expect good src/heat/b.h '"common/error.h"'
echo >"$tree/scene/volume.h"
expect bad src/heat/b.h '"common/error.h"'
