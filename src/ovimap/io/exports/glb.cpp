// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/glb.h"

#include <bit>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/scratch_file.h"
#include "ovimap/io/exports/instance_json_value.h"
#include "ovimap/io/mesh/labelled_pieces.h"

namespace ovimap {

namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertices = 34962, kIndices = 34963;  // targets of buffer views
constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

void append(Bytes& bytes, std::uint32_t word, int count = 4) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> 8 * i));
}

void append(Bytes& bytes, const Eigen::Vector3f& v) {
  for (const float value : v) append(bytes, std::bit_cast<std::uint32_t>(value));
}

/// 16-bit linear intensity of an 8-bit sRGB value.
std::array<std::uint16_t, 256> linear_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double s = static_cast<double>(i) / 255;
    const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    table[i] = static_cast<std::uint16_t>(std::lround(linear * 65535));
  }
  return table;
}

Json vector_json(const Eigen::Vector3f& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

/// Gathers the parts of a document; its one buffer is `body`.
class GlbBuilder {
 public:
  explicit GlbBuilder(ScratchFile& body) : body_(body) {}

  /// Index of a mesh with one primitive.
  std::size_t add_mesh(const Mesh& mesh) {
    Json attributes;
    attributes["POSITION"] = add_positions(mesh.vertices);
    if (!mesh.normals.empty()) attributes["NORMAL"] = add_normals(mesh.normals);
    if (!mesh.colors.empty()) attributes["COLOR_0"] = add_colors(mesh.colors);
    Json primitive = {{"attributes", std::move(attributes)},
                      {"indices", add_indices(mesh.triangles)},
                      {"material", 0}};
    meshes_.push_back({{"primitives", Json::array({std::move(primitive)})}});
    body_.append(buffer_);
    check_size(body_.size());
    buffer_.clear();
    return meshes_.size() - 1;
  }

  void add_node(const std::string& name, const Mesh& mesh, Json extras) {
    Json node = {{"name", name}};
    if (!mesh.triangles.empty()) node["mesh"] = add_mesh(mesh);
    if (!extras.is_null()) node["extras"] = std::move(extras);
    nodes_.push_back(std::move(node));
  }

  /// What stands in the file before the buffer.
  Bytes finish(const Eigen::Vector3f& up) {
    Json document;
    document["asset"] = {{"version", "2.0"}, {"generator", "ovimap"}};
    document["scene"] = 0;
    document["scenes"] = Json::array({{{"nodes", Json::array({nodes_.size()})}}});
    Json root = {{"name", "map"}, {"rotation", upright(up)}};
    for (std::size_t i = 0; i < nodes_.size(); ++i) root["children"].push_back(i);
    nodes_.push_back(std::move(root));
    document["nodes"] = std::move(nodes_);
    if (!meshes_.empty()) {
      document["meshes"] = std::move(meshes_);
      document["accessors"] = std::move(accessors_);
      document["bufferViews"] = std::move(views_);
      document["buffers"] = Json::array({{{"byteLength", body_.size()}}});
      document["materials"] =
          Json::array({{{"name", "surface"},
                        {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
                        {"doubleSided", true}}});
    }
    return head_of(document);
  }

 private:
  /// glTF has y up: the shortest turn that takes the world's up there, as a quaternion x y z w.
  static Json upright(const Eigen::Vector3f& up) {
    const auto turn = shortest_turn(up, Eigen::Vector3f::UnitY()).normalized();
    return Json::array({turn.x(), turn.y(), turn.z(), turn.w()});
  }

  /// `begin`: of its numbers in buffer_, up to the end of which they go.
  std::size_t add_accessor(std::size_t begin, std::size_t count, int component, const char* type,
                           int target) {
    views_.push_back({{"buffer", 0},
                      {"byteOffset", body_.size() + begin},
                      {"byteLength", buffer_.size() - begin},
                      {"target", target}});
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return accessors_.size() - 1;
  }

  std::size_t add_positions(const std::vector<Eigen::Vector3f>& points) {
    const std::size_t begin = buffer_.size();
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& point : points) {
      append(buffer_, point);
      box.extend(point);
    }
    const std::size_t accessor = add_accessor(begin, points.size(), kFloat, "VEC3", kVertices);
    accessors_[accessor]["min"] = vector_json(box.min());
    accessors_[accessor]["max"] = vector_json(box.max());
    return accessor;
  }

  /// The specification wants normals of length 1; where the surface gives none, any will do.
  std::size_t add_normals(const std::vector<Eigen::Vector3f>& normals) {
    const std::size_t begin = buffer_.size();
    for (const Eigen::Vector3f& normal : normals) {
      const float length = normal.norm();
      append(buffer_, length > 1e-3f && std::isfinite(length)
                          ? Eigen::Vector3f(normal / length)
                          : Eigen::Vector3f(Eigen::Vector3f::UnitZ()));
    }
    return add_accessor(begin, normals.size(), kFloat, "VEC3", kVertices);
  }

  std::size_t add_colors(const std::vector<std::array<std::uint8_t, 3>>& colors) {
    static const std::array<std::uint16_t, 256> linear = linear_table();
    const std::size_t begin = buffer_.size();
    for (const auto& color : colors) {
      for (const std::uint8_t channel : color) append(buffer_, linear[channel], 2);
      append(buffer_, 65535, 2);
    }
    const std::size_t accessor =
        add_accessor(begin, colors.size(), kUnsignedShort, "VEC4", kVertices);
    accessors_[accessor]["normalized"] = true;
    return accessor;
  }

  std::size_t add_indices(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const std::size_t begin = buffer_.size();
    for (const auto& triangle : triangles)
      for (const std::uint32_t corner : triangle) append(buffer_, corner);
    return add_accessor(begin, 3 * triangles.size(), kUnsignedInt, "SCALAR", kIndices);
  }

  static void check_size(std::uint64_t size) {
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw Error(
          "the map is too large for one GLB, which ends at 4 GiB; export .ply or a folder instead");
  }

  Bytes head_of(const Json& document) const {
    std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    const std::uint64_t binary = body_.size() == 0 ? 0 : kChunkHeader + body_.size();
    const std::uint64_t size = kHeader + kChunkHeader + text.size() + binary;
    check_size(size);
    Bytes head;
    for (const std::uint32_t word : {kGlbMagic, std::uint32_t{2}, static_cast<std::uint32_t>(size),
                                     static_cast<std::uint32_t>(text.size()), kJsonChunk})
      append(head, word);
    head.insert(head.end(), text.begin(), text.end());
    if (binary == 0) return head;
    append(head, static_cast<std::uint32_t>(body_.size()));
    append(head, kBinaryChunk);
    return head;
  }

  ScratchFile& body_;
  Bytes buffer_;  ///< of the mesh that is being added
  Json nodes_ = Json::array(), meshes_ = Json::array(), accessors_ = Json::array(),
       views_ = Json::array();
};

/// Fills `body` and returns what stands before it. Pieces of objects wait beside `target`.
Bytes glb_head(const std::filesystem::path& target, const MeshParts& parts,
               const ExportedObjects& objects, ScratchFile& body) {
  const LabelledPieces pieces(parts, target);
  GlbBuilder builder(body);
  const auto known_parts = parts_by_object(objects.parts, objects.instances);
  for (const InstanceSummary& instance : objects.instances) {
    Json extras = instance_json_value(instance, objects.titles);
    if (const auto of_it = known_parts.find(instance.id); of_it != known_parts.end())
      for (Json part : parts_json_value(of_it->second)) {
        part.erase("superpoints");
        extras["parts"].push_back(std::move(part));
      }
    extras.erase("superpoints");
    const std::string title = objects.titles.title_of(instance.id);
    builder.add_node(concat(title.empty() ? "object" : title, " ", instance.id),
                     pieces.piece(instance.id), std::move(extras));
  }
  builder.add_node("background", pieces.piece(0), nullptr);
  return builder.finish(objects.up);
}

}  // namespace

std::string encode_glb(const MeshParts& parts, const ExportedObjects& objects) {
  const auto target = std::filesystem::temp_directory_path() / "ovimap.glb";
  ScratchFile body(target);
  const Bytes head = glb_head(target, parts, objects, body);
  std::string file(head.begin(), head.end());
  file.resize(head.size() + body.size());
  body.read(0, {reinterpret_cast<std::uint8_t*>(file.data()) + head.size(), body.size()});
  return file;
}

void write_glb(const std::filesystem::path& path, const MeshParts& parts,
               const ExportedObjects& objects) {
  ScratchFile body(path);
  const Bytes head = glb_head(path, parts, objects, body);
  write_file(path, head, {&body});
}

}  // namespace ovimap
