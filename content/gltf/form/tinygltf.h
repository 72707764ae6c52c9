// tinygltf without file access and picture codecs, in its own namespace. A program that uses Pliant may contain another
// version of it. Two versions under one name would violate the one-definition rule without a linker error.
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
