// OBJ: lines of a key and its values; a backslash at the end continues the line. Vertices are counted from 1, or
// backwards from the last one. `o` and `g` begin a node, `usemtl` another primitive of it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "content/files/mesh_reader.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

constexpr const char* kNames[] = {"vertex", "texture coordinate", "normal"};
constexpr const char *kFirstMaterial = "DefaultMaterial", *kFirstObject = "defaultobject";

// The words of one line of either file, and its text behind the key.
struct ObjLine {
  std::vector<std::string_view> words;
  // From the first word behind the key to the last one: a name may hold blanks.
  std::string rest() const {
    if (words.size() < 2) return {};
    return {words[1].data(), static_cast<std::size_t>(words.back().data() + words.back().size() - words[1].data())};
  }
};

// Reads lines, joined with those that continue them.
class ObjLines {
 public:
  explicit ObjLines(const Bytes& bytes) : text_(bytes, "") {}
  bool next(ObjLine& out) {
    out.words.clear();
    joined_.clear();
    std::string_view line;
    bool more = true, any = false;
    while (more && text_.line(line)) {
      number_ = ++lines_;
      more = !line.empty() && line.back() == '\\';
      if (more) line.remove_suffix(1);
      any = true;
      joined_.append(line.substr(0, line.find('#'))).append(" ");
    }
    TetText rest({reinterpret_cast<const std::uint8_t*>(joined_.data()), joined_.size()}, "");
    for (std::string_view word; rest.word(word);) out.words.push_back(word);
    return any;
  }
  std::size_t number() const { return number_; }

 private:
  TetText text_;
  std::string joined_;
  std::size_t lines_ = 0, number_ = 0;
};

float number_or_nan(std::string_view word) {
  double value = NAN;
  return to_number(word, value) ? static_cast<float>(value) : NAN;
}

Material grey(const std::string& name) {
  Material material;
  material.name = name;
  material.base_color = vec4(0.6f, 0.6f, 0.6f, 1.0f);
  return material;
}

class ObjReader {
 public:
  ObjReader(const Bytes& bytes, const OpenBeside& open) : lines_(bytes), open_(open) { material_of(kFirstMaterial); }

  Status all() {
    bool curve = false;  // free-form geometry, from `cstype` to `end`: ignored
    while (lines_.next(line_)) {
      if (line_.words.empty()) continue;
      const std::string_view key = line_.words[0];
      if (curve || key == "cstype") {
        curve = key != "end";
        continue;
      }
      Status status = Done{};
      if (key == "v") status = vertex();
      if (key == "vt") out.uv.emplace_back(value(1), line_.words.size() > 2 ? value(2) : 0.0f);
      if (key == "vn") out.normal.emplace_back(value(1), value(2), value(3));
      if (key == "f") status = face();
      if (key == "o" && line_.words.size() > 1) object(line_.rest());
      if (key == "g") group(line_.rest());
      if (key == "usemtl" && line_.words.size() > 1) use(line_.rest());
      if (key == "mtllib" && line_.words.size() > 1) read_materials(line_.rest());
      if (!status) return status;
      // Each takes far more memory than its line.
      if (const std::size_t most_of_either = std::max(out.objects.size(), out.materials.size());
          most_of_either > most(limits::kElements))
        return error_at("", beyond("has", limits::kElements, static_cast<double>(most_of_either), "simplify it"));
    }
    // A face may refer to vertices defined later, so the check comes at the end of the file.
    const std::size_t count[] = {out.position.size(), out.uv.size(), out.normal.size()};
    for (std::size_t i = 0; i < 3; ++i)
      if (largest_[i] > static_cast<std::int64_t>(count[i]))
        return error_in(largest_at_[i], fmt::format("names {} {} of {}", kNames[i], largest_[i], count[i]));
    return Done{};
  }

  MeshContent out;

 private:
  static Error error_in(std::size_t line, const std::string& what) {
    return {fmt::format("line {}", line), what, "export it again"};
  }
  Error at(const std::string& what) const { return error_in(lines_.number(), what); }
  float value(std::size_t word) const { return word < line_.words.size() ? number_or_nan(line_.words[word]) : NAN; }

  Status vertex() {
    const std::size_t numbers = line_.words.size() - 1;
    if (numbers != 3 && numbers != 4 && numbers != 6)
      return at(fmt::format("has {} numbers for a vertex; x y z, w or a colour are read", numbers));
    for (std::size_t i = 1; i <= numbers; ++i)
      if (!std::isfinite(value(i))) return at("has something else than a finite number for a vertex");
    const vec3 place = vec3(value(1), value(2), value(3)) / (numbers == 4 ? value(4) : 1.0f);
    if (!std::isfinite(place.x + place.y + place.z)) return at("has a vertex at infinity");
    out.position.push_back(place);
    return Done{};
  }

  Status face() {
    if (line_.words.size() < 4) return at("has a face of fewer than three corners");
    if (out.objects.empty()) begin(kFirstObject);
    FaceList& faces = out.objects[object_].lists.back();
    for (std::size_t c = 1; c < line_.words.size(); ++c) {
      FaceCorner& corner = faces.corners.emplace_back();
      if (const Status status = read_corner(line_.words[c], corner); !status) return status;
    }
    faces.sizes.push_back(static_cast<std::uint32_t>(line_.words.size() - 1));
    return Done{};
  }

  // v, v/vt, v//vn or v/vt/vn
  Status read_corner(std::string_view word, FaceCorner& corner) {
    const std::string_view whole = word.substr(0, 40);
    const std::int64_t count[] = {static_cast<std::int64_t>(out.position.size()),
                                  static_cast<std::int64_t>(out.uv.size()),
                                  static_cast<std::int64_t>(out.normal.size())};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t slash = word.find('/');
      const std::string_view part = word.substr(0, slash);
      std::int64_t index = 0;
      if (i == 0 || !part.empty()) {
        if (!to_integer(part, index) || index == 0 || index > INT32_MAX)
          return at(fmt::format("has the corner '{}' in a face", whole));
        if (index < -count[i]) return at(fmt::format("names {} {} with {} before it", kNames[i], index, count[i]));
        if (index < 0) index += count[i] + 1;
        if (index > largest_[i]) {
          largest_[i] = index;
          largest_at_[i] = lines_.number();
        }
        const auto from_zero = static_cast<std::int32_t>(index - 1);
        if (i == 0) corner.position = static_cast<std::uint32_t>(from_zero);
        if (i == 1) corner.uv = from_zero;
        if (i == 2) corner.normal = from_zero;
      }
      if (slash == std::string_view::npos) return Done{};
      word.remove_prefix(slash + 1);
    }
    return at(fmt::format("has the corner '{}' in a face", whole));
  }

  void begin(const std::string& name) {
    object_ = out.objects.size();
    first_.try_emplace(name, object_);
    out.objects.push_back({name, {FaceList{material_, {}, {}}}});
  }
  // The same name again goes on with that object.
  void object(const std::string& name) {
    const auto before = first_.find(name);
    if (before == first_.end()) return begin(name);
    object_ = before->second;
    use(out.materials[material_].name);
  }
  void group(const std::string& name) {
    if (name == group_ && !out.objects.empty()) return;
    begin(name);
    group_ = name;
  }

  std::uint32_t material_of(const std::string& name) {
    const auto [place, is_new] = known_.try_emplace(name, static_cast<std::uint32_t>(out.materials.size()));
    if (is_new) {
      out.materials.push_back(grey(name));
      out.textures.emplace_back();
    }
    return place->second;
  }
  void use(const std::string& name) {
    material_ = material_of(name);
    if (out.objects.empty()) return;
    std::vector<FaceList>& lists = out.objects[object_].lists;
    if (lists.back().sizes.empty())
      lists.back().material = material_;
    else if (lists.back().material != material_)
      lists.push_back({material_, {}, {}});
  }

  // A library that is not there leaves its materials grey.
  void read_materials(const std::string& name) {
    const std::optional<Bytes> bytes = open_(name);
    if (!bytes) return;
    ObjLines lines(*bytes);
    ObjLine line;
    std::optional<std::uint32_t> now;
    while (lines.next(line)) {
      if (line.words.size() < 2) continue;
      const std::string_view key = line.words[0];
      const auto number = [&](std::size_t i) { return i < line.words.size() ? number_or_nan(line.words[i]) : 0.0f; };
      if (key == "newmtl") now = material_of(line.rest());
      if (!now) continue;
      Material& material = out.materials[*now];
      if (key == "Kd") {
        const vec3 color(number(1), number(2), number(3));
        if (std::isfinite(color.x + color.y + color.z))
          material.base_color = vec4(glm::clamp(color, 0.0f, 1.0f), material.base_color.a);
      }
      if (key == "d" || key == "Tr") {
        const float opacity = key == "d" ? number(1) : 1.0f - number(1);
        if (opacity >= 0.0f && opacity < 1.0f) {
          material.base_color.a = opacity;
          material.alpha = Material::Alpha::kBlend;
        }
      }
      if (key == "map_Kd") out.textures[*now] = picture_of(line);
    }
  }
  // The file's name behind the options of a map.
  static std::string picture_of(const ObjLine& line) {
    constexpr std::pair<std::string_view, std::size_t> kOptions[] = {
        {"-blendu", 1}, {"-blendv", 1}, {"-bm", 1}, {"-boost", 1}, {"-clamp", 1}, {"-imfchan", 1},
        {"-mm", 2},     {"-o", 3},      {"-s", 3},  {"-t", 3},     {"-type", 1},  {"-texres", 1}};
    ObjLine left = line;
    for (bool any = true; any && left.words.size() > 2;) {
      any = false;
      for (const auto& [option, values] : kOptions)
        if (!any && left.words[1] == option && left.words.size() > values + 2) {
          left.words.erase(left.words.begin() + 1, left.words.begin() + static_cast<std::ptrdiff_t>(values) + 2);
          any = true;
        }
    }
    return left.rest();
  }

  ObjLines lines_;
  const OpenBeside& open_;
  ObjLine line_;
  std::size_t object_ = 0;  // of out.objects; where faces go
  std::uint32_t material_ = 0;
  std::string group_;
  std::map<std::string, std::size_t> first_;    // object of each name
  std::map<std::string, std::uint32_t> known_;  // material of each name
  std::array<std::int64_t, 3> largest_{};
  std::array<std::size_t, 3> largest_at_{};
};

}  // namespace

Result<MeshContent> read_obj(const Bytes& bytes, const std::string& file_name, const OpenBeside& open) {
  ObjReader reader(bytes, open);
  if (const Status read = reader.all(); !read) return read.error();
  reader.out.root = file_name;
  return std::move(reader.out);
}

}  // namespace pliant
