#!/bin/bash
# Installs the packages needed to build, test and run Singe on Debian and Ubuntu, if any is missing.
#   setup.sh [--check] [--list]
# --check adds the packages for fuzzing and for all of make check. --list prints the names and installs nothing.
set -euo pipefail

# a|b is the first of both that the system's package lists contain. Compilers and libraries have the system's own
# versions. Only the formatter's version is fixed, because each one breaks lines differently.
needed=(build-essential cmake ninja-build pkg-config libfyaml-dev libpng-dev 'libjpeg-dev|libjpeg62-turbo-dev'
        libopenexr-dev libassimp-dev libnlopt-dev libmicrohttpd-dev libmeshoptimizer-dev libcmocka-dev python3)
# optional: without these, runs make no video and some tests are skipped
useful=(ffmpeg python3-numpy python3-openvdb valgrind locales libsdl2-dev)
only_list=false
for argument in "$@"; do
    case $argument in
    --check) needed+=(clang libclang-rt-dev) useful+=(assimp-testmodels 'clang-format-14|clang-format' mingw-w64-x86-64-dev) ;; # for fuzzing; models to burn; Windows
    --list) only_list=true ;;
    *) echo "usage: setup.sh [--check] [--list]" >&2; exit 2 ;;
    esac
done

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]; }
known() { [ -n "$(apt-cache policy "$1" 2>/dev/null | sed -n '/Candidate: [^(]/p')" ]; }

# first TEST a|b: prints the first name that passes
first() {
    local name
    for name in ${2//|/ }; do
        if "$1" "$name"; then echo "$name"; return; fi
    done
    return 1
}

# prints the names that are not installed
missing() {
    local name
    for name in "$@"; do first installed "$name" >/dev/null || echo "$name"; done
}

mapfile -t must < <(missing "${needed[@]}")
mapfile -t may < <(missing "${useful[@]}")
if $only_list; then must=("${needed[@]}") may=("${useful[@]}"); fi
[ $((${#must[@]} + ${#may[@]})) -gt 0 ] || exit 0

root=()
[ "$(id -u)" -eq 0 ] || root=(sudo)
if ! $only_list && { [ ${#must[@]} -gt 0 ] || ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; }; then
    "${root[@]}" apt-get update -q
fi

names=()
for entry in "${must[@]}"; do
    name=$(first known "$entry") || { echo "setup.sh: this system has no package ${entry//|/ or }" >&2; exit 1; }
    names+=("$name")
done
for entry in "${may[@]}"; do
    if name=$(first known "$entry"); then names+=("$name"); else echo "setup.sh: this system has no package ${entry//|/ or }; it is optional" >&2; fi
done
if $only_list; then printf '%s\n' "${names[@]}"; exit 0; fi
[ ${#names[@]} -gt 0 ] || exit 0

echo "installing: ${names[*]}"
"${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${names[@]}"
