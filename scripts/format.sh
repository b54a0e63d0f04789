#!/bin/bash
# Formats the C sources by .clang-format.
#   format.sh [--check]
# --check changes nothing, and fails with the names of files that are not formatted. Exits with 77 if clang-format 14 is
# not installed: other versions break lines differently.
set -euo pipefail
cd "$(dirname "$0")/.."
version=14
program=
for name in clang-format-$version clang-format; do
    if "$name" --version 2>/dev/null | grep -q "version $version\."; then program=$name; break; fi
done
if [ -z "$program" ]; then echo "format.sh: clang-format $version is not installed" >&2; exit 77; fi

options=(-i)
[ "${1:-}" != --check ] || options=(--dry-run --Werror --ferror-limit=1)
find . -type d \( -name 'build*' -o -name .git -o -name out \) -prune -o -name '*.[ch]' -print0 |
    xargs -0 -P "$(getconf _NPROCESSORS_ONLN)" -n 50 "$program" "${options[@]}"
[ "${1:-}" != --check ] || echo "all sources are formatted"
