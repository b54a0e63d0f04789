#!/bin/bash
# Installs a build into an empty folder and links a small program against it, by find_package and by pkg-config:
# test_install.sh BUILD CONSUMER CC [FLAGS...]
set -euo pipefail
build=$1 consumer=$2 cc=$3
shift 3
flags=$*
version=$(sed -n 's/^#define SINGE_VERSION "\(.*\)"/\1/p' "$consumer/../../../include/singe/base.h")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/prefix" >"$work/log"
[ -f "$work/prefix/include/singe/singe.h" ]

cmake -S "$consumer" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_C_COMPILER="$cc" \
    -DCMAKE_C_FLAGS="$flags" >>"$work/log"
cmake --build "$work/build" >>"$work/log"
library=$(dirname "$(find "$work/prefix" -name 'libsinge.*' | head -n 1)")
export LD_LIBRARY_PATH=$library
[ "$("$work/build/consumer")" = "$version 5" ]
[ "$("$work/build/dresser")" = "2.4 g" ] # 0.02 m2 of 120 g/m2

# a client may use any name that does not begin with singe_
if [ "$(uname)" = Linux ] && [ -f "$library/libsinge.a" ]; then
    strangers=$(nm -g --defined-only "$library"/libsinge*.a | awk 'NF == 3 && $3 !~ /^singe_/ { print $3 }')
    [ -z "$strangers" ] || { echo "global names: $strangers"; exit 1; }
fi

# moved elsewhere, it must still be found: the files hold no path of this machine
mv "$work/prefix" "$work/moved"
pc=$(dirname "$(find "$work/moved" -name singe.pc)")
export PKG_CONFIG_PATH=$pc LD_LIBRARY_PATH=${library/prefix/moved}
# shellcheck disable=SC2046,SC2086
"$cc" $flags "$consumer/consumer.c" $(pkg-config --cflags --libs singe) -o "$work/by_pkg_config"
[ "$("$work/by_pkg_config")" = "$version 5" ]
[ "$(pkg-config --modversion singe)" = "$version" ]
# shellcheck disable=SC2046,SC2086
"$cc" $flags "$consumer/dresser.c" $(pkg-config --cflags --libs singe-input) -o "$work/dresser"
[ "$("$work/dresser")" = "2.4 g" ]

if [ -x "$work/moved/bin/singe" ]; then "$work/moved/bin/singe" --version; fi
echo "installed, found and linked by find_package and pkg-config"
