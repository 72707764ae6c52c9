// OBJ: lines of a key and its values; a backslash at the end continues the line. Vertices are counted from 1, or
// backwards from the last one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "content/files/mesh_check.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

constexpr const char* kNames[] = {"vertex", "texture coordinate", "normal"};

class ObjCheck {
 public:
  explicit ObjCheck(Bytes& bytes) : bytes_(bytes), text_(bytes, "") {}

  Status all() {
    bool curve = false;  // free-form geometry, from `cstype` to `end`: ignored
    while (row()) {
      if (words_.empty()) continue;
      const std::string_view key = words_[0];
      if (curve || key == "cstype") {
        curve = key != "end";
        continue;
      }
      Status status = Done{};
      if (key == "v") status = vertex();
      if (key == "vt") ++count_[1];
      if (key == "vn") ++count_[2];
      if (key == "f") status = face();
      if (!status) return status;
    }
    // A face may refer to vertices defined later, so the check comes at the end of the file.
    for (std::size_t i = 0; i < 3; ++i)
      if (largest_[i] > count_[i]) {
        line_ = largest_at_[i];
        return at(fmt::format("names {} {} of {}", kNames[i], largest_[i], count_[i]));
      }
    return Done{};
  }

 private:
  Error at(const std::string& what) const { return {fmt::format("line {}", line_), what, "export it again"}; }

  // Reads the words of the next line and its continuation lines.
  bool row() {
    words_.clear();
    joined_.clear();
    std::string_view line;
    bool more = true, any = false, numbers = false;
    while (more && text_.line(line)) {
      line_ = ++lines_;
      more = !line.empty() && line.back() == '\\';
      if (more) line.remove_suffix(1);
      if (!any) {
        move_indent(line);
        numbers = !line.empty() && (line[0] == 'v' || line[0] == 'f');
      }
      any = true;
      const std::size_t comment = std::min(line.find('#'), line.size());
      if (numbers) blank(line.substr(comment));
      joined_.append(line.substr(0, comment)).append(" ");
    }
    TetText rest({reinterpret_cast<const std::uint8_t*>(joined_.data()), joined_.size()}, "");
    for (std::string_view word; rest.word(word);) words_.push_back(word);
    return any;
  }

  // The position of a part of a line in the file's bytes.
  Bytes::iterator place_of(std::string_view part) {
    return bytes_.begin() + (reinterpret_cast<const std::uint8_t*>(part.data()) - bytes_.data());
  }

  // Assimp reads a comment after a face as one of its corners.
  void blank(std::string_view comment) { std::fill_n(place_of(comment), comment.size(), std::uint8_t{' '}); }

  // Assimp drops a line that begins with blanks: they are moved to its end.
  void move_indent(std::string_view line) {
    const std::size_t indent = std::min(line.find_first_not_of(" \t\v\f"), line.size());
    const auto begin = place_of(line);
    std::rotate(begin, begin + static_cast<std::ptrdiff_t>(indent), begin + static_cast<std::ptrdiff_t>(line.size()));
  }

  Status vertex() {
    ++count_[0];
    const std::size_t numbers = words_.size() - 1;
    if (numbers != 3 && numbers != 4 && numbers != 6)
      return at(fmt::format("has {} numbers for a vertex; x y z, w or a colour are read", numbers));
    double value = 0.0;
    for (std::size_t i = 1; i < words_.size(); ++i)
      if (!to_number(words_[i], value)) return at("has something else than a finite number for a vertex");
    return Done{};
  }

  Status face() {
    if (words_.size() < 4) return at("has a face of fewer than three corners");
    for (std::size_t c = 1; c < words_.size(); ++c)
      if (const Status status = corner(words_[c]); !status) return status;
    return Done{};
  }

  // v, v/vt, v//vn or v/vt/vn
  Status corner(std::string_view word) {
    const std::string_view whole = word.substr(0, 40);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t slash = word.find('/');
      const std::string_view part = word.substr(0, slash);
      std::int64_t index = 0;
      if (i == 0 || !part.empty()) {
        if (!to_integer(part, index) || index == 0) return at(fmt::format("has the corner '{}' in a face", whole));
        if (index < -count_[i]) return at(fmt::format("names {} {} with {} before it", kNames[i], index, count_[i]));
        if (index > largest_[i]) {
          largest_[i] = index;
          largest_at_[i] = line_;
        }
      }
      if (slash == std::string_view::npos) return Done{};
      word.remove_prefix(slash + 1);
    }
    return at(fmt::format("has the corner '{}' in a face", whole));
  }

  Bytes& bytes_;
  TetText text_;
  std::string joined_;
  std::vector<std::string_view> words_;
  std::size_t lines_ = 0, line_ = 0;
  std::array<std::int64_t, 3> count_{}, largest_{};
  std::array<std::size_t, 3> largest_at_{};
};

}  // namespace

Status check_obj(Bytes& bytes) {
  return ObjCheck(bytes).all();
}

}  // namespace pliant
