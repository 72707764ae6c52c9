// Gmsh's .msh, versions 2 and 4.1, ASCII and binary in either byte order ("MSH file format", gmsh.info/doc). Sections
// are between $Name and $EndName; $PhysicalNames, $Entities, $Nodes and $Elements are read. Nodes have tags, in any
// order. Physical groups of volumes are kept: version 2 gives one per element, version 4 one per volume's entity.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

#include "content/files/limits.h"
#include "content/tets/tet_clean.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

// Number of nodes per element type; 0: unknown. Tetrahedra of any order begin with their four corners.
constexpr std::uint8_t kNodesOf[] = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                     8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
constexpr std::int64_t kTetTypes[] = {4, 11, 29, 30, 31};

std::size_t nodes_of(std::int64_t type) {
  return type > 0 && static_cast<std::size_t>(type) < std::size(kNodesOf) ? kNodesOf[type] : 0;
}
bool is_tet(std::int64_t type) {
  return std::find(std::begin(kTetTypes), std::end(kTetTypes), type) != std::end(kTetTypes);
}

struct Tag {
  std::uint64_t tag;
  std::uint32_t node;
};

class Msh {
 public:
  Msh(std::span<const std::uint8_t> bytes, std::string name) : text_(bytes, name), name_(std::move(name)) {}

  Result<TetFile> read() {
    if (Status s = format(); !s) return s.error();
    std::string_view word;
    while (text_.word(word)) {
      if (word.size() < 2 || word[0] != '$') return text_.fault("has text between its sections", "the file is damaged");
      const std::string section(word.substr(1, 60));
      end_line();
      Status status = Done{};
      if (section == "PhysicalNames") status = physical_names();
      if (section == "Entities" && is_four_) status = entities();
      if (section == "Nodes") status = is_four_ ? nodes_4() : nodes_2();
      if (section == "Elements") status = is_four_ ? elements_4() : elements_2();
      if (!status) return status.error();
      if (!text_.skip_past("$End" + section)) return text_.fault("ends inside $" + section, "it was cut short");
    }
    if (raw_.nodes.empty()) return Error{name_, "has no $Nodes", "save the mesh again"};
    if (!has_elements_) return Error{name_, "has no $Elements", "save the mesh again, with its volume elements"};
    return clean(std::move(raw_), name_);
  }

 private:
  Status format() {
    std::string_view word;
    std::int64_t binary = 0, size = 0;
    double version = 0.0;
    if (!text_.word(word) || word != "$MeshFormat" || !text_.number(version) || !text_.integer(binary) ||
        !text_.integer(size) || binary < 0 || binary > 1)
      return text_.fault("is not a Gmsh file", "it begins with $MeshFormat, version, kind and size");
    is_four_ = version == 4.1;
    if (!is_four_ && !(version >= 2.0 && version < 3.0))
      return text_.fault(fmt::format("is of version {}", version), "save it as 4.1 or 2.2");
    if (size != 8 && !(is_four_ && size == 4))
      return text_.fault(fmt::format("has numbers of {} bytes", size), "save it with 8");
    wide_ = size == 8;
    end_line();
    if (binary == 1) {
      text_.set_binary(true, false);
      std::int32_t one = 0;
      if (!text_.raw(one) || (one != 1 && one != 0x01000000))
        return text_.fault("does not say its byte order", "save it again");
      text_.set_binary(true, one != 1);
    }
    return text_.skip_past("$EndMeshFormat") ? Status(Done{})
                                             : text_.fault("ends inside $MeshFormat", "it was cut short");
  }

  // Binary values begin after the end of the header line.
  void end_line() {
    std::string_view rest;
    text_.line(rest);
  }

  // An `int` of the format.
  bool integer(std::int64_t& out) {
    if (!text_.binary()) return text_.integer(out);
    std::int32_t value;
    if (!text_.raw(value)) return false;
    out = value;
    return true;
  }
  // A `size_t`: a tag or a count.
  bool size(std::uint64_t& out) {
    if (!text_.binary() || !wide_) {
      std::int64_t value = 0;
      if (!integer(value) || value < 0) return false;
      out = static_cast<std::uint64_t>(value);
      return true;
    }
    return text_.raw(out);
  }
  bool coordinate(double& out) { return text_.binary() ? text_.raw(out) && std::isfinite(out) : text_.number(out); }
  bool point(dvec3& p) { return coordinate(p.x) && coordinate(p.y) && coordinate(p.z); }

  Status begin_nodes(std::uint64_t count) {
    if (!raw_.nodes.empty()) return text_.fault("has $Nodes twice", "save the mesh again");
    // In either encoding a node takes at least eight bytes.
    if (count > std::min<std::uint64_t>(most(limits::kTetFileNodes), text_.left() / 8 + 1))
      return text_.fault(
          fmt::format("claims {} nodes, more than it holds or than {}", count, most(limits::kTetFileNodes)));
    raw_.nodes.reserve(count);
    tags_.reserve(count);
    return Done{};
  }
  // Sorts the tags, so that elements find nodes by tag.
  Status end_nodes() {
    std::sort(tags_.begin(), tags_.end(), [](const Tag& a, const Tag& b) { return a.tag < b.tag; });
    for (std::size_t i = 1; i < tags_.size(); ++i)
      if (tags_[i].tag == tags_[i - 1].tag)
        return text_.fault(fmt::format("has two nodes of tag {}", tags_[i].tag), "save the mesh again");
    return Done{};
  }

  Status nodes_2() {
    std::int64_t count = 0;
    if (!text_.integer(count) || count < 0) return text_.fault("has $Nodes without a count", "the file is damaged");
    if (Status s = begin_nodes(static_cast<std::uint64_t>(count)); !s) return s;
    if (text_.binary()) end_line();
    for (std::int64_t i = 0; i < count; ++i) {
      std::int64_t tag = 0;
      dvec3 p;
      if (!integer(tag) || tag < 0 || !point(p)) return bad_node(static_cast<std::uint64_t>(i));
      tags_.push_back({static_cast<std::uint64_t>(tag), static_cast<std::uint32_t>(i)});
      raw_.nodes.push_back(p);
    }
    return end_nodes();
  }

  Status nodes_4() {
    std::uint64_t blocks = 0, count = 0, least = 0, largest = 0;
    if (!size(blocks) || !size(count) || !size(least) || !size(largest))
      return text_.fault("has $Nodes without its counts", "the file is damaged");
    if (Status s = begin_nodes(count); !s) return s;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      std::int64_t dimension = 0, entity = 0, parametric = 0;
      std::uint64_t in_block = 0;
      if (!integer(dimension) || !integer(entity) || !integer(parametric) || !size(in_block) || dimension < 0 ||
          dimension > 3 || in_block > count - raw_.nodes.size())
        return text_.fault(fmt::format("has a damaged head of node block {} of {}", b + 1, blocks));
      const auto first = static_cast<std::uint32_t>(raw_.nodes.size());
      for (std::uint32_t i = 0; i < in_block; ++i) {
        std::uint64_t tag = 0;
        if (!size(tag)) return bad_node(first + i);
        tags_.push_back({tag, first + i});
      }
      for (std::uint32_t i = 0; i < in_block; ++i) {
        dvec3 p;
        double parameter = 0.0;
        bool good = point(p);
        for (std::int64_t c = 0; parametric != 0 && c < dimension && good; ++c) good = coordinate(parameter);
        if (!good) return bad_node(first + i);
        raw_.nodes.push_back(p);
      }
    }
    if (raw_.nodes.size() != count)
      return text_.fault(fmt::format("claims {} nodes but its blocks hold {}", count, raw_.nodes.size()));
    return end_nodes();
  }

  // Lines of dimension, tag and "name", in ASCII in binary files, too.
  Status physical_names() {
    std::string_view line;
    std::size_t left = 0;
    if (!text_.line(line)) return Done{};
    left = static_cast<std::size_t>(std::strtoull(std::string(line).c_str(), nullptr, 10));
    for (; left > 0 && text_.line(line); --left) {
      const std::string row(line.substr(0, 300));
      char* end = nullptr;
      const long dimension = std::strtol(row.c_str(), &end, 10);
      const long long tag = std::strtoll(end, &end, 10);
      const std::size_t open = row.find('"'), close = row.rfind('"');
      if (dimension == 3 && open != std::string::npos && close > open)
        raw_.names[tag] = row.substr(open + 1, close - open - 1);
      if (row.rfind("$End", 0) == 0)
        return text_.fault("has fewer $PhysicalNames than it claims", "save the mesh again");
    }
    return Done{};
  }

  // Of each volume: its tag, and of its physical groups the first.
  Status entities() {
    const auto cut = [&] { return text_.fault("has damaged $Entities", "save the mesh again"); };
    std::array<std::uint64_t, 4> count{};
    for (std::uint64_t& each : count)
      if (!size(each)) return cut();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::uint64_t i = 0; i < count[static_cast<std::size_t>(dimension)]; ++i) {
        std::int64_t tag = 0, group = 0, bounding = 0;
        double place = 0.0;
        std::uint64_t groups = 0, bounds = 0;
        if (!integer(tag)) return cut();
        for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c)
          if (!coordinate(place)) return cut();
        if (!size(groups)) return cut();
        for (std::uint64_t g = 0; g < groups; ++g) {
          if (!integer(group)) return cut();
          if (dimension == 3 && g == 0) volume_group_[tag] = std::abs(group);
        }
        if (dimension == 0) continue;
        if (!size(bounds)) return cut();
        for (std::uint64_t b = 0; b < bounds; ++b)
          if (!integer(bounding)) return cut();
      }
    return Done{};
  }

  Error bad_node(std::uint64_t number) const {
    return text_.fault(fmt::format("node {} is not a tag and three finite coordinates", number + 1),
                       "the file is damaged");
  }
  Error bad_element(std::uint64_t number) const {
    return text_.fault(fmt::format("element {} is cut short or damaged", number + 1), "save the mesh again");
  }

  // Elements take at least two bytes in ASCII; a block's claimed size is checked against the remaining bytes.
  Status begin_elements(std::uint64_t count) {
    if (raw_.nodes.empty()) return text_.fault("has $Elements before $Nodes", "save the mesh again");
    if (count > std::min<std::uint64_t>(most(limits::kTetFileEntries), text_.left() / 2 + 1))
      return text_.fault(
          fmt::format("claims {} elements, more than it holds or than {}", count, most(limits::kTetFileEntries)));
    has_elements_ = true;
    return Done{};
  }

  // The nodes of one element.
  template <class ReadTag>
  Status element(std::int64_t type, std::uint64_t number, std::int64_t group, ReadTag read_tag) {
    Tet tet{};
    for (std::size_t n = 0; n < nodes_of(type); ++n) {
      std::uint64_t tag = 0;
      if (!read_tag(tag)) return bad_element(number);
      if (n >= 4 || !is_tet(type)) continue;
      const auto found =
          std::lower_bound(tags_.begin(), tags_.end(), tag, [](const Tag& a, std::uint64_t b) { return a.tag < b; });
      if (found == tags_.end() || found->tag != tag)
        return text_.fault(fmt::format("element {} names node {}, which does not exist", number + 1, tag));
      tet[n] = found->node;
    }
    if (!is_tet(type)) {
      ++raw_.other_cells;
      return Done{};
    }
    if (type != kTetTypes[0]) ++raw_.second_order;
    raw_.tets.push_back(tet);
    raw_.group.push_back(group);
    return Done{};
  }

  // An unknown type: in ASCII its line is skipped; in binary its size is unknown.
  Status skip_unknown(std::int64_t type) {
    if (text_.binary())
      return text_.fault(fmt::format("has elements of unknown type {}", type), "save only the volume's tetrahedra");
    end_line();
    ++raw_.other_cells;
    return Done{};
  }

  Status elements_2() {
    std::int64_t count = 0;
    if (!text_.integer(count) || count < 0) return text_.fault("has $Elements without a count", "the file is damaged");
    if (Status s = begin_elements(static_cast<std::uint64_t>(count)); !s) return s;
    if (text_.binary()) end_line();
    const auto read_tag = [&](std::uint64_t& tag) {
      std::int64_t value = 0;
      if (!integer(value) || value < 0) return false;
      tag = static_cast<std::uint64_t>(value);
      return true;
    };
    for (std::int64_t i = 0; i < count;) {
      // ASCII: number, type, tags, nodes. Binary: type, count, tags; then for each: number, tags, nodes.
      std::int64_t number = 0, type = 0, follow = 1, tags = 0;
      const bool headed =
          text_.binary() ? integer(type) && integer(follow) && integer(tags) : integer(number) && integer(type);
      if (!headed || follow < 1 || follow > count - i) return bad_element(static_cast<std::uint64_t>(i));
      if (nodes_of(type) == 0) {
        if (Status s = skip_unknown(type); !s) return s;
        ++i;
        continue;
      }
      if (!text_.binary() && !integer(tags)) return bad_element(static_cast<std::uint64_t>(i));
      for (std::int64_t e = 0; e < follow; ++e, ++i) {
        bool good = !text_.binary() || integer(number);
        std::int64_t group = 0, ignored = 0;  // the first tag is the physical group
        for (std::int64_t t = 0; t < tags && good; ++t) good = integer(t == 0 ? group : ignored);
        if (!good) return bad_element(static_cast<std::uint64_t>(i));
        if (Status s = element(type, static_cast<std::uint64_t>(i), group, read_tag); !s) return s;
      }
    }
    return Done{};
  }

  Status elements_4() {
    std::uint64_t blocks = 0, count = 0, least = 0, largest = 0, read = 0;
    if (!size(blocks) || !size(count) || !size(least) || !size(largest))
      return text_.fault("has $Elements without its counts", "the file is damaged");
    if (Status s = begin_elements(count); !s) return s;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      std::int64_t dimension = 0, entity = 0, type = 0;
      std::uint64_t in_block = 0, number = 0;
      if (!integer(dimension) || !integer(entity) || !integer(type) || !size(in_block) || in_block > count - read)
        return text_.fault(fmt::format("has a damaged head of element block {} of {}", b + 1, blocks));
      if (nodes_of(type) == 0) end_line();
      const auto of_volume = volume_group_.find(entity);
      const std::int64_t group = dimension == 3 && of_volume != volume_group_.end() ? of_volume->second : 0;
      for (std::uint64_t i = 0; i < in_block; ++i, ++read) {
        Status status = Done{};
        if (nodes_of(type) == 0)
          status = skip_unknown(type);
        else if (!size(number))
          return bad_element(read);
        else
          status = element(type, read, group, [&](std::uint64_t& tag) { return size(tag); });
        if (!status) return status;
      }
    }
    return Done{};
  }

  TetText text_;
  std::string name_;
  bool is_four_ = false, wide_ = true, has_elements_ = false;
  RawTets raw_;
  std::vector<Tag> tags_;                              // by tag
  std::map<std::int64_t, std::int64_t> volume_group_;  // version 4: of each volume's entity
};

}  // namespace

Result<TetFile> parse_msh(std::span<const std::uint8_t> bytes, const std::string& name) {
  return Msh(bytes, name).read();
}

Result<TetFile> read_msh(const std::filesystem::path& path, const std::filesystem::path&) {
  return read_parsed(path, parse_msh);
}

}  // namespace pliant
