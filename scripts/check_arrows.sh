#!/bin/bash
# Data flows one way: checks every #include against the table below, which is the only list of these rules.
#   check_arrows.sh [ROOT]
# The first word of a row is a folder. The others are what its files may include, besides their own folder and
# include/singe: folders, or single headers. No other file may include from that folder, except tests, which may include all.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

library='shell world heat burn ablate tear gas surface collision reference dynamics sim'
files='formats common/allocator.h common/curves.h common/order.h common/store.h common/printable.h common/float3.h mesh/polygons.h'
program="$files mesh/to_quads.h preview/preview.h scene analysis"
rules="
include/singe
src/common
src/shell        common
src/world        common shell
src/heat         common shell world
src/burn         common shell world
src/ablate       common shell world
src/tear         common shell world
src/gas          common shell world
src/surface      common shell ablate
src/collision    common shell
src/reference    common
src/dynamics     common shell world collision reference
src/sim          common $library
src/mesh         common materials
src/materials    common
program/formats  $files
program/windows  $files cli/spawn.h cli/text.h
program/preview  $files common/cpu.h common/float4.h world/triangle.h
program/scene    $files mesh/to_quads.h preview/preview.h preview/preview.def
program/analysis $files common/float3.h mesh/to_quads.h
program/cli      $program
program/sweep    $program cli
program/view     $program cli
program/main.c   cli common/printable.h scene/scene.h
lab/bench        $program cli
lab/page         $program cli bench
lab/paper        $program cli bench page
lab/validate     $program cli bench page
docs/samples
"

bad=0
fault() { echo "$1"; bad=1; }
includes() { grep -rHE '^[[:space:]]*#[[:space:]]*include' "$@" --include='*.[ch]' || true; }

while read -r folder allowed; do
    [ -e "$folder" ] || continue
    pattern="singe/.*|${folder#*/}/.*"
    for name in $allowed; do
        case $name in *.h | *.def) pattern+="|${name//./\\.}" ;; *) pattern+="|$name/.*" ;; esac
    done
    # a name without a folder is a file next to the one that includes it
    while IFS=: read -r file line; do
        name=${line#*\"} name=${name%%\"*}
        [[ $name =~ ^($pattern)$ ]] || { [[ $name != */* ]] && [ -f "$(dirname "$file")/$name" ]; } ||
            fault "$file: must not include \"$name\""
    done < <(includes "$folder" | grep '"' || true)
    # the library's own parts are not reached by angle brackets either
    while read -r line; do fault "$line"; done < <(includes "$folder" | grep -E "<(common|${library// /|})/" || true)
done < <(grep . <<<"$rules")

parts=()
for part in include src program lab; do [ -d $part ] && parts+=($part); done
while read -r file; do fault "$file: no row of the table is about it"; done < <(
    find "${parts[@]}" -name '*.[ch]' | grep -vE "^($(grep -oE '^[a-z/.]+' <<<"$rules" | paste -sd'|'))(/|$)" || true)

# the library needs libc, libm and threads only
while read -r line; do fault "$line: the library must not need other libraries"; done < <(
    includes $([ -d src ] && echo src) include | grep -E '<(libfyaml|png|jpeglib|openexr|xxhash)' || true)

# no header includes itself through others: tsort names the circles
circles=$(find "${parts[@]}" -name '*.h' -print0 | xargs -0r grep -HE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' |
    sed -E 's,^(include|src|program|lab)/,,; s,^([^:]*)/([^/:]*):[^"]*"([^"/]*)".*,\1/\2 \1/\3,; s,:[^"]*"([^"]*)".*, \1,' |
    tsort 2>&1 >/dev/null || true)
[ -z "$circles" ] || fault "headers include each other: $circles"

# the name of a file says which one is meant; a public header is singe/NAME
twice=$(find "${parts[@]}" -path include -prune -o -name '*.[ch]' -exec basename {} \; | sort | uniq -d)
[ -z "$twice" ] || fault "files with the same name: $twice"

[ $bad -eq 0 ] && echo "includes follow the arrows"
exit $bad
