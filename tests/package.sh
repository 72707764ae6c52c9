#!/usr/bin/env bash
# The installed package is all that the examples need: installs BUILD, builds EXAMPLES against it, runs what needs no
# display. Usage: package.sh BUILD EXAMPLES
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" >"$work/install.log" || { cat "$work/install.log"; exit 1; }

# A program may hold another version of tinygltf.
nm -C "$(find "$work/installed" -name libpliant_content.a)" | grep -E ' [TVW] tinygltf::' &&
  { echo "tinygltf is not under our own name"; exit 1; }

# Nothing but public headers, and none of them needs another's include or one that is not installed.
find "$work/installed/include" -name '*.h' | grep -v '/include/pliant/[a-z_]*\.h$' && { echo "not public"; exit 1; }
for header in "$work"/installed/include/pliant/*.h; do
  echo "#include <pliant/$(basename "$header")>" >"$work/one.cpp"
  c++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I "$work/installed/include" "$work/one.cpp"
  grep -nE '^#define [^P]' "$header" && { echo "$header: a macro without the prefix"; exit 1; }
done

cp -r "$2" "$work/examples"  # away from the sources
cmake -S "$work/examples" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/installed" \
  >"$work/configure.log" || { cat "$work/configure.log"; exit 1; }
cmake --build "$work/build" -j 2 >"$work/build.log" || { cat "$work/build.log"; exit 1; }

# Pictures by Pliant's own renderer: component `visual`.
mkdir "$work/picture"
cat >"$work/picture/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(picture LANGUAGES CXX)
find_package(pliant REQUIRED COMPONENTS engine visual)
add_executable(picture main.cpp)
target_link_libraries(picture PRIVATE pliant::picture)
TEXT
cat >"$work/picture/main.cpp" <<'TEXT'
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
cmake -S "$work/picture" -B "$work/picture/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/installed" \
  >"$work/configure.log" || { cat "$work/configure.log"; exit 1; }
cmake --build "$work/picture/build" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
said=$("$work/picture/build/picture")
echo "$said"
echo "$said" | grep -qE '^(9216 bytes|none: .*(EGL|OpenGL|graphics))' || { echo "a picture of 64 x 36 has 9216 bytes"; exit 1; }

# The drivers that ship: component `devices`.
mkdir "$work/drivers"
cat >"$work/drivers/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(drivers LANGUAGES CXX)
find_package(pliant REQUIRED COMPONENTS engine devices)
add_executable(drivers main.cpp)
target_link_libraries(drivers PRIVATE pliant::drivers pliant::engine)
TEXT
cat >"$work/drivers/main.cpp" <<'TEXT'
#include <pliant/driver.h>
#include <pliant/drivers.h>

#include <cstdio>

int main() {
  pliant::register_all_drivers();
  for (const std::string& name : pliant::driver_names()) std::printf("%s ", name.c_str());
  std::printf("\n");
}
TEXT
cmake -S "$work/drivers" -B "$work/drivers/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/installed" \
  >"$work/configure.log" || { cat "$work/configure.log"; exit 1; }
cmake --build "$work/drivers/build" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
said=$("$work/drivers/build/drivers")
echo "$said"
echo "$said" | grep -q 'falcon .*haply .*spacemouse' || { echo "a driver that ships is missing"; exit 1; }

# Touch alone drags in neither graphics nor readers of files.
libraries=$(ldd "$work/build/hello_touch")
echo "$libraries" | grep -E 'libGL|libEGL|epoxy|assimp|draco|OpenEXR|hidapi|glfw' && { echo "hello_touch needs too much"; exit 1; }

said=$("$work/build/hello_touch")
echo "$said"
echo "$said" | tail -1 | grep -q 'force 1.200 N' || { echo "300 N/m times 4 mm is 1.2 N"; exit 1; }
said=$("$work/build/own_device")
echo "$said"
echo "$said" | grep -q 'closed; the last force was 0.000 N' || { echo "the last force must be zero"; exit 1; }
said=$("$work/build/own_law")
echo "$said"
echo "$said" | grep -q 'softening  4.0 mm deep: 1.140 N' || { echo "300 N/m * 10 mm * tanh(0.4) is 1.140 N"; exit 1; }
said=$("$work/build/reset_loop")
echo "$said"
[[ $(echo "$said" | sed -n 2p) == "$(echo "$said" | sed -n 3p)" ]] || { echo "the same state and force must give the same"; exit 1; }
echo "$said" | grep -q '0.2 N: the cube went  0.0 mm; the table carries 0.98 N; beside it is `table`' || { echo "friction holds it"; exit 1; }
said=$("$work/build/headless_sweep" "$work/installed/share/pliant/content/levels/minimal.gltf" 2>&1)
[[ $(echo "$said" | wc -l) -gt 100 ]] || { echo "$said" | head; echo "the sweep is too short"; exit 1; }
if [[ -x $work/build/own_renderer ]] && command -v xvfb-run >/dev/null; then
  said=$(xvfb-run -a "$work/build/own_renderer" 40)
  echo "$said"
  echo "$said" | grep -qE 'largest force was (0\.[3-9]|1\.|2\.)' || { echo "it pressed by 12 mm"; exit 1; }
fi
