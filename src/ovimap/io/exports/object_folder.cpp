// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/object_folder.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/instance_json.h"
#include "ovimap/io/exports/instance_json_value.h"
#include "ovimap/io/mesh/labelled_pieces.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path plain(const fs::path& folder) {
  return folder.has_filename() ? fs::absolute(folder) : fs::absolute(folder).parent_path();
}

/// "12" or, with a title, "12_tea-pot": safe on every file system.
std::string folder_name(InstanceId id, const std::string& title) {
  constexpr std::size_t kLongest = 40;
  std::string slug;
  for (const char c : title) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (kept || (!slug.empty() && slug.back() != '-')) slug += kept ? c : '-';
    if (slug.size() == kLongest) break;
  }
  while (!slug.empty() && slug.back() == '-') slug.pop_back();
  return concat(id, slug.empty() ? "" : "_", slug);
}

/// The mask as people can see it: white on the object.
Bytes visible_mask(const StoredCrop& crop) {
  const GrayPng stored = decode_gray(crop.mask_png);
  Image<std::uint8_t> mask(stored.values.width(), stored.values.height());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = stored.values[i] != 0 ? 255 : 0;
  return encode_png(mask);
}

Json write_crops(const fs::path& folder, const Appearance& look) {
  std::vector<const ObjectView*> views;
  for (const ObjectView* view : look.views)
    if (!view->crop.empty()) views.push_back(view);
  std::stable_sort(views.begin(), views.end(), [](const ObjectView* a, const ObjectView* b) {
    return a->visible_px > b->visible_px;
  });
  Json list = Json::array();
  for (const ObjectView* view : views) {
    const std::string name = concat("crop_", list.size() + 1);
    const Eigen::AlignedBox2i& box = view->crop.object_px;
    Json entry = {{"file", name + ".jpg"},
                  {"mask", nullptr},
                  {"frame", view->frame},
                  {"visible_px", view->visible_px},
                  {"box_px", {box.min().x(), box.min().y(), box.max().x(), box.max().y()}}};
    write_file(folder / (name + ".jpg"), view->crop.image_jpeg);
    if (!view->crop.mask_png.empty()) {
      write_file(folder / (name + "_mask.png"), visible_mask(view->crop));
      entry["mask"] = name + "_mask.png";
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json relations_of(InstanceId id, std::span<const ObjectRelation> relations) {
  Json list = Json::array();
  for (const ObjectRelation& relation : relations)
    if (relation.object == id) list.push_back(relation_json_value(relation));
  return list;
}

class FolderWriter {
 public:
  explicit FolderWriter(const fs::path& target)
      : target_(target), temporary_(fs::path(target) += concat(".", ::getpid(), ".part")) {
    fs::create_directories(temporary_);
  }
  ~FolderWriter() {
    std::error_code ignored;
    fs::remove_all(temporary_, ignored);  // nothing there after finish
  }
  const fs::path& path() const { return temporary_; }
  void finish() {
    fs::remove(target_);  // only an empty folder goes
    fs::rename(temporary_, target_);
  }

 private:
  fs::path target_, temporary_;
};

}  // namespace

void check_new_folder(const fs::path& folder) {
  const fs::path target = plain(folder);
  std::error_code ignored;
  const auto refuse = [&](const char* why) {
    throw Error(concat("cannot write into '", folder.string(), "': ", why,
                       "; give a new folder, or one that is empty"));
  };
  if (fs::exists(target, ignored) && !fs::is_directory(target, ignored)) refuse("it is no folder");
  if (fs::is_directory(target, ignored) && !fs::is_empty(target, ignored))
    refuse("it is not empty");
  check_file_target(fs::path(target) += ".check");
}

void write_object_folder(const fs::path& folder, const MapRecord& map, const ObjectLabels& labels,
                         const MeshParts& parts, std::span<const ObjectRelation> relations,
                         const std::string& scene_text) {
  check_new_folder(folder);
  FolderWriter writer(plain(folder));
  const ObjectTitles titles{map.names, labels};
  const LabelledPieces pieces(parts, writer.path() / "pieces");
  const auto known_parts = parts_by_object(map.parts, map.instances);
  for (const InstanceSummary& instance : map.instances) {
    const fs::path place = writer.path() / folder_name(instance.id, titles.title_of(instance.id));
    fs::create_directory(place);
    if (const Mesh piece = pieces.piece(instance.id); !piece.triangles.empty())
      write_ply(place / "mesh.ply", piece);
    Json entry = instance_json_value(instance, titles);
    if (const auto of_it = known_parts.find(instance.id); of_it != known_parts.end())
      entry["parts"] = parts_json_value(of_it->second);
    entry["relations"] = relations_of(instance.id, relations);
    entry["crops"] = write_crops(place, appearance_of(map.semantics.looks, instance.super_points));
    write_text(place / "object.json",
               entry.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  write_text(writer.path() / "scene.json", scene_text);
  writer.finish();
}

}  // namespace ovimap
