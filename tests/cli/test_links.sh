#!/bin/bash
# check_links.py must notice every kind of fault: test_links.sh PYTHON SCRIPT
set -euo pipefail
python=$1 script=$2
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/docs "$tree"/src/heat
printf '# Heat\n\n## The front\n' >"$tree"/src/heat/README.md
touch "$tree"/src/heat/heat.c

# expect RESULT TEXT: a page with that text
expect() {
    printf '# Page\n\n%s\n' "$2" >"$tree/docs/page.md"
    local result=good
    "$python" "$script" "$tree" >/dev/null || result=bad
    [ $result = "$1" ] || { echo "$2: expected $1, was $result"; exit 1; }
}

good='[heat](../src/heat/README.md)'
expect good "$good"
expect good "$good [front](../src/heat/README.md#the-front)"
expect good "$good [page](#page)"
expect good "$good [elsewhere](https://example.org/page#none)"
expect bad "$good [none](none.md)"
expect bad "$good [none](../src/heat/README.md#none)"
expect bad "$good [none](#none)"
expect bad 'no link at all'
expect good "$good \`heat.c\` \`heat/heat.c\` \`src/NAME.c\` \`_v3.c\`"
expect bad "$good \`cold.c\`"
expect bad "$good \`burn/heat.c\`"
mkdir "$tree"/src/burn && touch "$tree"/src/burn/burn.c
expect bad "$good"
