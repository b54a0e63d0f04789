#!/bin/bash
# Builds the fuzz targets for oss-fuzz, which sets CC, CFLAGS, CXX, CXXFLAGS, LIB_FUZZING_ENGINE, OUT and WORK. Each comes
# with its seeds, its limits, and, if it reads text, a dictionary: the words in the sources of its reader.
set -eu
here=$(dirname "$(realpath "$0")")
source=$(realpath "$here/../../..")
build=$WORK/build

# CMake takes CC and CFLAGS, which also count coverage, by itself. The C++ compiler links, as engines are in C++.
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG=-g1 \
    -DCMAKE_C_LINK_EXECUTABLE="$CXX $CXXFLAGS <LINK_FLAGS> <OBJECTS> -o <TARGET> <LINK_LIBRARIES>" \
    -DCMAKE_EXE_LINKER_FLAGS="-Wl,-rpath,'\$ORIGIN/lib'" \
    -DSINGE_FUZZ=ON -DSINGE_FUZZ_FLAGS= -DSINGE_FUZZ_ENGINE="$LIB_FUZZING_ENGINE" \
    -DSINGE_TESTS=OFF -DSINGE_PYTHON=OFF -DSINGE_EXR=OFF -DSINGE_ASSIMP=OFF -DSINGE_NLOPT=OFF \
    -DSINGE_ASSERTIONS=ON
cmake --build "$build" --target fuzz_targets

mkdir -p "$OUT/lib"
for program in "$build"/tests/fuzz/fuzz_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    name=$(basename "$program")
    cp "$program" "$OUT"
    # the machines that fuzz have none of these
    ldd "$program" | sed -n 's/^\s*\(lib\(fyaml\|png\|jpeg\|z\|cmocka\).*\) => \(\S*\) .*/\3/p' | xargs -r cp -L -t "$OUT/lib"

    rm -f "$OUT/${name}_seed_corpus.zip"
    (cd "$source/tests/fuzz/seeds/${name#fuzz_}" && zip -q -r "$OUT/${name}_seed_corpus.zip" .)

    # words in double quotes, or in backticks where users read of them
    case ${name#fuzz_} in
    scene | set | folder) readers="docs/scene.md docs/materials.md program/scene/words.c" ;;
    meshes) readers="program/formats/gltf*.c program/formats/stl.c" ;;
    obj | ply | vdb) readers="program/formats/${name#fuzz_}*.c" ;;
    *) readers= ;; # bytes that stand for numbers and calls
    esac
    if [ -n "$readers" ]; then
        # shellcheck disable=SC2086
        (cd "$source" && grep -hoE '["`][A-Za-z][A-Za-z0-9_-]{1,30}["`]' $readers | tr '`' '"' | sort -u) > "$OUT/$name.dict"
    fi

    limit=10 # s for one input of a reader; whole simulations have more, as in run.sh
    case $name in fuzz_step | fuzz_snapshot | fuzz_calls | fuzz_replay) limit=120 ;; esac
    printf '[libfuzzer]\nmax_len = 65536\ntimeout = %d\n' $limit > "$OUT/$name.options"
done
