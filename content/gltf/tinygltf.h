// tinygltf without file access and picture codecs, and under a namespace of its own: a program that uses Pliant may
// hold another version of it, and two of one name would mix without a word from the linker.
#pragma once

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf pliant_tinygltf
#include <tiny_gltf.h>
#undef tinygltf

namespace pliant {
namespace tinygltf = ::pliant_tinygltf;
}
