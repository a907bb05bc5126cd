// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/io/pictures/place_picture.h"
#include "ovimap/pipeline/search/teaching.h"
#include "ovimap/semantics/query/query_grammar.h"
#include "ovimap/semantics/relations/scene_relations.h"
#include "ovimap/semantics/words/main_colors.h"
#include "saved_map.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

using Named = std::vector<std::pair<std::string, float>>;
using PartBox = std::pair<std::array<float, 3>, std::array<float, 3>>;

/// What a map knows of one object beside what Instances has.
struct ObjectFacts {
  InstanceId id = 0;
  std::string name, label;
  float label_share = 0, height_m = 0, footprint_m2 = 0;
  Named colors;
  std::vector<PartBox> parts;
};

ObjectFacts describe(SavedMap& map, InstanceId id) {
  const std::size_t position = map.position(id);
  const ObjectShape& shape = map.scene().shapes.outline(position);
  ObjectFacts facts;
  facts.id = id;
  facts.name = map.index().object(position).name;
  if (const auto& names = map.guessed_names(); position < names.size()) {
    facts.label = names[position].word;
    facts.label_share = names[position].share;
  }
  facts.height_m = shape.height_m();
  facts.footprint_m2 = area_m2(shape.footprint);
  if (map.scene().colors)
    for (const auto& [color, share] : main_colors(map.scene().colors->surfaces()[position].shares))
      facts.colors.emplace_back(color_name(color), share);
  for (const std::size_t p : map.scene().parts_of(position)) {
    const Eigen::AlignedBox3f& box = map.scene().parts->index.object(p).box;
    const Eigen::Vector3f center = box.center(), size = box.sizes();
    facts.parts.push_back({{center.x(), center.y(), center.z()}, {size.x(), size.y(), size.z()}});
  }
  return facts;
}

Named guess_names(SavedMap& map) {
  Named names;
  for (const ObjectName& name : map.guessed_names()) names.emplace_back(name.word, name.share);
  return names;
}

std::vector<ObjectRelation> relations(const SavedMap& map) {
  return find_relations(ids_of(map.index()), map.scene().shapes.whole());
}

std::vector<nb::bytes> crops(SavedMap& map, InstanceId id) {
  std::vector<Bytes> files;
  {
    const WithoutGil release;
    files = map.crops(id);
  }
  std::vector<nb::bytes> result;
  for (const Bytes& file : files) result.emplace_back(file.data(), file.size());
  return result;
}

nb::bytes place(SavedMap& map, InstanceId id) {
  constexpr int kQuality = 85;
  Bytes file;
  {
    const WithoutGil release;
    file = encode_jpeg(map.place(id), kQuality);
  }
  return nb::bytes(file.data(), file.size());
}

std::int64_t rename(const SavedMap& map, InstanceId id, const std::string& name) {
  MapEdit edit;
  edit.action = EditAction::kRename;
  edit.instances = {id};
  edit.name = name;
  return map.correct(std::move(edit));
}

std::int64_t merge(const SavedMap& map, InstanceId id, InstanceId into) {
  MapEdit edit;
  edit.action = EditAction::kMerge;
  edit.instances = {into, id};
  return map.correct(std::move(edit));
}

std::int64_t undo(const SavedMap& map, std::int64_t edit_number) {
  MapEdit edit;
  edit.action = EditAction::kUndo;
  edit.undoes = edit_number;
  return map.correct(std::move(edit));
}

void bind_object_values(nb::module_& module) {
  nb::class_<ObjectFacts>(module, "ObjectFacts", "What a map knows of one object.")
      .def_ro("id", &ObjectFacts::id)
      .def_ro("name", &ObjectFacts::name, "given by a person; empty: none")
      .def_ro("label", &ObjectFacts::label,
              "what it clearly is by its looks and size, else \"object\"; empty: not known")
      .def_ro("label_share", &ObjectFacts::label_share,
              "of all that speaks for any household word, in [0, 1]")
      .def_ro("colors", &ObjectFacts::colors,
              "names of its main colours and their shares of its surface, largest first")
      .def_ro("height_m", &ObjectFacts::height_m)
      .def_ro("parts", &ObjectFacts::parts,
              "centre and size of the box around each of its recognised parts, by their numbers")
      .def_ro("footprint_m2", &ObjectFacts::footprint_m2, "seen from above, convex")
      .def("__repr__", [](const ObjectFacts& facts) {
        return concat("ObjectFacts(id=", facts.id, ", name='", facts.name, "', label='",
                      facts.label, "')");
      });
  nb::class_<ObjectRelation>(module, "ObjectRelation", "\"object RELATION anchor\": 12 on 3.")
      .def_ro("object", &ObjectRelation::object, "id")
      .def_prop_ro(
          "relation", [](const ObjectRelation& self) { return relation_name(self.relation); },
          "on, inside, above, beside or near")
      .def_ro("anchor", &ObjectRelation::anchor, "id")
      .def_ro("score", &ObjectRelation::score, "0.5 on the border to 1")
      .def_ro("evidence", &ObjectRelation::evidence, "\"0.02 m above the top of #3\"")
      .def("__repr__", [](const ObjectRelation& self) {
        return concat("ObjectRelation(", self.object, " ", relation_name(self.relation), " ",
                      self.anchor, ")");
      });
}

void bind_corrections(nb::class_<SavedMap>& map) {
  map.def("rename", &rename, nb::arg("id"), nb::arg("name"), nb::call_guard<WithoutGil>(),
          "Names an object; an empty name takes the name away. Writes into the map's log of "
          "corrections (docs/edit.md) and returns the number of its line; reopened() shows it. "
          "Raises Error when it makes no sense in this map or cannot be written.")
      .def("merge", &merge, nb::arg("id"), nb::arg("into"), nb::call_guard<WithoutGil>(),
           "Makes two objects one, which keeps the id `into`. Otherwise as rename().")
      .def("undo", &undo, nb::arg("edit") = 0, nb::call_guard<WithoutGil>(),
           "Takes back that line of the log; 0: the latest that has an effect. Otherwise as "
           "rename().");
}

}  // namespace

std::int64_t SavedMap::correct(MapEdit edit) const {
  const std::int64_t line = edit_map(path_, std::move(edit)).id;
  if (!taught_.empty()) teach(taught_, path_, open_map_search(path_));
  return line;
}

std::shared_ptr<SavedMap> SavedMap::reopened() {
  auto fresh =
      std::make_shared<SavedMap>(path_, config_, nullptr, encoder_spec_, model_dirs_, taught_);
  const std::lock_guard lock(mutex_);
  const bool given = encoder_spec_.empty();
  if (encoder_ && (given || encoder_->identity() == fresh->info().encoder)) {
    fresh->encoder_ = encoder_;
    fresh->require_encoder_of_map();
  }
  return fresh;
}

const std::vector<ObjectName>& SavedMap::guessed_names() {
  const std::lock_guard lock(details_mutex_);
  if (names_) return *names_;
  names_.emplace();
  try {
    const TextMatcher* matcher = engine(true).matcher();  // null where no encoder is wanted
    if (matcher && matcher->evidence()) names_ = name_objects(*matcher->evidence());
  } catch (const Error&) {  // a search in words says why; names are an extra
  }
  return *names_;
}

std::vector<Bytes> SavedMap::crops(InstanceId id) {
  const std::size_t found = position(id);
  const std::lock_guard lock(details_mutex_);
  if (!looks_) looks_ = std::move(load_map_without_voxels(path_).semantics.looks);
  std::vector<Bytes> files;
  for (const ObjectView* view : appearance_of(*looks_, info().instances[found].super_points).views)
    if (!view->crop.empty()) files.push_back(view->crop.image_jpeg);
  return files;
}

RgbImage SavedMap::place(InstanceId id) {
  position(id);
  const std::lock_guard lock(details_mutex_);
  if (!surface_) surface_ = mesh();
  return place_picture(*surface_, id, info().up);
}

std::size_t SavedMap::position(InstanceId id) const {
  if (const auto found = index().find(id)) return *found;
  throw Error(concat("the map has no object ", id, "; Map.instances.ids has those it has"));
}

void bind_objects(nb::module_& module, nb::class_<SavedMap>& map) {
  bind_object_values(module);
  map.def_prop_ro(
         "up",
         [](const SavedMap& self) {
           const Eigen::Vector3f& up = self.info().up;
           return std::array{up.x(), up.y(), up.z()};
         },
         nb::sig("def up(self) -> list[float]"), "away from the floor, world frame")
      .def(
          "reopened", &SavedMap::reopened, nb::call_guard<WithoutGil>(),
          "The map as its file is by now, after corrections or a run that replaced it. The encoder "
          "stays open.")
      .def("describe", &describe, nb::arg("id"), nb::call_guard<WithoutGil>(),
           "What is known of one object beside `instances`. Raises Error for an unknown id.")
      .def("guess_names", &guess_names, nb::call_guard<WithoutGil>(),
           "What objects are called where nobody named them, and the share of all words that "
           "speaks for it, by row of `instances`; empty where the map has no embeddings or their "
           "encoder is missing.")
      .def("relations", &relations, nb::call_guard<WithoutGil>(),
           "How the objects stand to each other: on, inside, above, beside, near; docs/query.md "
           "says when each holds. One relation a pair, the first of these that does.")
      .def("crops", &crops, nb::arg("id"), nb::sig("def crops(self, id: int) -> list[bytes]"),
           "The pictures that the map keeps of an object, as JPEG, in the order of frames. Raises "
           "Error for an unknown id.")
      .def("place", &place, nb::arg("id"),
           "Where an object is, as JPEG: the map from above, the object in red, what is higher cut "
           "away. The first call reads the voxels. Raises Error for an unknown id and a map "
           "without voxels.");
  bind_corrections(map);
}

}  // namespace ovimap::python
