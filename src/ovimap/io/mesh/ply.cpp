// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/mesh/ply.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "ovimap/base/error.h"
#include "ovimap/io/mesh/ply_header.h"

namespace ovimap {

namespace {

template <class Number>
Number swapped(Number value) {
  std::array<std::uint8_t, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(Number));
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&value, bytes.data(), sizeof(Number));
  return value;
}

bool is_space(std::uint8_t c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Reads one value after another from the body of a PLY file.
class PlyCursor {
 public:
  PlyCursor(std::span<const std::uint8_t> bytes, std::size_t start, PlyFormat format)
      : bytes_(bytes), at_(start), format_(format) {
    const bool big_host = std::endian::native == std::endian::big;
    swap_ = (format == PlyFormat::kBigEndian) != big_host;
  }

  std::size_t offset() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  double next(PlyType type) {
    if (format_ == PlyFormat::kAscii) return next_text();
    switch (type) {
      case PlyType::kInt8:
        return next_binary<std::int8_t>();
      case PlyType::kUint8:
        return next_binary<std::uint8_t>();
      case PlyType::kInt16:
        return next_binary<std::int16_t>();
      case PlyType::kUint16:
        return next_binary<std::uint16_t>();
      case PlyType::kInt32:
        return next_binary<std::int32_t>();
      case PlyType::kUint32:
        return next_binary<std::uint32_t>();
      case PlyType::kFloat32:
        return next_binary<float>();
      case PlyType::kFloat64:
        return next_binary<double>();
    }
    return 0;
  }

  void skip(PlyType type, std::uint64_t count) {
    if (format_ == PlyFormat::kAscii) {
      for (std::uint64_t i = 0; i < count; ++i) next_text();
    } else {
      if (left() / size_of(type) < count) throw Error("the file ends too early");
      at_ += count * size_of(type);
    }
  }

 private:
  template <class Number>
  double next_binary() {
    if (left() < sizeof(Number)) throw Error("the file ends too early");
    Number value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return static_cast<double>(swap_ ? swapped(value) : value);
  }

  double next_text() {
    while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
    if (at_ == bytes_.size()) throw Error("the file ends too early");
    const char* begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const char* file_end = reinterpret_cast<const char*>(bytes_.data()) + bytes_.size();
    if (*begin == '+') ++begin;
    double value = 0;
    const auto [end, fault] = std::from_chars(begin, file_end, value);
    const bool whole = end == file_end || is_space(static_cast<std::uint8_t>(*end));
    if (fault != std::errc() || !whole) throw Error("there is no number there");
    at_ = static_cast<std::size_t>(end - reinterpret_cast<const char*>(bytes_.data()));
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_;
  PlyFormat format_;
  bool swap_ = false;
};

enum VertexField { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kLabel, kVertexFields };
constexpr std::array<std::string_view, kVertexFields> kVertexNames = {
    "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "label"};

/// Which property of the vertex element feeds which field, and which fields are complete.
struct VertexLayout {
  explicit VertexLayout(const PlyElement& element) {
    std::array<bool, kVertexFields> has{};
    for (const PlyProperty& property : element.properties) {
      const auto found = std::find(kVertexNames.begin(), kVertexNames.end(), property.name);
      const bool known = found != kVertexNames.end() && !property.count_type;
      field_of.push_back(known ? static_cast<int>(found - kVertexNames.begin()) : -1);
      if (known) has[static_cast<std::size_t>(field_of.back())] = true;
      if (known && field_of.back() == kRed && !is_integer(property.type)) color_scale = 255;
    }
    if (!has[kX] || !has[kY] || !has[kZ]) throw Error("its element 'vertex' lacks x, y or z");
    normals = has[kNx] && has[kNy] && has[kNz];
    colors = has[kRed] && has[kGreen] && has[kBlue];
    labels = has[kLabel];
  }

  std::vector<int> field_of;  // per property; -1: skipped
  bool normals = false, colors = false, labels = false;
  double color_scale = 1;
};

class PlyReader {
 public:
  /// `face_value`: the property of the faces that is kept; empty: none.
  explicit PlyReader(std::span<const std::uint8_t> bytes, std::string face_value = {})
      : header_(parse_ply_header(bytes)),
        cursor_(bytes, header_.size, header_.format),
        face_value_(std::move(face_value)) {}

  ValuedMesh read() {
    for (const PlyElement& element : header_.elements) {
      const std::size_t item_size = element.min_item_size(header_.format);
      if (item_size == 0) continue;
      if (cursor_.left() / item_size < element.count)
        throw Error(concat("its element '", element.name, "' has ", element.count,
                           " items but only ", cursor_.left(), " bytes are left at byte ",
                           cursor_.offset(), ": the file is cut off or its header is wrong"));
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        skip_items(element);
    }
    check_indices();
    if (!face_value_.empty() && values_.size() != mesh_.triangles.size())
      throw Error(concat("its element 'face' has no property '", face_value_, "'"));
    return {std::move(mesh_), std::move(values_)};
  }

 private:
  /// Runs `body` for every item of the element and says where it was when something broke.
  template <class Body>
  void for_items(const PlyElement& element, Body&& body) {
    for (std::uint64_t item = 0; item < element.count; ++item) {
      const std::size_t start = cursor_.offset();
      try {
        body();
      } catch (const Error& fault) {
        throw Error(concat("its element '", element.name, "', item ", item, " of ", element.count,
                           " at byte ", start, " is broken: ", fault.what()));
      }
    }
  }

  void read_vertices(const PlyElement& element) {
    const VertexLayout layout(element);
    mesh_.vertices.reserve(element.count);
    if (layout.normals) mesh_.normals.reserve(element.count);
    if (layout.colors) mesh_.colors.reserve(element.count);
    if (layout.labels) mesh_.labels.reserve(element.count);
    std::array<double, kVertexFields> values{};
    for_items(element, [&] {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (layout.field_of[i] < 0)
          skip(property);
        else
          values[static_cast<std::size_t>(layout.field_of[i])] = cursor_.next(property.type);
      }
      add_vertex(layout, values);
    });
  }

  void add_vertex(const VertexLayout& layout, const std::array<double, kVertexFields>& values) {
    const auto vector = [&](int first) {
      return Eigen::Map<const Eigen::Vector3d>(values.data() + first).cast<float>();
    };
    mesh_.vertices.push_back(vector(kX));
    if (!mesh_.vertices.back().allFinite()) throw Error("its position is not finite");
    if (layout.normals) mesh_.normals.push_back(vector(kNx));
    if (layout.colors) {
      const auto byte = [&](int field) {
        const double value = values[static_cast<std::size_t>(field)] * layout.color_scale;
        return static_cast<std::uint8_t>(value > 0 ? std::min(std::round(value), 255.0) : 0);
      };
      mesh_.colors.push_back({byte(kRed), byte(kGreen), byte(kBlue)});
    }
    if (layout.labels) {
      const double label = values[kLabel];
      if (!(label <= std::numeric_limits<std::uint32_t>::max()) || label != std::floor(label))
        throw Error(concat("its label ", label, " is no whole number of 32 bits"));
      mesh_.labels.push_back(label > 0 ? static_cast<std::uint32_t>(label) : 0);
    }
  }

  void read_faces(const PlyElement& element) {
    mesh_.triangles.reserve(element.count);
    for_items(element, [&] {
      std::optional<std::int32_t> value;
      for (const PlyProperty& property : element.properties) {
        const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
        if (corners && property.count_type)
          read_polygon(property);
        else if (property.name == face_value_ && !property.count_type)
          value = read_whole_number(property);
        else
          skip(property);
      }
      if (value) values_.resize(mesh_.triangles.size(), *value);
    });
  }

  std::int32_t read_whole_number(const PlyProperty& property) {
    const double value = cursor_.next(property.type);
    const bool fits = std::abs(value) <= std::numeric_limits<std::int32_t>::max();
    if (!fits || value != std::floor(value))
      throw Error(concat("its ", property.name, " ", value, " is no whole number of 32 bits"));
    return static_cast<std::int32_t>(value);
  }

  void read_polygon(const PlyProperty& property) {
    const std::uint64_t corners = list_size(property);
    std::uint32_t first = 0, previous = 0;
    for (std::uint64_t i = 0; i < corners; ++i) {
      const double value = cursor_.next(property.type);
      if (!(value >= 0 && value < std::numeric_limits<std::uint32_t>::max()))
        throw Error(concat("its vertex index ", value, " is not in the file"));
      const auto index = static_cast<std::uint32_t>(value);
      if (i == 0) first = index;
      if (i >= 2) mesh_.triangles.push_back({first, previous, index});
      previous = index;
    }
  }

  void skip_items(const PlyElement& element) {
    for_items(element, [&] {
      for (const PlyProperty& property : element.properties) skip(property);
    });
  }

  void skip(const PlyProperty& property) {
    cursor_.skip(property.type, property.count_type ? list_size(property) : 1);
  }

  std::uint64_t list_size(const PlyProperty& property) {
    const double count = cursor_.next(*property.count_type);
    if (!(count >= 0 && count <= static_cast<double>(cursor_.left())))
      throw Error(concat("its list '", property.name, "' cannot have ", count, " entries"));
    return static_cast<std::uint64_t>(count);
  }

  // Faces may come before vertices, so this waits for the end.
  void check_indices() const {
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (const std::uint32_t index : mesh_.triangles[i])
        if (index >= mesh_.vertices.size())
          throw Error(concat("its element 'face' uses vertex ", index, " in triangle ", i,
                             ", but there are only ", mesh_.vertices.size(), " vertices"));
  }

  PlyHeader header_;
  PlyCursor cursor_;
  std::string face_value_;
  Mesh mesh_;
  std::vector<std::int32_t> values_;  ///< of face_value_, one a triangle
};

ValuedMesh decode_with(std::span<const std::uint8_t> bytes, const std::string& name,
                       const std::string& face_value) {
  try {
    return PlyReader(bytes, face_value).read();
  } catch (const Error& fault) {
    throw Error(concat("cannot read the PLY file '", name, "': ", fault.what()));
  }
}

}  // namespace

Mesh decode_ply(std::span<const std::uint8_t> bytes, const std::string& name) {
  return decode_with(bytes, name, {}).mesh;
}

ValuedMesh read_ply_with(const std::filesystem::path& path, const std::string& name) {
  return decode_with(read_file(path), path.string(), name);
}

Mesh read_ply(const std::filesystem::path& path) {
  return decode_ply(read_file(path), path.string());
}

}  // namespace ovimap
