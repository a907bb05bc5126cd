// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/map_search.h"

#include <unordered_map>

#include "ovimap/base/error.h"
#include "ovimap/inference/encoders/text_cache.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/pipeline/rooms/map_rooms.h"
#include "ovimap/semantics/words/written_words.h"

namespace ovimap {

namespace {

SearchIndex index_of(const SearchableMap& map) {
  std::vector<SearchObject> objects;
  for (const InstanceSummary& instance : map.info.instances) {
    const auto name = map.info.names.find(instance.id);
    objects.push_back({instance.id, instance.box, instance.centroid, instance.points,
                       name == map.info.names.end() ? "" : name->second});
  }
  return SearchIndex(std::move(objects), map.embeddings);
}

QueryScene scene_of(const SearchableMap& map, const SearchIndex& index) {
  QueryScene scene;
  scene.shapes = map.shapes;
  if (!map.info.writing_reader.empty()) {
    scene.writing.resize(index.size());
    for (std::size_t i = 0; i < index.size(); ++i)
      if (const auto lines = map.info.writing.find(index.object(i).id);
          lines != map.info.writing.end())
        scene.writing[i] = lines->second;
  }
  if (!map.info.things.empty()) {
    scene.things.words = map.info.recognizer.things;
    scene.things.log_ratios =
        Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(index.size()),
                              static_cast<Eigen::Index>(map.info.recognizer.things.size()));
    for (std::size_t i = 0; i < index.size(); ++i)
      if (const auto seen = map.info.things.find(index.object(i).id); seen != map.info.things.end())
        scene.things.log_ratios.row(static_cast<Eigen::Index>(i)) = seen->second.transpose();
  }
  std::vector<Pose> cameras;
  for (const FrameLogEntry& frame : map.frames) cameras.push_back(frame.world_from_camera);
  if (!cameras.empty()) scene.viewpoint = mean_viewpoint(ground_from_world(map.info.up), cameras);
  return scene;
}

/// Null where no object has parts.
std::shared_ptr<const QueryParts> parts_of(const SearchableMap& map, const SearchIndex& index) {
  auto parts = std::make_shared<QueryParts>();
  std::vector<SearchObject> objects;
  std::vector<Eigen::Index> rows;
  for (const auto& [id, of_object] : parts_by_object(map.info.parts, map.info.instances))
    for (std::size_t i = 0; i < of_object.size(); ++i) {
      const ObjectPart* const part = of_object[i];
      parts->owners.push_back(*index.find(id));
      parts->numbers.push_back(static_cast<int>(i) + 1);
      objects.push_back({part->id, part->box, part->centroid, part->points, ""});
      rows.push_back(part - map.info.parts.data());
    }
  if (objects.empty()) return nullptr;
  parts->index = SearchIndex(std::move(objects), map.part_embeddings(rows, Eigen::all));
  parts->scene = scene_of_boxes(parts->index, map.info.up);
  return parts;
}

/// The largest crop of each object that keeps one.
std::vector<StoredCrop> crops_of(const SuperPointLooks& looks,
                                 std::span<const InstanceSummary> instances) {
  std::vector<StoredCrop> crops;
  for (const InstanceSummary& instance : instances) {
    const ObjectView* largest = nullptr;
    for (const ObjectView* view : appearance_of(looks, instance.super_points).views)
      if (!view->crop.empty() && (!largest || view->visible_px > largest->visible_px))
        largest = view;
    crops.push_back(largest ? largest->crop : StoredCrop{});
  }
  return crops;
}

MapSearch search_in(SearchableMap&& map) {
  MapSearch search;
  search.index = index_of(map);
  search.scene = scene_of(map, search.index);
  search.scene.parts = parts_of(map, search.index);
  search.info = std::move(map.info);
  return search;
}

/// The folder of the model on the search path that is the map's encoder, or at least bears its
/// name. A map without embeddings takes the default.
std::string model_of_map(const EncoderIdentity& wanted,
                         const std::vector<std::filesystem::path>& model_dirs) {
  if (wanted.name.empty()) return "default";
  std::string namesake;
  for (const ModelListing& listing : list_models(model_search_path(model_dirs))) {
    if (listing.kind != "dual_encoder") continue;
    const ModelFolder model = read_model_folder(listing.folder);
    if (model.name != wanted.name) continue;
    if (model.digest() == wanted.digest) return listing.folder.string();
    if (namesake.empty()) namesake = listing.folder.string();
  }
  if (!namesake.empty()) return namesake;
  throw Error(concat("the map's embeddings are of encoder '", wanted.name,
                     "', which is not on this machine; name its folder with --encoder or "
                     "--model-dir, or run `ovimap reembed` to use another"));
}

}  // namespace

std::vector<InstanceId> ids_of(const SearchIndex& index) {
  std::vector<InstanceId> ids;
  for (const SearchObject& object : index.objects()) ids.push_back(object.id);
  return ids;
}

MapSearch open_map_search(const std::filesystem::path& map) {
  MapSearch search = search_in(read_searchable_map(map));
  search.scene.colors =
      std::make_shared<const ObjectColors>([map, instances = search.info.instances] {
        return crops_of(load_map_without_voxels(map).semantics.looks, instances);
      });
  search.scene.rooms = std::make_shared<const ObjectRooms>([map, ids = ids_of(search.index)] {
    const StandingSpace space = make_standing_space(load_corrected_map(map));
    return rooms_of_objects(find_rooms(space.grid), space, ids);
  });
  return search;
}

MapSearch make_map_search(const MapRecord& corrected, MapInfo info) {
  SearchableMap map;
  info.instances = corrected.instances;
  info.hidden = corrected.hidden;
  info.locked = corrected.locked;
  info.parts = corrected.parts;
  info.names = corrected.names;
  info.writing_reader = corrected.semantics.writing_reader;
  info.writing.clear();
  info.recognizer = corrected.semantics.recognizer;
  info.things.clear();
  for (const InstanceSummary& instance : corrected.instances) {
    const Appearance look = appearance_of(corrected.semantics.looks, instance.super_points);
    if (auto lines = writing_of(look); !lines.empty())
      info.writing.emplace(instance.id, std::move(lines));
    if (auto things = things_of(look.views); things.size() > 0)
      info.things.emplace(instance.id, std::move(things));
  }
  info.encoder = corrected.semantics.encoder;
  info.up = corrected.up;
  info.frames = static_cast<std::int64_t>(corrected.frames.size());
  info.mask_frames = corrected.mask_frames;
  info.depth_camera = corrected.depth_camera;
  map.embeddings =
      fused_embeddings(corrected.semantics.looks, corrected.instances,
                       corrected.semantics.views.fusion, corrected.semantics.encoder.dimension);
  map.part_embeddings =
      fused_embeddings(corrected.semantics.looks, corrected.parts, corrected.semantics.views.fusion,
                       corrected.semantics.encoder.dimension);
  map.shapes =
      ObjectShapes(shapes_of_instances(corrected.up, corrected.instances, corrected.surfaces));
  map.frames = corrected.frames;
  map.info = std::move(info);
  MapSearch search = search_in(std::move(map));
  search.scene.colors = std::make_shared<const ObjectColors>(
      [crops = crops_of(corrected.semantics.looks, corrected.instances)] { return crops; });
  return search;
}

std::unique_ptr<ImageTextEncoder> encoder_of_map(
    const EncoderIdentity& of_map, const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs) {
  auto encoder = make_image_text_encoder(spec == "auto" ? model_of_map(of_map, model_dirs) : spec,
                                         runtime, model_dirs, EncoderUse::kTexts);
  if (!encoder || of_map.name.empty() || encoder->identity() == of_map)
    return encoder ? remember_text_lists(std::move(encoder), user_cache_folder()) : nullptr;
  throw Error(
      concat("the map's embeddings are of encoder '", of_map.name, "' (", of_map.dimension,
             " numbers), not of '", encoder->identity().name, "' (", encoder->identity().dimension,
             " numbers, other files); name that one with --encoder, or run `ovimap reembed`"));
}

std::unique_ptr<ImageTextEncoder> needed_encoder_of_map(
    const EncoderIdentity& of_map, const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs) {
  if (auto encoder = encoder_of_map(of_map, spec, runtime, model_dirs)) return encoder;
  throw Error(concat("--encoder '", spec,
                     "' names no encoder, and this cannot be done without; name one, or leave the "
                     "option out for the map's own"));
}

void color_by_relevance(Mesh& mesh, const SearchIndex& index, const Eigen::VectorXf& relevance) {
  OVIMAP_ASSERT(static_cast<std::size_t>(relevance.size()) == index.size());
  std::unordered_map<std::uint32_t, Rgb8> colors;
  for (std::size_t i = 0; i < index.size(); ++i)
    colors[index.object(i).id] = heat_color(relevance[static_cast<Eigen::Index>(i)]);
  const Rgb8 cold = heat_color(0.f);
  mesh.colors.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.labels.size(); ++v) {
    const auto known = colors.find(mesh.labels[v]);
    const Rgb8 color = known == colors.end() ? cold : known->second;
    mesh.colors[v] = {color.r, color.g, color.b};
  }
}

}  // namespace ovimap
