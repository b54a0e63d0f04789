#!/bin/bash
# Installs the Debian packages that building, testing and running need. Does nothing when all are there.
set -euo pipefail

packages=(build-essential cmake ninja-build pkg-config libfyaml-dev libpng-dev libjpeg62-turbo-dev libembree-dev
          libopenexr-dev libassimp-dev libcmocka-dev ffmpeg python3 python3-openvdb valgrind)
if [ "${1:-}" = --check ]; then
    packages+=(clang libclang-rt-14-dev assimp-testmodels) # the fuzz targets, models to burn
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

echo "installing: ${missing[*]}"
root=()
[ "$(id -u)" -eq 0 ] || root=(sudo)
"${root[@]}" apt-get update -q
"${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
