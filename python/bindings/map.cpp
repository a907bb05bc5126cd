// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/map.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "arrays.h"
#include "bindings.h"
#include "encoders.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/glb.h"
#include "ovimap/io/exports/instance_csv.h"
#include "ovimap/io/exports/instance_json.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/mesh/map_mesh.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/pipeline/search/object_labels.h"
#include "ovimap/pipeline/search/teaching.h"
#include "saved_map.h"
#include "settings.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

using Points = nb::ndarray<nb::numpy, const float, nb::shape<-1, 3>>;
using Colors = nb::ndarray<nb::numpy, const std::uint8_t, nb::shape<-1, 3>>;
using Triangles = nb::ndarray<nb::numpy, const std::uint32_t, nb::shape<-1, 3>>;
using Ids = nb::ndarray<nb::numpy, const std::uint32_t, nb::ndim<1>>;
using Counts = nb::ndarray<nb::numpy, const std::int64_t, nb::ndim<1>>;
using Shares = nb::ndarray<nb::numpy, const float, nb::ndim<1>>;
using Boxes = nb::ndarray<nb::numpy, const float, nb::shape<-1, 2, 3>>;

/// The objects of a map, one row each.
struct Instances {
  std::vector<std::uint32_t> ids;
  std::vector<float> boxes, centroids, confidences;
  std::vector<std::int64_t> points, views;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> writing;
};

Instances instances_of(const SavedMap& map) {
  Instances all;
  for (const InstanceSummary& instance : map.info().instances) {
    all.ids.push_back(instance.id);
    for (const Eigen::Vector3f& corner : {instance.box.min(), instance.box.max()})
      all.boxes.insert(all.boxes.end(), corner.begin(), corner.end());
    all.centroids.insert(all.centroids.end(), instance.centroid.begin(), instance.centroid.end());
    all.points.push_back(static_cast<std::int64_t>(instance.points));
    all.views.push_back(instance.views);
    all.confidences.push_back(
        instance.confidence.value_or(std::numeric_limits<float>::quiet_NaN()));
    const auto name = map.info().names.find(instance.id);
    all.names.push_back(name == map.info().names.end() ? "" : name->second);
    std::vector<std::string>& texts = all.writing.emplace_back();
    if (const auto read = map.info().writing.find(instance.id); read != map.info().writing.end())
      for (const WrittenLine& line : read->second) texts.push_back(line.text);
  }
  return all;
}

void bind_instances(nb::module_& module) {
  nb::class_<Instances>(module, "Instances",
                        "The objects of a map, one row each. World frame, metres.")
      .def("__len__", [](const Instances& all) { return all.ids.size(); })
      .def_prop_ro(
          "ids",
          [](const Instances& all) {
            return view<Ids>(all.ids.data(), {all.ids.size()}, nb::find(all));
          },
          "uint32 [objects]")
      .def_prop_ro(
          "boxes",
          [](const Instances& all) {
            return view<Boxes>(all.boxes.data(), {all.ids.size(), 2, 3}, nb::find(all));
          },
          "float32 [objects, 2, 3]: the lowest corner and the highest")
      .def_prop_ro(
          "centroids",
          [](const Instances& all) {
            return view<Points>(all.centroids.data(), {all.ids.size(), 3}, nb::find(all));
          },
          "float32 [objects, 3]")
      .def_prop_ro(
          "points",
          [](const Instances& all) {
            return view<Counts>(all.points.data(), {all.ids.size()}, nb::find(all));
          },
          "int64 [objects]: surface voxels")
      .def_prop_ro(
          "views",
          [](const Instances& all) {
            return view<Counts>(all.views.data(), {all.ids.size()}, nb::find(all));
          },
          "int64 [objects]: frames in which it was seen")
      .def_prop_ro(
          "confidences",
          [](const Instances& all) {
            return view<Shares>(all.confidences.data(), {all.ids.size()}, nb::find(all));
          },
          "float32 [objects]: how sure masks are that it is one whole thing, 0 to 1; NaN where "
          "nobody "
          "rated them, and of what a person put together")
      .def_ro("names", &Instances::names, "given by people; empty strings otherwise")
      .def_ro("writing", &Instances::writing, "texts that `ovimap read` read on each, surest first")
      .def("__repr__", [](const Instances& all) {
        const auto named = std::count_if(all.names.begin(), all.names.end(),
                                         [](const std::string& name) { return !name.empty(); });
        return concat("Instances(", all.ids.size(), " objects, ", named, " named)");
      });
}

void bind_mesh(nb::module_& module) {
  nb::class_<Mesh>(module, "Mesh", "A triangle mesh in the world frame, metres. Arrays are views.")
      .def_prop_ro(
          "vertices",
          [](const Mesh& mesh) {
            return view<Points>(mesh.vertices.empty() ? nullptr : mesh.vertices[0].data(),
                                {mesh.vertices.size(), 3}, nb::find(mesh));
          },
          "float32 [vertices, 3]")
      .def_prop_ro(
          "normals",
          [](const Mesh& mesh) {
            return view<Points>(mesh.normals.empty() ? nullptr : mesh.normals[0].data(),
                                {mesh.normals.size(), 3}, nb::find(mesh));
          },
          "float32 [vertices, 3], unit length, outward; may be empty")
      .def_prop_ro(
          "colors",
          [](const Mesh& mesh) {
            return view<Colors>(mesh.colors.empty() ? nullptr : mesh.colors[0].data(),
                                {mesh.colors.size(), 3}, nb::find(mesh));
          },
          "uint8 [vertices, 3], red first; may be empty")
      .def_prop_ro(
          "labels",
          [](const Mesh& mesh) {
            return view<Ids>(mesh.labels.data(), {mesh.labels.size()}, nb::find(mesh));
          },
          "uint32 [vertices]: instance id, 0 = none; may be empty")
      .def_prop_ro(
          "triangles",
          [](const Mesh& mesh) {
            return view<Triangles>(mesh.triangles.empty() ? nullptr : mesh.triangles[0].data(),
                                   {mesh.triangles.size(), 3}, nb::find(mesh));
          },
          "uint32 [triangles, 3]: vertex indices, counter-clockwise from outside")
      .def("__repr__", [](const Mesh& mesh) {
        return concat("Mesh(", mesh.vertices.size(), " vertices, ", mesh.triangles.size(),
                      " triangles", mesh.colors.empty() ? "" : ", colours",
                      mesh.labels.empty() ? "" : ", labels", ")");
      });
}

ObjectTitles titles_of(SavedMap& map) {
  return {map.info().names, labels_of(map.index(), map.guessed_names())};
}

std::string objects_json(SavedMap& map) {
  const auto relations = find_relations(ids_of(map.index()), map.scene().shapes.whole());
  return scene_json(map.path(), map.info(), titles_of(map).labels, relations) + "\n";
}

void export_map(SavedMap& map, const std::filesystem::path& out) {
  const std::string ending = out.extension().string();
  const MapInfo& info = map.info();
  if (ending == ".ply" || ending == ".glb") {
    const MapDocument document = load_corrected_map(map.path());
    const MeshParts parts = visible_parts(document, map.path());
    if (ending == ".ply") return write_ply(out, parts);
    const ObjectTitles titles = titles_of(map);
    return write_glb(out, parts, {document.instances, document.parts, titles, document.up});
  }
  if (ending == ".json") return write_text(out, objects_json(map));
  if (ending == ".csv") return write_text(out, instances_csv(info.instances, titles_of(map)));
  throw Error(concat("cannot export to '", out.string(),
                     "'; the name must end in .ply, .glb, .json or .csv (`ovimap export` knows "
                     "more)"));
}

std::string hash_text(const SavedMap& map) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(map.info().content_hash));
  return text;
}

std::string counted(std::size_t count, const char* thing) {
  return concat(count, " ", thing, count == 1 ? "" : "s");
}

/// Map('room.ovimap': 12 objects from 60 frames, embeddings of 'default-encoder'; 2 skipped: ...).
std::string map_text(const SavedMap& map) {
  const std::string& encoder = map.info().encoder.name;
  std::string text =
      concat("Map('", map.path().string(), "': ", counted(map.index().size(), "object"), " from ",
             counted(static_cast<std::size_t>(map.info().frames), "frame"), ", ");
  text += encoder.empty() ? "no embeddings" : concat("embeddings of '", encoder, "'");
  std::string reasons;
  std::size_t skipped = 0;
  for (const FaultCount& fault : map.skipped) {
    skipped += static_cast<std::size_t>(fault.frames);
    reasons += concat(reasons.empty() ? "" : ", ", fault.frames, " ", fault.phrase);
  }
  if (skipped > 0) text += concat("; ", counted(skipped, "frame"), " skipped: ", reasons);
  return text + ")";
}

std::map<std::string, std::int64_t> skipped_by_reason(const SavedMap& map) {
  std::map<std::string, std::int64_t> counts;
  for (const FaultCount& fault : map.skipped) counts[fault.phrase] += fault.frames;
  return counts;
}

std::shared_ptr<SavedMap> open_map(const nb::object& path, const nb::object& encoder,
                                   const Settings& settings, const nb::object& model_dirs,
                                   const nb::object& teach) {
  const std::filesystem::path file = to_path(path, "path");
  const auto config = configured<QueryConfig>(settings);
  const auto folders = to_paths(model_dirs, "model_dirs");
  const bool object = !encoder.is_none() && is_encoder_object(encoder);
  const auto made = object ? to_encoder(encoder) : nullptr;
  const std::string spec = object              ? ""
                           : encoder.is_none() ? "none"
                                               : to_path(encoder, "encoder").string();
  const std::filesystem::path taught = nb::isinstance<nb::bool_>(teach)
                                           ? (nb::cast<bool>(teach) ? default_taught_file() : "")
                                           : to_path(teach, "teach");
  const WithoutGil release;
  return std::make_shared<SavedMap>(file, config, made, spec, folders, taught);
}

void bind_properties(nb::class_<SavedMap>& map) {
  map.def_prop_ro("path", [](const SavedMap& self) { return self.path().string(); })
      .def("__len__", [](const SavedMap& self) { return self.index().size(); })
      .def("__repr__", &map_text)
      .def_prop_ro(
          "frames", [](const SavedMap& self) { return self.info().frames; }, "frames in the map")
      .def_prop_ro("skipped", &skipped_by_reason,
                   "frames that ovimap.run left out, by reason; empty for a map that was opened")
      .def_prop_ro(
          "mask_frames", [](const SavedMap& self) { return self.info().mask_frames; },
          "frames with 2D masks")
      .def_prop_ro(
          "source", [](const SavedMap& self) { return self.info().source; },
          "where the frames came from")
      .def_prop_ro(
          "config_text", [](const SavedMap& self) { return self.info().config_text; },
          "the settings that made the map")
      .def_prop_ro("voxel_size_m", [](const SavedMap& self) { return self.info().voxel_size_m; })
      .def_prop_ro("content_hash", &hash_text, "16 hexadecimal digits: equal maps have equal ones")
      .def_prop_ro(
          "encoder", [](const SavedMap& self) { return self.info().encoder.name; },
          "of the embeddings; empty: there are none")
      .def_prop_ro("camera", [](const SavedMap& self) { return self.info().depth_camera; })
      .def_prop_ro("instances", &instances_of, "the objects, as arrays")
      .def_prop_ro(
          "embeddings",
          [](const SavedMap& self) {
            const Embeddings& rows = self.index().embeddings();
            return view<EmbeddingArray>(
                rows.data(),
                {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols())},
                nb::find(self));
          },
          "float32 [objects, dimension], rows of length 1, or of 0 for objects without one; a "
          "view");
}

}  // namespace

SavedMap::SavedMap(std::filesystem::path path, const QueryConfig& config,
                   std::shared_ptr<ImageTextEncoder> encoder, std::string encoder_spec,
                   std::vector<std::filesystem::path> model_dirs, std::filesystem::path taught)
    : path_(std::move(path)),
      config_(config),
      encoder_spec_(std::move(encoder_spec)),
      model_dirs_(std::move(model_dirs)),
      taught_(std::move(taught)),
      search_(open_map_search(path_)),
      encoder_(std::move(encoder)) {
  search_.scene.taught = taught_elsewhere(taught_, path_, search_.info.encoder);
  if (encoder_) require_encoder_of_map();
}

void SavedMap::require_encoder_of_map() const {
  const EncoderIdentity &mine = encoder_->identity(), &of_map = search_.info.encoder;
  if (of_map.name.empty() || mine == of_map) return;
  throw Error(concat("the map's embeddings are of encoder '", of_map.name, "' (", of_map.dimension,
                     " numbers), not of '", mine.name, "' (", mine.dimension,
                     " numbers); open the map with the one that made it"));
}

const QueryEngine& SavedMap::engine(bool words) {
  const std::lock_guard lock(mutex_);
  if (!words) {
    if (!object_engine_)
      object_engine_ = std::make_unique<QueryEngine>(search_.index, nullptr, config_, Embeddings(),
                                                     search_.scene);
    return *object_engine_;
  }
  if (!word_engine_) {
    require_embeddings(search_.index);
    if (!encoder_) encoder_ = encoder_of_map(search_.info.encoder, encoder_spec_, {}, model_dirs_);
    word_engine_ = std::make_unique<QueryEngine>(search_.index, encoder_.get(), config_,
                                                 Embeddings(), search_.scene);
  }
  return *word_engine_;
}

Mesh SavedMap::mesh() const {
  Mesh mesh = visible_mesh(load_corrected_map(path_));
  if (mesh.vertices.empty())
    throw Error(concat("map '", path_.string(), "' holds objects without a surface"));
  return mesh;
}

/// For ovimap.map_facts, which gives them names.
nb::tuple map_identity(const nb::object& path) {
  const std::filesystem::path file = to_path(path, "path");
  MapIdentity map;
  {
    const WithoutGil release;
    map = read_map_identity(file);
  }
  return nb::make_tuple(map.source, map.frames, map.unfinished, ovimap::hash_text(map.content_hash),
                        nb::make_tuple(map.encoder.name, map.encoder.dimension, map.encoder.digest),
                        ovimap::hash_text(map.revision));
}

void bind_map(nb::module_& module) {
  module.def("map_identity", &map_identity, nb::arg("path"),
             nb::sig("def map_identity(path: str | os.PathLike[str]) -> tuple[str, int, bool, str, "
                     "tuple[str, int, str], str]"));
  bind_instances(module);
  bind_mesh(module);
  nb::class_<SavedMap> map(module, "Map",
                           "A map file, open for questions. What people corrected is applied.");
  map.def_static(
         "open", &open_map, nb::arg("path"), nb::kw_only(), nb::arg("encoder") = "auto",
         nb::arg("settings") = nb::none(), nb::arg("model_dirs") = nb::list(),
         nb::arg("teach") = false,
         nb::sig(
             "def open(path: str | os.PathLike[str], *, encoder: typing.Any = 'auto', settings: "
             "dict[str, typing.Any] | None = None, model_dirs: typing.Sequence[str | "
             "os.PathLike[str]] = (), teach: bool | str | os.PathLike[str] = False) -> Map"),
         "Opens a map without reading its voxels. encoder: \"auto\" (the one that the map was made "
         "with, opened at the first question in words), a name, an ImageTextEncoder or an object "
         "as "
         "Mapper takes it. settings: as ovimap.settings(\"query\") lists them. teach: whether what "
         "people named "
         "in other maps speaks too, and corrections teach them: True, or a file (docs/query.md). "
         "Raises Error for what "
         "is no sound map.")
      .def("mesh", &SavedMap::mesh, nb::call_guard<WithoutGil>(),
           "Reads the voxels and extracts the surface, with instance ids as labels. Raises Error "
           "for a map without voxels.")
      .def(
          "export",
          [](SavedMap& self, const nb::object& path) {
            const std::filesystem::path out = to_path(path, "path");
            const WithoutGil release;
            export_map(self, out);
          },
          nb::arg("path"), nb::sig("def export(self, path: str | os.PathLike[str]) -> None"),
          "Writes the mesh as .ply or .glb (a named node per object), or the list of objects as "
          ".json or .csv.");
  bind_properties(map);
  module.def(
      "note_skipped",
      [](SavedMap& made, const std::vector<std::string>& faults) {
        made.skipped = count_faults(faults);
      },
      nb::arg("made"), nb::arg("faults"),
      nb::sig("def note_skipped(made: Map, faults: list[str]) -> None"),
      "What Map.skipped says: \"FILE: REASON\" of each frame that was left out.");
  bind_query(module, map);
  bind_objects(module, map);
  bind_approach(module, map);
  bind_scene(map);
  bind_history(module, map);
}

}  // namespace ovimap::python
