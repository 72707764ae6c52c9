#include "content/files/mesh_check.h"

namespace pliant {

Result<MeshFile> check_mesh_file(Bytes bytes, const std::string& format) {
  MeshFile file{std::move(bytes), format, true};
  Status status = Done{};
  if (format == "off") {
    Result<Bytes> ply = off_as_ply(file.bytes);
    if (!ply) return ply.error();
    file.bytes = std::move(*ply);
    file.format = "ply";
  } else if (format == "ply") {
    status = check_ply(file.bytes);
  } else if (format == "stl") {
    status = check_stl(file.bytes);
  } else {
    file.in_memory = false;
    if (format == "obj") status = check_obj(file.bytes);
  }
  if (!status) return status.error();
  return file;
}

}  // namespace pliant
