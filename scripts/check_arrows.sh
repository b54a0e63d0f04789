#!/bin/bash
# Data flows one way (docs/architecture.md): checks every #include against the arrows.
#
#   common          common
#   src/shell       common
#   src/world       common, shell
#   src/<stage>     common, shell, world: heat, burn, ablate, dynamics, tear and gas never meet
#   src/surface     common, shell, ablate
#   src/collision   common, shell
#   src/reference   common
#   src/dynamics    also collision and reference
#   src/sim         everything in src
#   formats         formats, common/allocator.h
#   mesh            formats
#   materials       formats/store.h
#   preview         formats, common/allocator.h, common/float3.h
#   scene           formats, mesh/to_quads.h, preview/preview.h
#   analysis        formats, mesh/to_quads.h
#   bench           mesh/to_quads.h
#   cli             analysis, bench, scene, formats, mesh/to_quads.h, preview/preview.h, common/allocator.h
#   experiments     cli, and what it may include
#   sweep           the same
#
# and everyone the own folder and the public headers. Only src and tests see src. include/singe sees itself alone. No
# header includes itself, directly or through others. No two files in all these folders have the same name.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/.." && pwd)}
cd "$root"
bad=0

# check FOLDER ALLOWED: every quoted include of its files begins with one of the allowed words, or names a file
# next to the one that includes it.
check() {
    local folder=$1 allowed=$2 file line name
    [ -d "$folder" ] || return 0
    while IFS=: read -r file line name; do
        name=${name#*\"} name=${name%%\"*}
        if [[ ! $name =~ ^($allowed)$ ]] && { [[ $name == */* ]] || [ ! -f "$(dirname "$file")/$name" ]; }; then
            echo "$file:$line: must not include \"$name\""
            bad=1
        fi
    done < <(grep -rnHE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$folder" --include='*.[ch]' || true)
    # the library's own parts are never reached by angle brackets either
    if grep -rnHE "^[[:space:]]*#[[:space:]]*include[[:space:]]*<(common|$rooms)/" "$folder" --include='*.[ch]'; then bad=1; fi
}

rooms='shell|world|heat|burn|ablate|tear|gas|surface|collision|reference|dynamics|sim'
public='singe/.*'
check include "$public"
check common "$public|common/.*"
check src/shell "$public|(common|shell)/.*"
check src/world "$public|(common|shell|world)/.*"
for stage in heat burn ablate tear gas; do
    check src/$stage "$public|(common|shell|world|$stage)/.*"
done
check src/surface "$public|(common|shell|ablate|surface)/.*"
check src/collision "$public|(common|shell|collision)/.*"
check src/reference "$public|(common|reference)/.*"
check src/dynamics "$public|(common|shell|world|collision|reference|dynamics)/.*"
check src/sim "$public|(common|$rooms)/.*"
outside="formats/.*|mesh/to_quads\.h|preview/preview\.h"
check formats "$public|common/allocator\.h|formats/.*"
check mesh "$public|(formats|mesh)/.*"
check materials "$public|formats/store\.h|materials/.*"
check preview "$public|(formats|preview)/.*|common/(allocator|float3)\.h"
check scene "$public|$outside|scene/.*"
check analysis "$public|(formats|analysis)/.*|mesh/to_quads\.h"
check bench "$public|mesh/to_quads\.h|bench/.*"
check cli "$public|$outside|(scene|analysis|bench|cli)/.*|common/allocator\.h"
check experiments "$public|$outside|(scene|analysis|bench|cli|experiments)/.*"
check sweep "$public|$outside|(scene|analysis|bench|cli|sweep)/.*"
check examples "$public"

# libsinge needs libc, libm and threads only
library=()
for folder in src common include; do [ -d $folder ] && library+=($folder); done
if grep -rnHE '#[[:space:]]*include[[:space:]]*<(libfyaml|png|jpeglib|embree|openexr|xxhash)' "${library[@]}"; then
    echo "libsinge must not need other libraries"
    bad=1
fi

# no circles: tsort names those that there are
circles=$(find "${library[@]}" formats mesh scene preview analysis bench cli experiments sweep -name '*.h' 2>/dev/null |
    xargs -r grep -HE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' |
    sed -E 's,^(include|src)/,,; s,^([^:]*)/([^/:]*):[^"]*"([^"/]*)".*,\1/\2 \1/\3,; s,:[^"]*"([^"]*)".*, \1,' |
    tsort 2>&1 >/dev/null || true)
if [ -n "$circles" ]; then
    echo "headers include each other: $circles"
    bad=1
fi

# the name of a file says which one is meant
twice=$(find src common formats mesh materials scene preview analysis bench cli experiments sweep -name '*.[ch]' \
    -exec basename {} \; 2>/dev/null | sort | uniq -d || true)
if [ -n "$twice" ]; then
    echo "files with the same name: $twice"
    bad=1
fi
[ $bad -eq 0 ] && echo "includes follow the arrows"
exit $bad
