#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <cmath>
#include <utility>

#include "content/files/isolation.h"
#include "content/files/mesh_import.h"
#include "content/gltf/form/gltf_document.h"
#include "content/gltf/write/gltf_save.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

// Names in files are arbitrary bytes; names in a Level are UTF-8.
std::string utf8(const std::string& bytes) {
  return Json::parse(Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

// Records Assimp's warnings about indices that it clamps or drops. It reports them in words and nothing else.
class IndexComplaints : public Assimp::LogStream {
 public:
  void write(const char* message) override {
    std::string text(message);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char* phrase : {"vertex index", "triangle index", "face index is out of range", "index overflow",
                               "index out of range", "out-of-range indices", "unexpected eof", "end of file"})
      if (any_.empty() && text.find(phrase) != std::string::npos && text.find("material") == std::string::npos)
        any_ = utf8(std::string(message).substr(0, 200));
  }
  std::string take() { return std::exchange(any_, {}); }

 private:
  std::string any_;
};

// Gives Assimp the bytes that were read instead of the file that it opens. Some formats name other files. These are
// read from the disk, within the folders that a level may reach.
class GivenFile : public Assimp::DefaultIOSystem {
 public:
  GivenFile(const fs::path& file, const Bytes& bytes)
      : file_(file.string()), folder_(file.parent_path()), bytes_(bytes) {}
  bool Exists(const char* name) const override { return allows(name) && DefaultIOSystem::Exists(name); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (name == file_) return new Assimp::MemoryIOStream(bytes_.data(), bytes_.size());
    return allows(name) && mode[0] == 'r' ? DefaultIOSystem::Open(name, mode) : nullptr;
  }

 private:
  bool allows(const std::string& name) const {
    if (name == file_) return true;  // the file that the user named
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(folder_.empty() ? fs::path(".") : folder_, error);
    const Result<fs::path> path = confined_file(folder_, fs::weakly_canonical(name, error).lexically_relative(folder));
    return path && fs::is_regular_file(*path, error);
  }
  const std::string file_;
  const fs::path folder_;
  const Bytes& bytes_;
};

// One per process, because Assimp's logger is global.
IndexComplaints& listen_to_assimp() {
  static IndexComplaints* complaints = nullptr;
  if (!complaints) {
    complaints = new IndexComplaints;  // owned by the logger from here on
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(complaints, Assimp::Logger::Err | Assimp::Logger::Warn);
  }
  complaints->take();
  return *complaints;
}

LocalTransform decompose(const aiMatrix4x4& m) {
  aiVector3D scale, position;
  aiQuaternion rotation;
  m.Decompose(scale, rotation, position);
  LocalTransform out;
  out.translation = vec3(position.x, position.y, position.z);
  out.rotation = glm::normalize(quat(rotation.w, rotation.x, rotation.y, rotation.z));
  out.scale = vec3(scale.x, scale.y, scale.z);
  return out;
}

bool finite(const LocalTransform& local) {
  const float sum = dot(local.translation, vec3(1)) + dot(local.scale, vec3(1)) + local.rotation.w + local.rotation.x +
                    local.rotation.y + local.rotation.z;
  return std::isfinite(sum);
}

Result<Primitive> read_primitive(const aiMesh& mesh) {
  Primitive out;
  out.material = static_cast<std::int32_t>(mesh.mMaterialIndex);
  out.position.reserve(mesh.mNumVertices);
  const bool has_normals = mesh.HasNormals(), has_uv = mesh.HasTextureCoords(0);
  bool sound_normals = has_normals;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return Error{"", fmt::format("has a position that is not a finite number, vertex {}", v), "repair the mesh"};
    out.position.emplace_back(p.x, p.y, p.z);
    if (has_normals) {
      const aiVector3D& n = mesh.mNormals[v];
      const float size = length(vec3(n.x, n.y, n.z));
      sound_normals &= std::isfinite(size) && size > 0.0f;
      out.normal.push_back(vec3(n.x, n.y, n.z) / size);
    }
    if (has_uv) {
      const aiVector3D& t = mesh.mTextureCoords[0][v];
      // In glTF, v points down.
      out.uv.emplace_back(std::isfinite(t.x) ? t.x : 0.0f, std::isfinite(t.y) ? 1.0f - t.y : 0.0f);
    }
  }
  if (!sound_normals) out.normal.clear();  // recomputed at spawn
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    for (unsigned i = 0; i < 3; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices)
        return Error{"", "has a triangle with a vertex that does not exist", "export it again"};
      out.index.push_back(face.mIndices[i]);
    }
  }
  return out;
}

Material read_material(const aiMaterial& in, std::string& texture_name) {
  Material out;
  aiString name, texture;
  aiColor4D color;
  if (in.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) out.name = name.C_Str();
  if (in.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS)
    out.base_color = glm::clamp(vec4(color.r, color.g, color.b, 1.0f), 0.0f, 1.0f);
  float opacity = 1.0f;
  if (in.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 1.0f && opacity >= 0.0f) {
    out.base_color.a = opacity;
    out.alpha = Material::Alpha::kBlend;
  }
  if (glm::any(glm::isnan(out.base_color))) out.base_color = vec4(1);
  out.name = utf8(out.name);
  if (in.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == AI_SUCCESS) texture_name = utf8(texture.C_Str());
  return out;
}

// Makes one Level node per scene node; its meshes become the primitives of one Level mesh.
Status read_nodes(const aiScene& scene, Level& level) {
  struct Visit {
    const aiNode* node;
    std::int32_t parent;
  };
  std::vector<Visit> stack{{scene.mRootNode, -1}};
  std::uint64_t vertices = 0;
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (level.nodes.size() >= most(limits::kElements))
      return error_at("", beyond("has", limits::kElements, static_cast<double>(level.nodes.size() + 1), "simplify it"));
    const std::int32_t here = static_cast<std::int32_t>(level.nodes.size());
    LevelNode node;
    node.parent = visit.parent;
    node.name = visit.node->mName.length > 0 ? utf8(visit.node->mName.C_Str()) : fmt::format("node_{}", here);
    node.local = decompose(visit.node->mTransformation);
    if (!finite(node.local)) return Error{"", "has a transformation that is not finite", "repair the file"};
    if (visit.node->mNumMeshes > 0) {
      LevelMesh mesh;
      mesh.name = node.name;
      for (unsigned m = 0; m < visit.node->mNumMeshes; ++m) {
        const unsigned which = visit.node->mMeshes[m];
        if (which >= scene.mNumMeshes) return Error{"", "refers to a mesh that it does not have", "export it again"};
        Result<Primitive> primitive = read_primitive(*scene.mMeshes[which]);
        if (!primitive) return primitive.error();
        if (primitive->index.empty()) continue;
        vertices += primitive->position.size();
        if (vertices > (1u << 26)) return Error{"", "has more than 67 million vertices", "split it"};
        mesh.primitives.push_back(std::move(*primitive));
      }
      if (!mesh.primitives.empty()) {
        node.mesh = static_cast<std::int32_t>(level.meshes.size());
        level.meshes.push_back(std::move(mesh));
      }
    }
    level.nodes.push_back(std::move(node));
    if (visit.parent >= 0) level.nodes[static_cast<std::size_t>(visit.parent)].children.push_back(here);
    for (unsigned c = visit.node->mNumChildren; c-- > 0;) stack.push_back({visit.node->mChildren[c], here});
  }
  return Done{};
}

// Runs in the child process. Returns the scene as GLB, after a header with each material's texture.
Result<Bytes> import_scene(const fs::path& path, const Bytes& bytes, const std::string& extension) {
  IndexComplaints& complaints = listen_to_assimp();
  Assimp::Importer importer;
  // Keeps only what is read below; drops skeletons, animations, lights and cameras.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_ANIMATIONS | aiComponent_BONEWEIGHTS |
                                                          aiComponent_CAMERAS | aiComponent_LIGHTS |
                                                          aiComponent_COLORS | aiComponent_TEXTURES);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const unsigned steps =
      aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType | aiProcess_RemoveComponent;
  if (!path.empty()) importer.SetIOHandler(new GivenFile(path, bytes));  // owned by the importer from here on
  const std::string format = extension.empty() ? "" : extension.substr(1);
  const aiScene* scene = path.empty() ? importer.ReadFileFromMemory(bytes.data(), bytes.size(), steps, format.c_str())
                                      : importer.ReadFile(path.string(), steps);
  if (!scene || !scene->mRootNode) {
    std::string why = importer.GetErrorString();
    std::replace(why.begin(), why.end(), '\n', ' ');
    return Error{"", "cannot be read: " + (why.empty() ? "unknown format" : utf8(why.substr(0, 200))),
                 "export it again, or as glTF"};
  }
  if (const std::string said = complaints.take(); !said.empty())
    return Error{"", "has a fault that would change its shape (" + said + ")", "export it again"};
  Level level;
  Json textures = Json::array();
  for (unsigned m = 0; m < scene->mNumMaterials; ++m) {
    std::string texture;
    level.materials.push_back(read_material(*scene->mMaterials[m], texture));
    textures.push_back(texture);
  }
  if (const Status status = read_nodes(*scene, level); !status) return status.error();
  for (LevelMesh& mesh : level.meshes)
    for (Primitive& primitive : mesh.primitives)
      if (primitive.material >= static_cast<std::int32_t>(level.materials.size())) primitive.material = -1;
  if (level.meshes.empty()) return Error{"", "has no triangles", "a point cloud or an empty mesh cannot be touched"};
  const Result<Bytes> glb = level_as_glb(level);
  if (!glb) return glb.error();
  const std::string header = textures.dump();
  const std::uint64_t size = header.size();
  Bytes out;
  append_bytes(out, &size, sizeof size);
  append_bytes(out, header.data(), size);
  append_bytes(out, glb->data(), glb->size());
  return out;
}

// Runs in the parent process. The child's answer is checked like any other file.
Result<Level> receive(const Bytes& answer, const fs::path& folder) {
  Taker in(answer);
  std::uint64_t size = 0;
  std::string header;
  if (!in.take(&size, sizeof size) || size > in.rest().size())
    return Error{"", "was not imported to its end", "try again"};
  header.resize(size);
  in.take(header.data(), size);
  Result<Level> level = load_gltf(in.rest(), true, {});
  if (!level) return level;
  level->source.reset();  // the GLB was only the transfer format
  add_textures(Json::parse(header).get<std::vector<std::string>>(), folder, *level);
  return level;
}

}  // namespace

Result<Level> import_by_assimp(const Bytes& bytes, const std::string& extension) {
  const Result<Bytes> answer = import_scene({}, bytes, extension);
  if (!answer) return answer.error();
  return receive(*answer, "/nonexistent");
}

Result<Level> import_by_assimp(const fs::path& path, const Bytes& bytes, const std::string& extension) {
  const Result<Bytes> answer = in_isolation(bytes.size(), [&] { return import_scene(path, bytes, extension); });
  if (!answer) return answer.error();
  return receive(*answer, path.parent_path());
}

}  // namespace pliant
