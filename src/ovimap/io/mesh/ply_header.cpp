// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypeNames = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(" \t\r", end);
  }
  return words;
}

/// The header line by line, so that every fault can name its line and byte.
class HeaderParser {
 public:
  explicit HeaderParser(std::span<const std::uint8_t> bytes)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  PlyHeader parse() {
    if (next_line() != "ply") throw Error("it does not start with 'ply', so it is no PLY file");
    for (;;) {
      const std::vector<std::string_view> words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      take(words);
    }
    if (!has_format_) throw Error("its header has no format line");
    header_.size = at_;
    return std::move(header_);
  }

 private:
  std::string_view next_line() {
    line_start_ = at_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos)
      throw Error(concat("its header ends at byte ", text_.size(), " without an end_header line"));
    std::string_view line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    line_ = line;
    return line;
  }

  void take(const std::vector<std::string_view>& words) {
    if (words[0] == "format") return take_format(words);
    if (words[0] == "element") return take_element(words);
    if (words[0] == "property") return take_property(words);
    fail("is not understood");
  }

  void take_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3 || words[2] != "1.0") fail("should name a format and version 1.0");
    if (words[1] == "ascii")
      header_.format = PlyFormat::kAscii;
    else if (words[1] == "binary_little_endian")
      header_.format = PlyFormat::kLittleEndian;
    else if (words[1] == "binary_big_endian")
      header_.format = PlyFormat::kBigEndian;
    else
      fail("should name ascii, binary_little_endian or binary_big_endian");
    has_format_ = true;
  }

  void take_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("should be 'element NAME COUNT'");
    constexpr std::size_t kMostElements = 100;  // each is compared with all before it
    if (header_.elements.size() == kMostElements) fail("is one element too many");
    PlyElement element;
    element.name = words[1];
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name) fail("names an element for the second time");
    const char* end = words[2].data() + words[2].size();
    const auto result = std::from_chars(words[2].data(), end, element.count);
    if (result.ec != std::errc() || result.ptr != end) fail("has no whole number as its count");
    header_.elements.push_back(std::move(element));
  }

  void take_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("comes before any element");
    PlyProperty property;
    if (words.size() == 5 && words[1] == "list") {
      property.count_type = type_of(words[2]);
      if (!is_integer(*property.count_type)) fail("counts its list in a type that is no integer");
      property.type = type_of(words[3]);
    } else if (words.size() == 3) {
      property.type = type_of(words[1]);
    } else {
      fail("should be 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    }
    property.name = words.back();
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type_of(std::string_view word) {
    for (const auto& [name, type] : kTypeNames)
      if (name == word) return type;
    fail("has an unknown number type");
  }

  [[noreturn]] void fail(std::string_view what) const {
    constexpr std::size_t kShown = 60;  // a binary file may have very long "lines"
    throw Error(
        concat("its header line '", line_.substr(0, kShown), "' at byte ", line_start_, " ", what));
  }

  std::string_view text_, line_;
  std::size_t at_ = 0, line_start_ = 0;
  bool has_format_ = false;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

bool is_integer(PlyType type) {
  return type != PlyType::kFloat32 && type != PlyType::kFloat64;
}

std::size_t PlyElement::min_item_size(PlyFormat format) const {
  if (format == PlyFormat::kAscii) return properties.size();
  std::size_t size = 0;
  for (const PlyProperty& property : properties)
    size += size_of(property.count_type.value_or(property.type));
  return size;
}

PlyHeader parse_ply_header(std::span<const std::uint8_t> bytes) {
  return HeaderParser(bytes).parse();
}

}  // namespace ovimap
