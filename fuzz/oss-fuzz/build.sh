#!/bin/bash -eu
# Builds the fuzz targets for OSS-Fuzz: run in its container, which sets SRC, OUT, WORK, CC, CXX, CFLAGS, CXXFLAGS and
# LIB_FUZZING_ENGINE. Leaves in OUT each target with its dictionary and seeds, and in OUT/lib what they load, for the
# machine that runs them has none of it.
# SPDX-License-Identifier: MIT

cd "$SRC/rtlang"
./autogen.sh
mkdir -p "$WORK/rtlang" "$OUT/lib/rtlang"
cd "$WORK/rtlang"
# CFLAGS has the sanitizers already. Installed like this, programs in OUT look for modules in OUT/lib/rtlang, wherever
# OUT is moved to.
"$SRC/rtlang/configure" --bindir="$OUT" --libdir="$OUT/lib" --disable-study --disable-strip --without-openimageio
# The engine is C++.
make -j"$(nproc)" CCLD="$CXX" LIB_FUZZING_ENGINE="$LIB_FUZZING_ENGINE" fuzz-build

for target in grammar scene dump world programs tree calls picture ini partial; do
    name=fuzz_$target
    case $target in
        picture | ini | partial | calls | programs | tree) kind=$target ;;
        *) kind=text ;;
    esac
    cp "fuzz/$name" "$OUT/"
    patchelf --set-rpath '$ORIGIN/lib' "$OUT/$name"
    ldd "fuzz/$name" | awk '/libpng|libz\.|libjpeg/ { print $3 }' | xargs -r -I '{}' cp '{}' "$OUT/lib/"
    if [ -f "fuzz/$kind.dict" ]; then
        cp "fuzz/$kind.dict" "$OUT/$name.dict"
    fi
    zip -q -j -r "$OUT/${name}_seed_corpus.zip" "fuzz/seeds/$kind" "$SRC/rtlang/fuzz/corpus/$kind"
    printf '[libfuzzer]\nmax_len = 4096\ntimeout = 25\n' >"$OUT/$name.options"
done
cp .libs/rtlang_jpeg.so "$OUT/lib/rtlang/"
patchelf --set-rpath '$ORIGIN/..' "$OUT/lib/rtlang/rtlang_jpeg.so"
ldd .libs/rtlang_jpeg.so | awk '/libjpeg/ { print $3 }' | xargs -r -I '{}' cp '{}' "$OUT/lib/"
