#!/usr/bin/env bash
# libraries.sh FOLDER JOBS: Debian's sources of the libraries that have more than headers, compiled for WebAssembly into
# FOLDER/prefix; those of headers alone are linked from /usr/include into FOLDER/headers. `./dev web` runs it.
set -euo pipefail
folder=$1 jobs=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
prefix=$folder/prefix
# As the engine's own (cmake/web.cmake): exceptions, and longjmp of libpng and libjpeg, are WebAssembly's.
flags="-O2 -DNDEBUG -fwasm-exceptions -sSUPPORT_LONGJMP=wasm -msimd128 -ffp-contract=off -w"
threads=$([[ ${PLIANT_WEB_THREADS:-} ]] && echo -pthread || true)

# emcc runs scripts that need acorn, which a node from elsewhere than Debian does not find.
export NODE_PATH=/usr/share/nodejs
mkdir -p "$folder/lists/partial" "$folder/sources" "$folder/headers" "$prefix/lib" "$prefix/include"

# source PACKAGE: unpacked in sources/PACKAGE, with Debian's patches.
source_of() {
  [[ -d $folder/sources/$1 ]] && return
  local release apt
  release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
  echo "deb-src http://deb.debian.org/debian $release main" >"$folder/sources.list"
  apt=(apt-get -q -o Dir::Etc::sourcelist="$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null
       -o Dir::State::lists="$folder/lists")
  [[ -e $folder/lists/updated ]] || { "${apt[@]}" update && touch "$folder/lists/updated"; }
  rm -rf "$folder/unpack"
  mkdir "$folder/unpack"
  (cd "$folder/unpack" && "${apt[@]}" source "$1" && mv ./*/ "$folder/sources/$1") >"$folder/unpack.log" 2>&1 ||
    { cat "$folder/unpack.log" >&2; echo "libraries.sh: the source package $1 was not read" >&2; exit 1; }
  rm -rf "$folder/unpack"
}

# by_cmake PACKAGE OPTIONS...
by_cmake() {
  local package=$1
  shift
  [[ -e $prefix/$package.done ]] && return
  source_of "$package"
  emcmake cmake -S "$folder/sources/$package" -B "$folder/build/$package" -G Ninja -Wno-dev -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_C_FLAGS="$flags $threads" -DCMAKE_CXX_FLAGS="$flags $threads" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_FIND_ROOT_PATH="$prefix" -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF "$@"
  cmake --build "$folder/build/$package" -j "$jobs" ${target:+--target $target}
  [[ ${target:-} ]] && return
  cmake --install "$folder/build/$package" >/dev/null
  touch "$prefix/$package.done"
}

# by_hand PACKAGE LIBRARY FLAGS FILE...: a library whose own build script is for other systems.
by_hand() {
  local package=$1 library=$2 own=$3 file
  shift 3
  mkdir -p "$folder/build/$package"
  (
    cd "$folder/sources/$package"
    printf '%s\0' "$@" | xargs -0 -P "$jobs" -I{} sh -c \
      'emcc '"$flags $threads $own"' -c "$1" -o "$2/$(echo "$1" | tr / _).o"' - {} "$folder/build/$package"
  )
  rm -f "$prefix/lib/$library"
  emar rcs "$prefix/lib/$library" "$folder/build/$package"/*.o
  touch "$prefix/${package%%/*}.done"
}

headers() {
  local name
  for name in glm fmt nlohmann eigen3/Eigen tiny_gltf.h stb; do
    [[ -e /usr/include/$name ]] || { echo "libraries.sh: /usr/include/$name is missing" >&2; exit 1; }
    ln -sfn "/usr/include/$name" "$folder/headers/$(basename "$name")"
  done
  # libstdc++'s Bessel functions (bessel.cpp)
  ln -sfn "$(find /usr/include/c++ -maxdepth 2 -name tr1 | sort -V | tail -n 1)" "$folder/headers/tr1"
}

zlib() {
  [[ -e $prefix/zlib.done ]] && return
  source_of zlib
  local at=$folder/sources/zlib
  cp "$at/zlib.h" "$at/zconf.h" "$prefix/include/"
  by_hand zlib libz.a "-DHAVE_UNISTD_H" adler32.c compress.c crc32.c deflate.c infback.c inffast.c inflate.c inftrees.c \
    trees.c uncompr.c zutil.c
}

png() {
  [[ -e $prefix/libpng1.6.done ]] && return
  source_of libpng1.6
  local at=$folder/sources/libpng1.6
  cp "$at/scripts/pnglibconf.h.prebuilt" "$at/pnglibconf.h"
  cp "$at/png.h" "$at/pngconf.h" "$at/pnglibconf.h" "$prefix/include/"
  by_hand libpng1.6 libpng.a "-I$prefix/include" png.c pngerror.c pngget.c pngmem.c pngpread.c pngread.c pngrio.c \
    pngrtran.c pngrutil.c pngset.c pngtrans.c pngwio.c pngwrite.c pngwtran.c pngwutil.c
}

# Its own script wants emscripten's tools in another place.
draco() {
  [[ -e $prefix/draco.done ]] && return
  source_of draco
  local at=$folder/sources/draco/src files
  (cd "$at" && find draco -name '*.h' -print0 | xargs -0 cp --parents -t "$prefix/include")
  grep -v TRANSCODER /usr/include/draco/draco_features.h >"$prefix/include/draco/draco_features.h"
  mapfile -t files < <(cd "$at" && find draco/{attributes,compression,core,mesh,metadata,point_cloud} \
    -name '*.cc' ! -name '*_test*' ! -path '*test*' | sort)
  by_hand draco/src libdraco.a "-std=c++17 -I$prefix/include" "${files[@]}"
}

# It draws from rand(), which orders a factor: glibc's, so that sums have the bits of a native build.
metis() {
  [[ -e $prefix/metis.done ]] && return
  source_of metis
  local at=$folder/sources/metis files
  cp "$at/include/metis.h" "$prefix/include/"
  cp "$here/glibc_rand.c" "$at/"
  mapfile -t files < <(cd "$at" && ls GKlib/*.c libmetis/*.c)
  by_hand metis libmetis.a "-include $here/glibc_rand.h -DLINUX -DNDEBUG2 -I include -I GKlib -I libmetis -D_POSIX_C_SOURCE=200809L -D_GNU_SOURCE" \
    glibc_rand.c "${files[@]}"
}

# Without its C interface, which takes as long to compile again.
exr() {
  [[ -e $prefix/openexr.done ]] && return
  target=OpenEXR by_cmake openexr -DOPENEXR_ENABLE_THREADING=OFF -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_TOOLS=OFF \
    -DOPENEXR_INSTALL_EXAMPLES=OFF -DOPENEXR_INSTALL_PKG_CONFIG=OFF -DZLIB_LIBRARY="$prefix/lib/libz.a" \
    -DZLIB_INCLUDE_DIR="$prefix/include"
  mkdir -p "$prefix/include/OpenEXR"
  find "$folder/build/openexr" -name '*.a' -exec cp -t "$prefix/lib" {} +
  cp "$folder"/sources/openexr/src/lib/{OpenEXR,Iex,IlmThread}/*.h "$folder"/build/openexr/cmake/*.h "$prefix/include/OpenEXR/"
  touch "$prefix/openexr.done"
}

headers
metis
zlib
png
# CMake does not read the sizes of types from a WebAssembly object.
by_cmake libjpeg-turbo -DWITH_SIMD=0 -DENABLE_SHARED=0 -DWITH_TURBOJPEG=0 -DHAVE_SIZE_T=1 -DSIZE_T=4 -DHAVE_UNSIGNED_LONG=1 \
  -DUNSIGNED_LONG=4
by_cmake imath -DIMATH_INSTALL_PKG_CONFIG=OFF
draco
exr
