#!/usr/bin/env bash
# The installed package is sufficient for a program: installs BUILD, moves it, builds EXAMPLES and small projects with
# it, and runs those that need no display. Usage: package.sh BUILD EXAMPLES
set -euo pipefail
build=$1
source=$(dirname "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf '%s\n' "$*"; exit 1; }
cmake --install "$build" --prefix "$work/first" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
mv "$work/first" "$work/installed"  # it may be moved

# configure FOLDER ARGS...: a CMake project; its output is in $work/configure.log
configure() {
  local folder=$1
  shift
  cmake -S "$folder" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/installed" "$@" \
    >"$work/configure.log" 2>&1
}
# build FOLDER ARGS...: as configured
compile() {
  local folder=$1
  shift
  cmake --build "$folder/build" -j 2 "$@" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
}
# project NAME COMPONENTS: links main.cpp (from stdin) to each pliant::COMPONENT
project() {
  mkdir "$work/$1"
  cat >"$work/$1/main.cpp"
  {
    echo 'cmake_minimum_required(VERSION 3.25)'
    echo "project($1 LANGUAGES CXX)"
    echo "find_package(pliant REQUIRED COMPONENTS $2)"
    echo "add_executable($1 main.cpp)"
    for component in $2; do echo "target_link_libraries($1 PRIVATE pliant::$component)"; done
  } >"$work/$1/CMakeLists.txt"
  configure "$work/$1" || { cat "$work/configure.log"; exit 1; }
  compile "$work/$1"
}

# `./dev run` builds the command alone: that must be all that is installed.
inputs=$(ninja -C "$build" -t inputs pliant)
for library in "$work"/installed/lib/libpliant_*; do
  grep -q "$(basename "$library" | sed 's/\.so.*//; s/\.a$//')" <<<"$inputs" ||
    fail "$(basename "$library") is not built with the command, so that ./dev run leaves nothing to install"
done

# No file contains the build path, and no library is searched there.
for where in "$source" "$(realpath "$build")" "$work/first"; do
  if said=$(grep -rlaF -e "$where/" "$work/installed"); then fail "these name $where: $said"; fi
done
if readelf -d "$work/installed/bin/pliant" | grep -E 'R(UN)?PATH' | grep -v 'ORIGIN'; then fail "a fixed RPATH"; fi

# The command finds its levels and shaders from where it lies.
mkdir "$work/elsewhere"
(cd "$work/elsewhere" && env -u PLIANT_CONTENT -u PLIANT_SHADERS "$work/installed/bin/pliant" run minimal --seconds 0.1 --frames 1) \
  >"$work/run.log" 2>&1 || { cat "$work/run.log"; exit 1; }
find "$work/elsewhere" -name '*.png' | grep -q . || { cat "$work/run.log"; fail "there is no picture"; }

# A program may contain another version of tinygltf.
nm -C "$(find "$work/installed" -name 'libpliant_content.*' | head -1)" | grep -E ' [TVW] tinygltf::' &&
  fail "tinygltf is not under our own name"

# Only public headers; each compiles alone and includes only installed ones.
find "$work/installed/include" -name '*.h' | grep -vE '/include/pliant(\.h|/[a-z_]*\.h)$' && fail "not public"
check_header() { c++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I "$work/installed/include" "$work/one.cpp" "$@"; }
for header in "$work"/installed/include/pliant/*.h; do
  echo "#include <pliant/$(basename "$header")>" >"$work/one.cpp"
  check_header
  grep -nE '^#define [^P]' "$header" && fail "$header: a macro without the prefix"
done

# Another memory layout of glm is rejected with a sentence; settings that do not change it are accepted.
echo '#include <pliant/math.h>' >"$work/one.cpp"
for macros in -DGLM_FORCE_QUAT_DATA_WXYZ -DGLM_FORCE_QUAT_CTOR_XYZW -DGLM_FORCE_SINGLE_ONLY -DGLM_FORCE_CTOR_INIT \
    "-DGLM_FORCE_INTRINSICS -DGLM_FORCE_DEFAULT_ALIGNED_GENTYPES"; do
  if said=$(check_header $macros 2>&1); then fail "glm with $macros is not refused"; fi
  grep -q 'pliant: .*compile this file without' <<<"$said" || { echo "$said"; fail "glm with $macros: no sentence"; }
done
for macros in -DGLM_FORCE_LEFT_HANDED -DGLM_FORCE_DEPTH_ZERO_TO_ONE "-DGLM_FORCE_INTRINSICS -msse4.2"; do
  check_header $macros || fail "glm with $macros is refused"
done

echo '#include <pliant.h>' >"$work/one.c"
cc -std=c11 -Wall -Wextra -Werror -pedantic -fsyntax-only -I "$work/installed/include" "$work/one.c"

cp -r "$2" "$work/examples"  # away from the sources
configure "$work/examples" || { cat "$work/configure.log"; exit 1; }
compile "$work/examples"

# A component that is not known is named, and so is one that was not installed.
refused() {  # COMPONENTS SENTENCE
  mkdir -p "$work/wrong"
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES CXX)\nfind_package(pliant REQUIRED COMPONENTS %s)\n' "$1" \
    >"$work/wrong/CMakeLists.txt"
  if configure "$work/wrong"; then fail "components $1 are found"; fi
  tr -s ' \n' ' ' <"$work/configure.log" | grep -qE "$2" || { cat "$work/configure.log"; fail "no sentence: $2"; }
}
refused "engine viewer" 'no component .viewer.; its components are engine, content, visual, devices and c'
visual=$(find "$work/installed" -name pliant-visual-targets.cmake)
mv "$visual" "$work/kept"
refused visual 'installed without its component .visual'
mv "$work/kept" "$visual"

# Pictures by Pliant's own renderer: component `visual`. Its shaders are in it.
project picture "engine visual" <<'TEXT'
#include <pliant/picture.h>
#include <pliant/pliant.h>

#include <cstdio>

int main() {
  pliant::Scene scene;
  scene.add_surface("sheet", {.position = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, .index = {0, 1, 2}});
  auto session = pliant::Session::open(scene);
  auto pictures = session ? pliant::Pictures::headless(*session) : pliant::Result<pliant::Pictures>(session.error());
  if (!pictures) return std::printf("none: %s\n", pictures.error().message().c_str()), 0;
  std::printf("%zu bytes\n", pictures->picture(pictures->view(), 64, 36)->rgba.size());
}
TEXT
said=$("$work/picture/build/picture")
echo "$said"
echo "$said" | grep -qE '^(9216 bytes|none: .*(EGL|OpenGL|graphics))' || fail "a picture of 64 x 36 has 9216 bytes"

# A program in which every level is opened and every driver tried: it writes nothing and keeps its signal handlers.
project quiet "engine content devices" <<'TEXT'
#include <pliant/content.h>
#include <pliant/drivers.h>
#include <pliant/pliant.h>

#include <csignal>
#include <cstdio>
#include <cstring>

int main(int count, char** levels) {
  struct sigaction before[NSIG] = {}, now = {};
  for (int signal = 1; signal < NSIG; ++signal) sigaction(signal, nullptr, &before[signal]);
  pliant::register_all_drivers();
  std::string names;
  for (int i = 1; i < count; ++i) {
    auto scene = pliant::load_scene(levels[i]);
    auto session = scene ? pliant::Session::open(*scene) : pliant::Result<pliant::Session>(scene.error());
    if (!session) return std::printf("%s\n", session.error().message().c_str()), 1;
    for (const std::string& name : pliant::driver_names()) {
      if (i == 1) names += name + " ";
      if (session->effectors().empty() || i > 1) continue;
      const std::string effector = session->effectors().front();
      session->release(effector).ok();
      if (session->connect(effector, name)) session->step(5).ok();
    }
    if (auto stepped = session->step(20); !stepped) return std::printf("%s\n", stepped.error().message().c_str()), 1;
  }
  for (int signal = 1; signal < NSIG; ++signal)
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler != before[signal].sa_handler)
      return std::printf("the handler of signal %d has changed\n", signal), 1;
  if (std::FILE* out = std::fopen("names.txt", "w")) std::fputs(names.c_str(), out), std::fclose(out);
}
TEXT
levels=()
for level in minimal three_probes tool; do
  file=$(find "$work/installed/share/pliant/content/levels" -name "$level.gl*" | head -1)
  if [[ -n $file ]]; then levels+=("$file"); fi
done
(cd "$work/quiet" && ./build/quiet "${levels[@]}") >"$work/quiet.log" 2>&1 || { cat "$work/quiet.log"; exit 1; }
[[ ! -s $work/quiet.log ]] || { cat "$work/quiet.log"; fail "the library has written something"; }
cat "$work/quiet/names.txt"
grep -q 'falcon .*haply .*spacemouse' "$work/quiet/names.txt" || fail "a driver that ships is missing"

# A shared library of a program's own links to the static ones.
mkdir "$work/plugin"
cat >"$work/plugin/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(plugin LANGUAGES CXX)
find_package(pliant REQUIRED COMPONENTS engine)
add_library(plugin SHARED plugin.cpp)
target_link_libraries(plugin PRIVATE pliant::engine)
target_link_options(plugin PRIVATE -Wl,-z,defs)
TEXT
cat >"$work/plugin/plugin.cpp" <<'TEXT'
#include <pliant/pliant.h>
extern "C" int touch() { return static_cast<int>(pliant::Session::open(pliant::Scene()).ok()); }
TEXT
configure "$work/plugin" || { cat "$work/configure.log"; exit 1; }
compile "$work/plugin"

# Touch alone drags in neither graphics nor readers of files.
libraries=$(ldd "$work/examples/build/hello_touch")
echo "$libraries" | grep -E 'libGL|libEGL|epoxy|assimp|draco|OpenEXR|hidapi|glfw' && fail "hello_touch needs too much"

run=$work/examples/build
said=$("$run/hello_touch")
echo "$said"
echo "$said" | tail -1 | grep -q 'force 1.200 N' || fail "300 N/m times 4 mm is 1.2 N"
said=$("$run/effects")
echo "$said"
echo "$said" | grep -q 'magnet: finger -0.879 N, thumb 0.000 N' || fail "200 N/m * 5 mm * (1 - 1/16)^2 is 0.879 N"
echo "$said" | grep -q 'finger -1.758 N' || fail "twice the stiffness is twice the force"
echo "$said" | grep -q 'texture 0.0 mm: the force is 0.600 to 0.600 N' || fail "300 N/m times 2 mm is 0.6 N"
said=$("$run/own_device")
echo "$said"
echo "$said" | grep -q 'closed; the last force was 0.000 N' || fail "the last force must be zero"
said=$("$run/own_law")
echo "$said"
echo "$said" | grep -q 'softening  4.0 mm deep: 1.140 N' || fail "300 N/m * 10 mm * tanh(0.4) is 1.140 N"
said=$("$run/reset_loop")
echo "$said"
[[ $(echo "$said" | sed -n 2p) == "$(echo "$said" | sed -n 3p)" ]] || fail "the same state and force must give the same"
echo "$said" | grep -q '0.2 N: the cube went  0.0 mm; the table carries 0.98 N; beside it is `table`' || fail "friction holds it"
said=$("$run/headless_sweep" "$work/installed/share/pliant/content/levels/minimal.gltf" 2>&1)
[[ $(echo "$said" | wc -l) -gt 100 ]] || { echo "$said" | head; fail "the sweep is too short"; }
said=$("$run/hello_c" "$work/installed/share/pliant/content/levels/minimal.gltf")
echo "$said" | tail -1 | grep -q 'depth  5.00 mm  force 1.500 N' || { echo "$said"; fail "300 N/m times 5 mm is 1.5 N"; }
if [[ -x $run/own_renderer ]] && command -v xvfb-run >/dev/null; then
  said=$(xvfb-run -a "$run/own_renderer" 40)
  echo "$said"
  echo "$said" | grep -qE 'largest force was (0\.[3-9]|1\.|2\.)' || fail "it pressed by 12 mm"
fi
