// Legacy VTK files with an unstructured grid ("VTK File Formats", docs.vtk.org): versions to 4 (cells as counted runs)
// and 5 (offsets and connectivity), ASCII, or binary with the most significant byte first.
#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "content/files/limits.h"
#include "content/tets/tet_clean.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

enum CellType : std::int64_t { kTetra = 10, kQuadraticTetra = 24, kLagrangeTetra = 71, kBezierTetra = 78 };

struct DataType {
  std::string_view name;
  std::size_t size;  // [byte]
  char kind;         // f floating, i signed, u unsigned
};
constexpr DataType kTypes[] = {{"float", 4, 'f'},         {"double", 8, 'f'},         {"int", 4, 'i'},
                               {"unsigned_int", 4, 'u'},  {"long", 8, 'i'},           {"unsigned_long", 8, 'u'},
                               {"short", 2, 'i'},         {"unsigned_short", 2, 'u'}, {"char", 1, 'i'},
                               {"unsigned_char", 1, 'u'}, {"vtktypeint64", 8, 'i'},   {"vtkIdType", 8, 'i'},
                               {"vtktypeuint64", 8, 'u'}, {"vtktypeint32", 4, 'i'}};

const DataType* find_type(std::string_view name) {
  for (const DataType& each : kTypes)
    if (each.name == name) return &each;
  return nullptr;
}

class Vtk {
 public:
  Vtk(std::span<const std::uint8_t> bytes, std::string name) : text_(bytes, name), name_(std::move(name)) {}

  Result<TetFile> read() {
    if (Status s = head(); !s) return s.error();
    std::string_view word;
    while ((raw_.nodes.empty() || cells_ == 0 || types_.empty()) && text_.word(word)) {
      Status status = Done{};
      if (word == "POINTS")
        status = points();
      else if (word == "CELLS")
        status = cells();
      else if (word == "CELL_TYPES")
        status = types();
      else if (word == "FIELD")
        status = skip_field();
      else if (word == "METADATA")
        skip_metadata();
      else
        return text_.fault("has an unknown section `" + std::string(word.substr(0, 40)) + "`",
                           "save it as a legacy unstructured grid");
      if (!status) return status.error();
    }
    if (raw_.nodes.empty() || cells_ == 0 || types_.empty())
      return text_.fault("ends before POINTS, CELLS and CELL_TYPES", "it was cut short, or holds no cells");
    return collect();
  }

 private:
  Status head() {
    std::string_view first, title, format, word;
    if (!text_.line(first) || first.substr(0, 22) != "# vtk DataFile Version" || !text_.line(title) ||
        !text_.word(format) || (format != "ASCII" && format != "BINARY"))
      return text_.fault("is not a legacy VTK file",
                         "it begins with `# vtk DataFile Version`, a title, and ASCII or BINARY");
    double version = 0.0;
    if (!to_number(first.substr(std::min<std::size_t>(23, first.size())), version) || version < 1.0 || version >= 6.0)
      return text_.fault("has an unknown version", "save it as version 2 to 5");
    is_five_ = version >= 5.0;
    if (!text_.word(word) || word != "DATASET" || !text_.word(word) || word != "UNSTRUCTURED_GRID")
      return text_.fault("does not hold an unstructured grid", "save the tetrahedra as DATASET UNSTRUCTURED_GRID");
    if (format == "BINARY") text_.set_binary(true, std::endian::native == std::endian::little);
    return Done{};
  }

  // The count at the head of a section, at most as many as the remaining bytes could hold.
  bool count(std::int64_t& out) {
    return text_.integer(out) && out >= 0 && out <= static_cast<std::int64_t>(most(limits::kTetFileEntries)) &&
           static_cast<std::uint64_t>(out) <= text_.left();
  }
  // Binary values begin after the end of the header line.
  void end_header() {
    std::string_view rest;
    if (text_.binary()) text_.line(rest);
  }

  template <class T>
  bool raw_as(std::int64_t& out) {
    T value;
    if (!text_.raw(value)) return false;
    out = static_cast<std::int64_t>(value);
    return true;
  }
  bool integer(std::int64_t& out, const DataType& type) {
    if (!text_.binary()) return text_.integer(out);
    if (type.size == 8) return raw_as<std::int64_t>(out);
    if (type.size == 4) return type.kind == 'u' ? raw_as<std::uint32_t>(out) : raw_as<std::int32_t>(out);
    if (type.size == 2) return type.kind == 'u' ? raw_as<std::uint16_t>(out) : raw_as<std::int16_t>(out);
    return type.kind == 'u' ? raw_as<std::uint8_t>(out) : raw_as<std::int8_t>(out);
  }
  bool coordinate(double& out, const DataType& type) {
    if (!text_.binary()) return text_.number(out);
    if (type.kind == 'f' && type.size == 8) return text_.raw(out) && std::isfinite(out);
    if (type.kind == 'f') {
      float value;
      if (!text_.raw(value) || !std::isfinite(value)) return false;
      out = static_cast<double>(value);
      return true;
    }
    std::int64_t whole = 0;
    if (!integer(whole, type)) return false;
    out = static_cast<double>(whole);
    return true;
  }

  Status points() {
    std::int64_t size = 0;
    std::string_view type_name;
    if (!raw_.nodes.empty()) return text_.fault("has POINTS twice", "save it again");
    if (!count(size) || static_cast<std::size_t>(size) > most(limits::kTetFileNodes) || !text_.word(type_name))
      return text_.fault(fmt::format("claims more POINTS than the file holds or than {}", most(limits::kTetFileNodes)));
    const DataType* type = find_type(type_name);
    if (!type) return text_.fault("has POINTS of an unknown type", "save them as double");
    end_header();
    for (std::int64_t i = 0; i < size; ++i) {
      dvec3 p;
      for (int c = 0; c < 3; ++c)
        if (!coordinate(p[c], *type))
          return text_.fault(fmt::format("point {} of {} is not three finite numbers", i, size), "the file is damaged");
      raw_.nodes.push_back(p);
    }
    return Done{};
  }

  Status list(std::int64_t size, const DataType& type, std::vector<std::int64_t>& out, const char* what) {
    out.clear();
    out.reserve(static_cast<std::size_t>(size));
    for (std::int64_t i = 0; i < size; ++i) {
      std::int64_t value = 0;
      if (!integer(value, type)) return text_.fault(fmt::format("{} {} of {} is missing or no number", what, i, size));
      out.push_back(value);
    }
    return Done{};
  }

  // Both encodings are converted to offsets_ (one more than cells) into connectivity_.
  Status cells() {
    std::int64_t first = 0, second = 0;
    if (cells_ != 0) return text_.fault("has CELLS twice", "save it again");
    if (!count(first) || !count(second)) return text_.fault("claims more CELLS than the file holds, or than are read");
    end_header();
    if (is_five_) return offset_cells(first, second);
    const auto cut_short = [&](std::int64_t c) {
      return text_.fault(fmt::format("cell {} of {} is cut short", c, first), "the file is damaged");
    };
    offsets_ = {0};
    for (std::int64_t c = 0; c < first; ++c) {
      std::int64_t nodes = 0, node = 0;
      if (!integer(nodes, kTypes[2]) || nodes < 0) return cut_short(c);
      for (std::int64_t i = 0; i < nodes; ++i) {
        if (!integer(node, kTypes[2])) return cut_short(c);
        connectivity_.push_back(node);
      }
      offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
    }
    if (second != first + offsets_.back())
      raw_.notes.push_back(
          fmt::format("CELLS claims {} entries and has {}: the claim is ignored", second, first + offsets_.back()));
    cells_ = static_cast<std::size_t>(first);
    return Done{};
  }
  Status offset_cells(std::int64_t offsets, std::int64_t connectivity) {
    if (Status s = named_list("OFFSETS", offsets, offsets_); !s) return s;
    if (Status s = named_list("CONNECTIVITY", connectivity, connectivity_); !s) return s;
    for (std::size_t i = 0; i < offsets_.size(); ++i)
      if (offsets_[i] < (i == 0 ? 0 : offsets_[i - 1]) || offsets_[i] > connectivity)
        return text_.fault(fmt::format("offset {} leads out of CONNECTIVITY", i), "the file is damaged");
    cells_ = offsets_.empty() ? 0 : offsets_.size() - 1;
    return Done{};
  }
  Status named_list(const char* name, std::int64_t size, std::vector<std::int64_t>& out) {
    std::string_view word, type_name;
    const DataType* type = nullptr;
    if (text_.word(word) && word == name && text_.word(type_name)) type = find_type(type_name);
    if (!type || type->kind == 'f')
      return text_.fault(fmt::format("has no {} of whole numbers", name), "the file is damaged");
    end_header();
    return list(size, *type, out, name);
  }

  Status types() {
    std::int64_t size = 0;
    if (!types_.empty()) return text_.fault("has CELL_TYPES twice", "save it again");
    if (!count(size)) return text_.fault("claims more CELL_TYPES than the file holds");
    end_header();
    return list(size, kTypes[2], types_, "cell type");
  }

  // FIELD name arrays, then each array: its name, components, tuples, type, values.
  Status skip_field() {
    std::string_view name, type_name;
    std::int64_t arrays = 0;
    if (!text_.word(name) || !count(arrays)) return text_.fault("has a FIELD without a number of arrays");
    for (std::int64_t a = 0; a < arrays; ++a) {
      std::int64_t components = 0, tuples = 0;
      if (!text_.word(name) || !count(components) || !count(tuples) || !text_.word(type_name) || !find_type(type_name))
        return text_.fault("has a FIELD array that is not read", "remove field data and save again");
      end_header();
      const auto values = static_cast<std::uint64_t>(components) * static_cast<std::uint64_t>(tuples);
      bool skipped = values <= text_.left();
      if (text_.binary()) {
        skipped = skipped && text_.skip(values * find_type(type_name)->size);
      } else {
        for (std::uint64_t i = 0; i < values && skipped; ++i) skipped = text_.word(name);
      }
      if (!skipped) return text_.fault("has a FIELD array that is cut short");
    }
    return Done{};
  }

  // Skips lines up to an empty one.
  void skip_metadata() {
    std::string_view line;
    text_.line(line);
    while (text_.line(line) && !line.empty()) continue;
  }

  Result<TetFile> collect() {
    if (types_.size() != cells_)
      return text_.fault(fmt::format("has {} CELLS but {} CELL_TYPES", cells_, types_.size()), "the file is damaged");
    for (std::size_t c = 0; c < cells_; ++c) {
      const std::int64_t type = types_[c];
      const auto begin = static_cast<std::size_t>(offsets_[c]),
                 size = static_cast<std::size_t>(offsets_[c + 1]) - begin;
      const bool higher = type == kQuadraticTetra || type == kLagrangeTetra || type == kBezierTetra;
      if (type != kTetra && !higher) {
        ++raw_.other_cells;
        continue;
      }
      if (size < 4 || (type == kTetra && size != 4) || (type == kQuadraticTetra && size != 10))
        return Error{name_, fmt::format("cell {} is a tetrahedron of {} nodes", c, size), "the file is damaged"};
      if (higher && size > 4) ++raw_.second_order;
      Tet tet;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::int64_t node = connectivity_[begin + i];
        if (node < 0 || static_cast<std::size_t>(node) >= raw_.nodes.size())
          return Error{name_, fmt::format("cell {} names point {} of {}", c, node, raw_.nodes.size()),
                       "the file is damaged"};
        tet[i] = static_cast<std::uint32_t>(node);
      }
      raw_.tets.push_back(tet);
    }
    return clean(std::move(raw_), name_);
  }

  TetText text_;
  std::string name_;
  bool is_five_ = false;
  RawTets raw_;
  std::size_t cells_ = 0;
  std::vector<std::int64_t> offsets_, connectivity_, types_;
};

}  // namespace

Result<TetFile> parse_vtk(std::span<const std::uint8_t> bytes, const std::string& name) {
  return Vtk(bytes, name).read();
}

Result<TetFile> read_vtk(const std::filesystem::path& path, const std::filesystem::path&) {
  return read_parsed(path, parse_vtk);
}

}  // namespace pliant
