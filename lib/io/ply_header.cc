#include "io/ply_header.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "io/text.h"

// The format: Greg Turk, "The PLY Polygon File Format", 1994, and the type names with sizes (int8,
// float32, ...) that came into use later.

namespace plumb::detail {
namespace {

constexpr std::array<std::pair<const char*, PlyType>, 16> kTypeNames = {{
    {"char", PlyType::Int8},
    {"uchar", PlyType::UInt8},
    {"short", PlyType::Int16},
    {"ushort", PlyType::UInt16},
    {"int", PlyType::Int32},
    {"uint", PlyType::UInt32},
    {"float", PlyType::Float32},
    {"double", PlyType::Float64},
    {"int8", PlyType::Int8},
    {"uint8", PlyType::UInt8},
    {"int16", PlyType::Int16},
    {"uint16", PlyType::UInt16},
    {"int32", PlyType::Int32},
    {"uint32", PlyType::UInt32},
    {"float32", PlyType::Float32},
    {"float64", PlyType::Float64},
}};

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (at < line.size()) {
    const std::size_t begin = at;
    while (at < line.size() && !is_blank(line[at])) ++at;
    if (at > begin) words.push_back(line.substr(begin, at - begin));
    while (at < line.size() && is_blank(line[at])) ++at;
  }
  return words;
}

PlyUse use_of(const PlyElement& element, const PlyProperty& property) {
  const std::string& name = property.name;
  if (element.name == "vertex" && name == "x") return PlyUse::X;
  if (element.name == "vertex" && name == "y") return PlyUse::Y;
  if (element.name == "vertex" && name == "z") return PlyUse::Z;
  if (element.name == "face" && (name == "vertex_indices" || name == "vertex_index")) return PlyUse::Corners;
  return PlyUse::Nothing;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, std::uint64_t file_bytes, const std::string& file,
               const MeshLimits& limits)
      : bytes_(bytes), file_bytes_(file_bytes), file_(file), limits_(limits) {}

  std::optional<PlyHeader> read() {
    if (!bytes_.starts_with("ply")) fail_at(1, kBegin);
    if (!next_line()) return std::nullopt;
    if (split(text_) != std::vector<std::string_view>{"ply"}) fail_at(1, kBegin);
    while (true) {
      if (!next_line()) return std::nullopt;
      const std::vector<std::string_view> words = split(text_);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header" && words.size() == 1) break;
      read_statement(words);
    }
    if (!format_seen_) fail("the header has no line \"format\"");
    header_.bytes = at_;
    header_.lines = line_;
    for (const PlyElement& element : header_.elements) check_properties(element);
    check_length();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail_at(std::size_t line, const std::string& reason) const {
    fail_in_file(file_, "line " + std::to_string(line), reason);
  }
  [[noreturn]] void fail(const std::string& reason) const { fail_at(line_, reason); }

  // Goes to the next line; whether its end is among the bytes.
  bool next_line() {
    ++line_;
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) {
      if (bytes_.size() < file_bytes_) return false;
      fail("the file ends before the header does (a line \"end_header\")");
    }
    text_ = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    if (text_.ends_with('\r')) text_.remove_suffix(1);
    return true;
  }

  void read_statement(const std::vector<std::string_view>& words) {
    if (words[0] == "format") return read_format(words);
    if (words[0] == "element") return read_element(words);
    if (words[0] == "property") return read_property(words);
    fail("unknown header statement " + in_quotes(words[0]));
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (format_seen_) fail("a second line \"format\"");
    if (!header_.elements.empty()) fail("the line \"format\" must come before the elements");
    format_seen_ = true;
    if (words.size() != 3) fail("expected \"format NAME 1.0\"");
    if (words[1] == "ascii") {
      header_.format = PlyFormat::Ascii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = PlyFormat::BinaryLittleEndian;
    } else if (words[1] == "binary_big_endian") {
      header_.format = PlyFormat::BinaryBigEndian;
    } else {
      fail("unknown format " + in_quotes(words[1]) +
           "; known: ascii, binary_little_endian, binary_big_endian");
    }
    if (words[2] != "1.0") fail("unknown format version " + in_quotes(words[2]) + "; known: 1.0");
  }

  void read_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected \"element NAME COUNT\"");
    PlyElement element;
    element.name = words[1];
    element.line = line_;
    element.count = read_count(words[2]);
    if (!element_names_.insert(element.name).second) fail("a second element " + in_quotes(element.name));
    property_names_.clear();
    if (element.name == "vertex") {
      header_.vertices = element.count;
      if (element.count > limits_.vertices) {
        fail(too_many("vertices", limits_.vertices));
      }
    }
    if (element.name == "face") header_.faces = element.count;
    if (element.name == "tristrips" && element.count > 0) {
      fail("triangle strips (element \"tristrips\") are not read; store the mesh as faces");
    }
    header_.elements.push_back(std::move(element));
  }

  std::uint64_t read_count(std::string_view word) const {
    std::int64_t count = 0;
    const char* end = word.data() + word.size();
    if (parse_integer(word.data(), end, count) != end || count < 0) {
      fail("expected a count, found " + in_quotes(word));
    }
    return static_cast<std::uint64_t>(count);
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    PlyElement& element = header_.elements.back();
    PlyProperty property;
    property.is_list = words.size() > 1 && words[1] == "list";
    if (words.size() != (property.is_list ? 5u : 3u)) {
      fail("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    if (property.is_list) property.count_type = read_type(words[2]);
    property.type = read_type(words[words.size() - 2]);
    property.name = words.back();
    property.use = use_of(element, property);
    check_property(element, property);
    element.properties.push_back(std::move(property));
  }

  PlyType read_type(std::string_view word) const {
    for (const auto& [name, type] : kTypeNames) {
      if (word == name) return type;
    }
    fail("unknown type " + in_quotes(word));
  }

  void check_property(const PlyElement& element, const PlyProperty& property) {
    // The two names of the corners' list count as one.
    const bool is_new =
        property_names_.insert(property.use == PlyUse::Corners ? "vertex_indices" : property.name).second;
    if (!is_new) {
      fail("a second property " + in_quotes(property.name) + " of element " + in_quotes(element.name));
    }
    if (property.is_list && is_real(property.count_type)) fail("a list's length must be of an integer type");
    if (property.use == PlyUse::Nothing) return;
    if (property.is_list != (property.use == PlyUse::Corners)) {
      fail("property " + in_quotes(property.name) + (property.is_list ? " must not be" : " must be") +
           " a list");
    }
    if (property.use == PlyUse::Corners && is_real(property.type)) {
      fail("vertex indices must be of an integer type");
    }
  }

  // Every vertex has a position and every face its corners.
  void check_properties(const PlyElement& element) const {
    if (element.count == 0) return;
    const auto has = [&](PlyUse use) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [&](const PlyProperty& p) { return p.use == use; });
    };
    if (element.name == "vertex" && !(has(PlyUse::X) && has(PlyUse::Y) && has(PlyUse::Z))) {
      fail_at(element.line, "element \"vertex\" needs the properties x, y and z");
    }
    if (element.name == "face" && !has(PlyUse::Corners)) {
      fail_at(element.line, "element \"face\" needs a list property \"vertex_indices\"");
    }
  }

  // The fewest bytes that one row of an element can take: lists are empty but for three corners,
  // and a value in a text is one digit and what ends it.
  std::uint64_t least_row_bytes(const PlyElement& element) const {
    const auto least = [&](PlyType type) -> std::uint64_t {
      return header_.format == PlyFormat::Ascii ? 2 : size_of(type);
    };
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
      bytes += least(property.is_list ? property.count_type : property.type);
      if (property.use == PlyUse::Corners) bytes += 3 * least(property.type);
    }
    return bytes;
  }

  void check_length() const {
    std::uint64_t left = file_bytes_ - at_;
    if (header_.format == PlyFormat::Ascii) ++left;  // nothing need end the last value of a text
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t row = least_row_bytes(element);
      if (row != 0 && element.count > left / row) {
        fail_at(element.line, cut_short("element " + in_quotes(element.name), element.count, row, left));
      }
      left -= element.count * row;
    }
  }

  static constexpr const char* kBegin = "a PLY file begins with a line \"ply\"";

  std::string_view bytes_;
  std::uint64_t file_bytes_;
  const std::string& file_;
  MeshLimits limits_;
  PlyHeader header_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  std::string_view text_;  // of the line, without its end
  bool format_seen_ = false;
  std::set<std::string> element_names_;
  std::set<std::string> property_names_;  // of the last element
};

}  // namespace

bool is_real(PlyType type) { return type == PlyType::Float32 || type == PlyType::Float64; }

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

const char* name_of(PlyType type) { return kTypeNames[static_cast<std::size_t>(type)].first; }

std::optional<PlyHeader> read_ply_header(std::string_view first_bytes, std::uint64_t file_bytes,
                                         const std::string& file, const MeshLimits& limits) {
  return HeaderReader(first_bytes, file_bytes, file, limits).read();
}

}  // namespace plumb::detail
