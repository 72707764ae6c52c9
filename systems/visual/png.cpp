#include "systems/visual/png.h"

#include <stb_image_write.h>

#include <cstdio>
#include <system_error>

namespace pliant {

Status write_png(const Image& image, const std::filesystem::path& path) {
  if (image.rgba.empty() || image.rgba.size() != std::size_t{4} * image.width * image.height)
    return Error{path.string(), "there is no picture to write; its size and its pixels do not agree"};
  std::filesystem::path aside = path;
  aside += ".part";
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  if (!stbi_write_png(aside.c_str(), width, height, 4, image.rgba.data(), 4 * width))
    return Error{path.string(), "cannot be written",
                 "check that the folder exists, that it is yours and that it has room"};
  std::error_code failed;
  std::filesystem::rename(aside, path, failed);
  if (!failed) return Done{};
  std::remove(aside.c_str());
  return Error{path.string(), "cannot be replaced (" + failed.message() + ")", "remove what is there"};
}

}  // namespace pliant
