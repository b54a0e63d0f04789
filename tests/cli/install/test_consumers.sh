#!/bin/bash
# Other projects and other builds than the usual one, configured and compiled only as far as they differ from it:
# test_consumers.sh SOURCE CC
set -euo pipefail
source=$1 cc=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

configure() {
    cmake -G Ninja "-DCMAKE_C_COMPILER=$cc" "$@" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
}

build() {
    ninja -C "$@" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
}

# a project that adds the source as a folder: it gets the library, and neither tests nor other programs
mkdir "$work/host"
cp "$source/tests/cli/install/consumer.c" "$work/host"
cat > "$work/host/CMakeLists.txt" << END
cmake_minimum_required(VERSION 3.22)
project(host C)
enable_testing()
add_subdirectory($source singe)
add_executable(consumer consumer.c)
target_link_libraries(consumer PRIVATE singe)
END
configure -S "$work/host" -B "$work/host/build"
ninja -C "$work/host/build" -n all > "$work/all"
grep -q "Linking C executable consumer" "$work/all"
if others=$(grep "Linking C executable" "$work/all" | grep -v "executable consumer$"); then
    echo "built with the host: $others"
    exit 1
fi
[ "$(cd "$work/host/build" && ctest -N | tail -1)" = "Total Tests: 0" ]
build "$work/host/build" CMakeFiles/consumer.dir/consumer.c.o # finds the headers
echo "add_subdirectory: the library alone"

# without the command, but with its tests
configure -S "$source" -B "$work/core" -DSINGE_PROGRAM=OFF
ninja -C "$work/core" -t targets all | sed -n 's/^\(tests\/fuzz\/.*\.o\): .*/\1/p' > "$work/objects"
[ -s "$work/objects" ] || grep -q "SINGE_TESTS:BOOL=OFF" "$work/core/CMakeCache.txt"
xargs -r ninja -C "$work/core" < "$work/objects" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
echo "SINGE_PROGRAM=OFF: $(wc -l < "$work/objects") objects of fuzz targets compile"

# after `make demo`, which builds the command alone: all that is installed is there. Stand-ins are enough to see it
configure -S "$source" -B "$work/demo" -DSINGE_TESTS=OFF
echo 'int singe_stand_in;' | "$cc" -x c -c - -o "$work/stand_in.o"
ninja -C "$work/demo" -t inputs singe_program | grep -E '^[^/].*\.a$' | while read -r archive; do
    ar rcs "$work/demo/$archive" "$work/stand_in.o"
done
touch "$work/demo/singe"
mkdir -p "$work/demo/words/man1" # which the command writes as it is built
touch "$work/demo/words/man1/singe.1" "$work/demo/words/"{singe.bash,_singe,singe.fish}
cmake --install "$work/demo" --prefix "$work/prefix" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
[ -f "$work/prefix/bin/singe" ] && [ -f "$work/prefix/include/singe/singe.h" ]
echo "cmake --install after make demo: the command, the libraries and the headers"
