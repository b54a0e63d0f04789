#!/bin/bash
# Data flows one way (docs/architecture.md): checks every #include against the arrows.
#
#   src/base      base
#   src/shell     base, shell
#   src/world     base, shell, world
#   src/<stage>   base, shell, world and its own folder: heat, burn, ablate, dynamics, tear and gas never meet
#   src/contact   base, shell; dynamics includes it too
#   src/step      everything in src
#   formats       formats
#   mesh          mesh, formats
#   preview       preview, formats
#   scene         scene, formats, mesh/mesh.h, preview/preview.h
#   bench         bench, mesh/mesh.h
#   cli           cli, bench, scene, formats, mesh/mesh.h, preview/preview.h
#
# and the public headers for all. Only src and tests see src. include/singe sees itself alone.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/.." && pwd)}
cd "$root"
bad=0

# check FOLDER ALLOWED: every quoted include of its files begins with one of the allowed words, or names a file
# beside the one that includes it.
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
    if grep -rnHE '^[[:space:]]*#[[:space:]]*include[[:space:]]*<(base|shell|world|contact|heat|burn|ablate|dynamics|tear|gas|step)/' \
        "$folder" --include='*.[ch]'; then bad=1; fi
}

check include 'singe/.*'
check src/base 'singe/.*|base/.*'
check src/shell 'singe/.*|base/.*|shell/.*'
check src/world 'singe/.*|base/.*|shell/.*|world/.*'
check src/contact 'singe/.*|base/.*|shell/.*|contact/.*'
for stage in heat burn ablate tear gas; do
    check src/$stage "singe/.*|base/.*|shell/.*|world/.*|$stage/.*"
done
check src/dynamics 'singe/.*|(base|shell|world|contact|dynamics)/.*'
check src/step 'singe/.*|(base|shell|world|contact|heat|burn|ablate|dynamics|tear|gas|step)/.*'
check formats 'singe/.*|formats/.*'
check mesh 'singe/.*|formats/.*|mesh/.*'
check preview 'singe/.*|formats/.*|preview/.*'
check scene 'singe/.*|formats/.*|mesh/mesh\.h|preview/preview\.h|scene/.*'
check cli 'singe/.*|formats/.*|mesh/mesh\.h|preview/preview\.h|scene/.*|bench/.*|cli/.*'
check bench 'singe/.*|mesh/mesh\.h|bench/.*'
check examples 'singe/.*'

# libsinge needs libc, libm and threads only
if grep -rnHE '#[[:space:]]*include[[:space:]]*<(libfyaml|png|jpeglib|embree|openexr|xxhash)' src include; then
    echo "libsinge must not need other libraries"
    bad=1
fi
[ $bad -eq 0 ] && echo "includes follow the arrows"
exit $bad
