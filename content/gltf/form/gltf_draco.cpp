#include "content/gltf/form/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <exception>

#include "content/files/isolation.h"

namespace pliant {

namespace {

// Draco allocates the sizes that a header claims. Beyond a first million elements, which cost little, no mesh has more
// than this many elements per byte.
constexpr std::uint64_t kFreeElements = 1 << 20, kElementsPerByte = 64;
// [byte] Limit for all blobs decoded in one process.
constexpr std::size_t kMostTogether = std::size_t{64} << 20;

// Reads counts from the header; the library reads the rest of the stream.
class HeaderReader {
 public:
  explicit HeaderReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint64_t byte() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
  std::uint64_t fixed(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value |= byte() << (8 * i);
    return value;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const std::uint64_t next = byte();
      value |= (next & 0x7f) << shift;
      if (!(next & 0x80)) break;
    }
    return value;
  }
  void skip(std::size_t count) { at_ += count; }
  std::span<const std::uint8_t> rest() const {
    return at_ < bytes_.size() ? bytes_.subspan(at_) : std::span<const std::uint8_t>{};
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void skip_metadata(HeaderReader& in, int depth) {
  if (depth > 8) return;
  for (std::uint64_t entries = in.varint(); entries > 0 && !in.rest().empty(); --entries) {
    in.skip(in.byte());
    in.skip(in.varint());
  }
  for (std::uint64_t children = in.varint(); children > 0 && !in.rest().empty(); --children) {
    in.skip(in.byte());
    skip_metadata(in, depth + 1);
  }
}

// The largest count of faces or points that the header claims. 0 if the header is not readable here; the library then
// rejects it too.
std::uint64_t claimed_elements(std::span<const std::uint8_t> blob) {
  HeaderReader in(blob);
  in.skip(5);
  const std::uint64_t major = in.byte(), minor = in.byte(), version = major << 8 | minor;
  const std::uint64_t is_mesh = in.byte(), method = in.byte(), flags = in.fixed(2);
  if (version >= 0x0103 && (flags & 0x8000)) {
    for (std::uint64_t attributes = in.varint(); attributes > 0 && !in.rest().empty(); --attributes) {
      in.varint();
      skip_metadata(in, 0);
    }
    skip_metadata(in, 0);
  }
  if (is_mesh == 0) return in.fixed(4);
  const bool sequential = method == 0;
  // Counts have variable length since 2.2 for sequential streams, since 2.0 for edgebreaker.
  const auto count = [&] { return version < (sequential ? 0x0202 : 0x0200) ? in.fixed(4) : in.varint(); };
  if (!sequential) in.byte();                    // edgebreaker's traversal method
  if (!sequential && version < 0x0202) count();  // vertices added by splits
  const std::uint64_t first = count();
  return std::max(first, count());
}

Error refuse(const std::string& what) {
  return Error{"Draco data", what, "compress the mesh again"};
}

// Decodes a mesh and checks that every index is in range.
Result<std::unique_ptr<draco::Mesh>> decode_mesh(std::span<const std::uint8_t> blob) {
  if (blob.size() < 11 || std::memcmp(blob.data(), "DRACO", 5) != 0)
    return refuse("does not begin as a Draco stream does");
  const std::uint64_t claimed = claimed_elements(blob);
  if (claimed > kFreeElements + kElementsPerByte * blob.size())
    return refuse(fmt::format("claims {} elements in {} bytes", claimed, blob.size()));
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(blob.data()), blob.size());
    const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok()) return refuse(std::string("cannot be read: ") + type.status().error_msg());
    if (type.value() != draco::TRIANGULAR_MESH)
      return Error{"Draco data", "is a point cloud, which has no surface to touch", "use a triangle mesh"};
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return refuse(std::string("cannot be decoded: ") + decoded.status().error_msg());
    std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    // Integers are kept as stored; the glTF accessor defines whether they are normalised.
    for (int i = 0; i < mesh->num_attributes(); ++i) mesh->attribute(i)->set_normalized(false);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
      for (const draco::PointIndex& point : mesh->face(f))
        if (point.value() >= mesh->num_points()) return refuse("has a triangle with a vertex that does not exist");
    return mesh;
  } catch (const std::exception& e) {
    return refuse(std::string("cannot be decoded: ") + e.what());
  }
}

Result<DracoAttribute> read_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  DracoAttribute out;
  out.id = attribute.unique_id();
  out.width = static_cast<std::size_t>(attribute.num_components());
  if (out.width == 0 || out.width > 4) return refuse("has an attribute of more than four components");
  out.values.resize(mesh.num_points() * out.width);
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex value = attribute.mapped_index(p);
    if (value.value() >= attribute.size()) return refuse("has a vertex whose attribute does not exist");
    float row[4] = {};
    if (!attribute.ConvertValue<float>(value, static_cast<std::int8_t>(out.width), row))
      return refuse("has an attribute that cannot be read as numbers");
    std::memcpy(&out.values[p.value() * out.width], row, out.width * sizeof(float));
  }
  return out;
}

DracoMesh read_faces(const draco::Mesh& mesh) {
  DracoMesh out;
  out.vertices = mesh.num_points();
  out.index.reserve(mesh.num_faces() * std::size_t{3});
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& point : mesh.face(f)) out.index.push_back(point.value());
  return out;
}

draco::GeometryAttribute::Type type_of(const std::string& name) {
  if (name == "POSITION") return draco::GeometryAttribute::POSITION;
  if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
  if (name.rfind("TEXCOORD_", 0) == 0) return draco::GeometryAttribute::TEX_COORD;
  if (name.rfind("COLOR_", 0) == 0) return draco::GeometryAttribute::COLOR;
  return draco::GeometryAttribute::GENERIC;
}

// Adds an attribute with one value per vertex, stored as T.
template <class T>
std::uint32_t add_attribute(draco::Mesh& mesh, const DracoAttribute& in, draco::DataType type, std::size_t vertices) {
  draco::GeometryAttribute header;
  header.Init(type_of(in.name), nullptr, static_cast<std::int8_t>(in.width), type, false,
              static_cast<std::int64_t>(sizeof(T) * in.width), 0);
  const int id = mesh.AddAttribute(header, true, static_cast<draco::AttributeValueIndex::ValueType>(vertices));
  std::vector<T> row(in.width);
  for (std::size_t v = 0; v < vertices; ++v) {
    for (std::size_t c = 0; c < in.width; ++c) row[c] = static_cast<T>(in.values[v * in.width + c]);
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<std::uint32_t>(v)), row.data());
  }
  return mesh.attribute(id)->unique_id();
}

// Serialises the child's result, and reads it back.
Bytes pack(const DracoMesh& mesh) {
  Bytes out;
  const std::uint64_t sizes[3] = {mesh.vertices, mesh.index.size(), mesh.attributes.size()};
  append_bytes(out, sizes, sizeof sizes);
  append_bytes(out, mesh.index.data(), mesh.index.size() * sizeof(std::uint32_t));
  for (const DracoAttribute& each : mesh.attributes) {
    const std::uint64_t header[3] = {each.id, each.width, each.name.size()};
    append_bytes(out, header, sizeof header);
    append_bytes(out, each.name.data(), each.name.size());
    append_bytes(out, each.values.data(), each.values.size() * sizeof(float));
  }
  return out;
}
Result<DracoMesh> unpack(Taker& in) {
  DracoMesh out;
  std::uint64_t sizes[3];
  bool good = in.take(sizes, sizeof sizes);
  if (good) {
    out.vertices = sizes[0];
    out.index.resize(sizes[1]);
    good = in.take(out.index.data(), sizes[1] * sizeof(std::uint32_t));
  }
  for (std::uint64_t i = 0; good && i < sizes[2]; ++i) {
    DracoAttribute attribute;
    std::uint64_t header[3];
    good = in.take(header, sizeof header) && header[2] < 64;
    if (!good) break;
    attribute.name.resize(header[2]);
    good = in.take(attribute.name.data(), header[2]);
    attribute.id = static_cast<std::uint32_t>(header[0]);
    attribute.width = header[1];
    attribute.values.resize(out.vertices * attribute.width);
    good = good && in.take(attribute.values.data(), attribute.values.size() * sizeof(float));
    out.attributes.push_back(std::move(attribute));
  }
  if (!good) return refuse("was not decoded to its end");
  return out;
}

using NamedAttributes = std::vector<std::pair<std::string, const draco::PointAttribute*>>;

// Decodes the attributes that `wanted(mesh)` returns.
template <class Wanted>
Result<DracoMesh> decode_here(std::span<const std::uint8_t> blob, const Wanted& wanted) {
  const Result<std::unique_ptr<draco::Mesh>> mesh = decode_mesh(blob);
  if (!mesh) return mesh.error();
  DracoMesh out = read_faces(**mesh);
  const Result<NamedAttributes> attributes = wanted(**mesh);
  if (!attributes) return attributes.error();
  for (const auto& [name, attribute] : *attributes) {
    Result<DracoAttribute> values = read_attribute(**mesh, *attribute);
    if (!values) return values.error();
    values->name = name;
    out.attributes.push_back(std::move(*values));
  }
  return out;
}

Error in_draco(const Error& error) {
  return error.where.empty() ? error.at("Draco data") : error;
}

Result<NamedAttributes> with_ids(const draco::Mesh& mesh, const std::vector<std::uint32_t>& ids) {
  NamedAttributes attributes;
  for (const std::uint32_t id : ids) {
    attributes.emplace_back("", mesh.GetAttributeByUniqueId(id));
    if (!attributes.back().second) return refuse(fmt::format("has no attribute {}, which the primitive names", id));
  }
  return attributes;
}

}  // namespace

Result<std::vector<DracoMesh>> decode_draco(const std::vector<DracoBlob>& blobs, double seconds, double* used) {
  std::size_t size = 0;
  for (const DracoBlob& each : blobs) size += each.bytes.size();
  const auto work = [&]() -> Result<Bytes> {
    Bytes out;
    for (const DracoBlob& each : blobs) {
      const Result<DracoMesh> mesh =
          decode_here(each.bytes, [&](const draco::Mesh& decoded) { return with_ids(decoded, each.ids); });
      if (!mesh) return mesh.error();
      const Bytes packed = pack(*mesh);
      append_bytes(out, packed.data(), packed.size());
      if (blobs.size() > 1 && out.size() > kMostTogether) return refuse("is too much for one process");
    }
    return out;
  };
  const Result<Bytes> packed = in_isolation(size, work, seconds, 0.0, used);
  if (!packed) return in_draco(packed.error());
  Taker in(*packed);
  std::vector<DracoMesh> meshes;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    Result<DracoMesh> mesh = unpack(in);
    if (!mesh) return mesh.error();
    meshes.push_back(std::move(*mesh));
  }
  return meshes;
}

Result<DracoMesh> decode_draco(std::span<const std::uint8_t> blob, const std::vector<std::uint32_t>& ids,
                               double seconds, double* used) {
  Result<std::vector<DracoMesh>> meshes = decode_draco({{blob, ids}}, seconds, used);
  if (!meshes) return meshes.error();
  return std::move(meshes->front());
}

Result<DracoMesh> decode_draco_file(std::span<const std::uint8_t> blob) {
  const auto wanted = [](const draco::Mesh& mesh) -> Result<NamedAttributes> {
    using Kind = draco::GeometryAttribute;
    NamedAttributes attributes;
    for (const auto& [name, kind] : {std::pair{"POSITION", Kind::POSITION}, std::pair{"NORMAL", Kind::NORMAL},
                                     std::pair{"TEXCOORD_0", Kind::TEX_COORD}})
      if (const draco::PointAttribute* attribute = mesh.GetNamedAttribute(kind))
        attributes.emplace_back(name, attribute);
    return attributes;
  };
  const Result<Bytes> packed = in_isolation(blob.size(), [&]() -> Result<Bytes> {
    const Result<DracoMesh> mesh = decode_here(blob, wanted);
    if (!mesh) return mesh.error();
    return pack(*mesh);
  });
  if (!packed) return in_draco(packed.error());
  Taker in(*packed);
  return unpack(in);
}

Result<Bytes> encode_draco(DracoMesh& in, int bits) {
  try {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(in.vertices));
    mesh.SetNumFaces(in.index.size() / 3);
    for (std::uint32_t f = 0; f < in.index.size() / 3; ++f)
      mesh.SetFace(draco::FaceIndex(f), {draco::PointIndex(in.index[3 * f]), draco::PointIndex(in.index[3 * f + 1]),
                                         draco::PointIndex(in.index[3 * f + 2])});
    draco::Encoder encoder;
    for (DracoAttribute& each : in.attributes)
      each.id = each.integer ? add_attribute<std::uint16_t>(mesh, each, draco::DT_UINT16, in.vertices)
                             : add_attribute<float>(mesh, each, draco::DT_FLOAT32, in.vertices);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 12);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::COLOR, 10);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::GENERIC, 16);
    encoder.SetSpeedOptions(3, 3);
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
    if (!status.ok())
      return Error{"Draco", std::string("could not compress the mesh: ") + status.error_msg(),
                   "save it without --draco"};
    in.vertices = encoder.num_encoded_points();
    in.index.resize(encoder.num_encoded_faces() * 3);
    return Bytes(buffer.data(), buffer.data() + buffer.size());
  } catch (const std::exception& e) {
    return Error{"Draco", std::string("could not compress the mesh: ") + e.what(), "save it without --draco"};
  }
}

}  // namespace pliant
