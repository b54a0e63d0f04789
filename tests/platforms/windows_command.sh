#!/bin/bash
# Compiles and links the command for Windows, by clang and the headers of MinGW-w64: SOURCE FOLDER
#
# Empty functions stand for libpng, libjpeg and libfyaml, and for the compiler's own library. So the program cannot run;
# but what Windows lacks, or a warning, fails here. bindings/python/build_wheels.py makes one that runs.
set -euo pipefail
source=$1 folder=$2 mingw=/usr/x86_64-w64-mingw32
skip() { echo "skipped: there is no $1"; exit 77; }
command -v clang >/dev/null || skip clang
[ -e $mingw/include/windows.h ] && [ -e $mingw/lib/libwinpthread.a ] || skip "mingw-w64-x86-64-dev"
ld -V | grep -q i386pep || skip "linker for Windows"

mkdir -p "$folder/libraries"
cd "$folder"
place=$(dirname "$(find /usr/include -name jconfig.h -print -quit)")
cp /usr/include/{libpng16/png,libpng16/pngconf,jpeglib,jmorecfg,jerror,libfyaml}.h /usr/include/pnglibconf.h "$place/jconfig.h" libraries
for name in libpng libjpeg libfyaml; do
    printf 'Name: %s\nDescription: %s\nVersion: 1\nCflags: -I%s\nLibs:\n' $name $name "$PWD/libraries" > libraries/$name.pc
done
{
    nm -D --defined-only $(gcc -print-file-name=libpng16.so) $(gcc -print-file-name=libjpeg.so) $(gcc -print-file-name=libfyaml.so) |
        awk '$2 == "T" { sub(/@.*/, "", $3); print "void " $3 "(void) {}" }' | sort -u
    echo 'void ___chkstk_ms(void) {} void __cpu_indicator_init(void) {} unsigned __cpu_model[4];'
} > libraries/empty.c
clang --target=x86_64-w64-mingw32 -w -c libraries/empty.c -o libraries/empty.o

PKG_CONFIG_LIBDIR=$PWD/libraries cmake -G Ninja -S "$source" -B build -DCMAKE_SYSTEM_NAME=Windows -DCMAKE_SYSTEM_PROCESSOR=x86_64 \
    -DCMAKE_C_COMPILER=clang -DCMAKE_C_COMPILER_TARGET=x86_64-w64-mingw32 -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG="-O0 -Werror" -DSINGE_TESTS=OFF -DSINGE_PYTHON=OFF -DSINGE_EXR=OFF \
    -DSINGE_ASSIMP=OFF -DSINGE_NLOPT=OFF -DSINGE_MESHOPT=OFF -DSINGE_VIEW=OFF \
    -DCMAKE_EXE_LINKER_FLAGS="-fuse-ld=$(command -v ld) -nostdlib $mingw/lib/crt2.o" \
    -DCMAKE_C_STANDARD_LIBRARIES="$PWD/libraries/empty.o -Wl,--start-group -lmingw32 -lmingwex -lmsvcrt -lkernel32 -Wl,--end-group" >/dev/null
cmake --build build --target singe_program -j2
