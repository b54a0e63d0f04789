#!/bin/bash
# check_arrows.sh must notice every kind of wrong include: test_arrows.sh SCRIPT
set -euo pipefail
script=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{src/{common,heat,burn,dynamics,collision,reference},program/{formats,preview,analysis,cli,scene},lab/paper,include/singe}

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
expect good program/formats/a.c '"singe/sim.h"'
expect bad program/formats/a.c '"common/error.h"'
expect bad program/formats/a.c '"scene/scene.h"'
expect good program/scene/a.c '"preview/preview.h"'
expect bad program/scene/a.c '"preview/internal.h"'
expect bad program/cli/a.c '"shell/shell.h"'
expect bad program/cli/a.c '<shell/shell.h>'
expect bad include/singe/a.h '"common/error.h"'
expect good src/dynamics/a.c '"collision/collision.h"'
expect bad src/collision/a.c '"dynamics/dynamics.h"'
expect bad src/reference/a.c '"dynamics/dynamics_plan.h"'
expect bad src/common/a.c '"shell/shell.h"'
expect good program/preview/a.c '"common/float3.h"'
expect bad program/preview/a.c '"common/pool.h"'
expect good lab/paper/a.c '"analysis/rim.h"'
expect bad program/cli/a.c '"paper/paper.h"'

# headers that include each other
echo '#include "heat/b.h"' >"$tree/src/heat/c.h"
expect good src/heat/b.h '"common/error.h"'
expect bad src/heat/b.h '"heat/c.h"'

# two files with the same name
rm "$tree/src/heat/c.h"
echo >"$tree/src/burn/volume.h"
expect good src/heat/b.h '"common/error.h"'
echo >"$tree/program/scene/volume.h"
expect bad src/heat/b.h '"common/error.h"'
