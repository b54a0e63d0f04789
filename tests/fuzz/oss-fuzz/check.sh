#!/bin/bash
# What oss-fuzz does with build.sh, on this machine: builds with clang and the address sanitizer, once with libFuzzer and
# once with a stand-in for the library of another engine, and runs each target from its seeds: check.sh FOLDER
set -eu
here=$(dirname "$(realpath "$0")")
mkdir -p "${1:?usage: check.sh FOLDER}"
folder=$(realpath "$1")
export CC=clang CXX=clang++ CMAKE_BUILD_PARALLEL_LEVEL=2
flags="-O1 -fno-omit-frame-pointer -gline-tables-only -fsanitize=address -fsanitize-address-use-after-scope"

# build ENGINE-NAME ENGINE FLAG...
build() {
    export OUT=$folder/$1/out WORK=$folder/$1/work LIB_FUZZING_ENGINE=$2 CFLAGS="$flags ${*:3}" CXXFLAGS="$flags ${*:3}"
    rm -rf "$OUT"
    mkdir -p "$OUT" "$WORK"
    if ! "$here/build.sh" > "$folder/$1/log" 2>&1; then
        tail -20 "$folder/$1/log"
        exit 1
    fi
}

# unpacked NAME: the folder of a target's seeds
unpacked() {
    rm -rf "$WORK/seeds"
    python3 -m zipfile -e "$OUT/$1_seed_corpus.zip" "$WORK/seeds"
    echo "$WORK/seeds"
}

build libfuzzer -fsanitize=fuzzer -fsanitize=fuzzer-no-link
count=0
for options in "$OUT"/*.options; do
    name=$(basename "$options" .options)
    words=()
    if [ -e "$OUT/$name.dict" ]; then words=("-dict=$OUT/$name.dict"); fi
    if ! (cd "$(unpacked "$name")" && "$OUT/$name" -runs=200 -max_total_time=10 "${words[@]}" . > "$WORK/$name.log" 2>&1); then
        tail -20 "$WORK/$name.log"
        exit 1
    fi
    echo "$name: $(grep -c . "$OUT/$name.dict" 2> /dev/null || true) words, $(sed -n 's/.*INITED \(cov: [0-9]*\).*/\1/p' "$WORK/$name.log")"
    count=$((count + 1))
done
[ "$count" -gt 0 ]

mkdir -p "$folder/archive"
clang -c -O1 "$here/../give_files.c" -o "$folder/archive/give_files.o"
ar rcs "$folder/archive/libengine.a" "$folder/archive/give_files.o"
build archive "$folder/archive/libengine.a"
for options in "$OUT"/*.options; do
    name=$(basename "$options" .options)
    "$OUT/$name" "$(unpacked "$name")" > "$WORK/$name.log" 2>&1 || { tail -20 "$WORK/$name.log"; exit 1; }
    count=$((count - 1))
done
[ "$count" -eq 0 ]
echo "all targets link with another engine and take their seeds"
