// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/furniture/furniture_model.h"

#include <algorithm>
#include <cstring>
#include <map>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <Eigen/Geometry>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/synth/furniture/zip_archive.h"

namespace ovimap {
namespace {

constexpr float kClearOpacity = 0.55f;     // below: glass
constexpr float kSmoothingAngle_deg = 45;  // models without normals: sharper edges stay edges
constexpr float kBlackAlbedo = 0.004f;     // a black colour under a texture that is missing
constexpr float kUnknownAlbedo = 0.35f;

/// A file in memory, as assimp reads it.
class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(Bytes bytes) : bytes_(std::move(bytes)) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    const std::size_t available = (bytes_.size() - position_) / std::max<std::size_t>(size, 1);
    const std::size_t items = std::min(count, available);
    std::memcpy(buffer, bytes_.data() + position_, items * size);
    position_ += items * size;
    return items;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t start = origin == aiOrigin_CUR   ? position_
                              : origin == aiOrigin_END ? bytes_.size()
                                                       : 0;
    if (start + offset > bytes_.size()) return aiReturn_FAILURE;
    position_ = start + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return position_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  Bytes bytes_;
  std::size_t position_ = 0;
};

/// The archive as assimp's file system, so that an OBJ finds its MTL without unpacking anything.
class ArchiveFiles final : public Assimp::IOSystem {
 public:
  explicit ArchiveFiles(const ZipArchive& archive) : archive_(archive) {}

  bool Exists(const char* name) const override { return archive_.contains(name); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    auto bytes = archive_.read(name);
    return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  const ZipArchive& archive_;
};

Eigen::Vector3f vector_of(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

class MaterialLoader {
 public:
  MaterialLoader(const ZipArchive& archive, const std::string& model)
      : archive_(archive), folder_(std::filesystem::path(model).parent_path().string()) {}

  SurfaceMaterial load(const aiMaterial& source) {
    SurfaceMaterial material;
    aiColor3D diffuse(kUnknownAlbedo, kUnknownAlbedo, kUnknownAlbedo);
    source.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    for (int i = 0; i < 3; ++i) {
      const float value = std::clamp(diffuse[static_cast<unsigned>(i)], 0.f, 1.f);
      material.albedo[i] = linear_from_srgb(static_cast<std::uint8_t>(value * 255 + 0.5f));
    }
    aiString name;
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS) return material;
    material.texture = texture(name.C_Str());
    if (!material.texture && material.albedo.maxCoeff() < kBlackAlbedo)
      material.albedo.setConstant(kUnknownAlbedo);
    return material;
  }

 private:
  std::shared_ptr<const Texture> texture(std::string name) {
    name.erase(name.find_last_not_of(" \t\r") + 1);
    const auto [found, is_new] = textures_.try_emplace(name);
    if (is_new)
      if (const auto bytes = archive_.read(folder_ + "/" + name))
        found->second = std::make_shared<Texture>(decode_rgb(*bytes));
    return found->second;
  }

  const ZipArchive& archive_;
  std::string folder_;
  std::map<std::string, std::shared_ptr<const Texture>> textures_;
};

bool is_clear(const aiMaterial& material) {
  float opacity = 1;
  material.Get(AI_MATKEY_OPACITY, opacity);
  return opacity < kClearOpacity;
}

void append_part(const aiMesh& part, std::uint32_t material, TexturedMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    mesh.vertices.push_back(vector_of(part.mVertices[i]));
    mesh.normals.push_back(part.HasNormals() ? vector_of(part.mNormals[i])
                                             : Eigen::Vector3f::UnitY());
    const bool has_uv = part.HasTextureCoords(0);
    mesh.uvs.push_back(has_uv ? Eigen::Vector2f(vector_of(part.mTextureCoords[0][i]).head<2>())
                              : Eigen::Vector2f::Zero());
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    mesh.triangles.push_back(
        {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    mesh.triangle_materials.push_back(material);
  }
}

/// From the model's axes (y up, front +z) to ours (z up, front -y), at the catalogue's size. The
/// box that is scaled to that size is the one of all parts, clear ones included.
void normalise(const FurnitureEntry& entry, const Eigen::AlignedBox3f& box, TexturedMesh& mesh) {
  const Eigen::Vector3f wanted(entry.size_m.x(), entry.size_m.z(), entry.size_m.y());
  Eigen::Vector3f scale = Eigen::Vector3f::Ones();
  for (int i = 0; i < 3; ++i)
    if (box.sizes()[i] > 0) scale[i] = wanted[i] / box.sizes()[i];
  const Eigen::Vector3f base(box.center().x(), box.min().y(), box.center().z());
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3f p = (entry.model_rotation * vertex - base).cwiseProduct(scale);
    vertex = {p.x(), -p.z(), p.y()};
  }
  for (Eigen::Vector3f& normal : mesh.normals) {
    const Eigen::Vector3f n = (entry.model_rotation * normal).cwiseQuotient(scale);
    normal = Eigen::Vector3f(n.x(), -n.z(), n.y()).normalized();
    if (!normal.allFinite()) normal = Eigen::Vector3f::UnitZ();
  }
}

TexturedMesh mesh_of(const aiScene& scene, const FurnitureEntry& entry, const ZipArchive& archive) {
  MaterialLoader materials(archive, entry.model);
  TexturedMesh mesh;
  std::vector<bool> clear;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    clear.push_back(is_clear(*scene.mMaterials[i]));
    mesh.materials.push_back(clear.back() ? SurfaceMaterial{}
                                          : materials.load(*scene.mMaterials[i]));
  }
  Eigen::AlignedBox3f box;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[i];
    for (unsigned k = 0; k < part.mNumVertices; ++k)
      box.extend(entry.model_rotation * vector_of(part.mVertices[k]));
    if (!clear[part.mMaterialIndex]) append_part(part, part.mMaterialIndex, mesh);
  }
  normalise(entry, box, mesh);
  return mesh;
}

}  // namespace

TexturedMesh load_furniture_model(const FurnitureEntry& entry) {
  const ZipArchive archive(entry.archive);
  Assimp::Importer importer;
  importer.SetIOHandler(new ArchiveFiles(archive));  // the importer takes ownership
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothingAngle_deg);
  const std::string name = entry.model.substr(entry.model.find_first_not_of('/'));
  const aiScene* scene =
      importer.ReadFile(name, aiProcess_Triangulate | aiProcess_SortByPType |
                                  aiProcess_GenSmoothNormals | aiProcess_PreTransformVertices);
  if (scene == nullptr)
    throw Error(concat(entry.archive.string(), ": model ", entry.model, " cannot be read (",
                       importer.GetErrorString(), "); reinstall sweethome3d-furniture"));
  TexturedMesh mesh = mesh_of(*scene, entry, archive);
  if (mesh.triangles.empty())
    throw Error(concat(entry.archive.string(), ": model ", entry.model, " has no visible surface"));
  return mesh;
}

}  // namespace ovimap
