// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/furniture/model_store.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/synth/furniture/furniture_model.h"
#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/rooms/room_shell.h"
#include "ovimap/synth/rooms/room_spec.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/soft_models.h"

namespace ovimap {
namespace {

constexpr float kRugShare = 0.55f;  // of the room's width and depth
const Eigen::Vector2f kRugMost_m(2.6f, 1.8f);
constexpr float kRugThickness_m = 0.006f, kPictureThickness_m = 0.025f;
constexpr float kPillow_m = 0.14f, kBlanket_m = 0.09f;

const std::string kMade = made_id("");

bool made_up(const std::string& class_name) {
  return class_name == "rug" || class_name == "picture" || class_name == "pillow" ||
         class_name == "blanket";
}

std::shared_ptr<const RoomModel> made_model(const std::string& class_name,
                                            const Eigen::Vector3f& room_size_m, Random& random) {
  auto model = std::make_shared<RoomModel>();
  model->name = class_name;
  if (class_name == "rug") {
    const Eigen::Vector2f plan = (room_size_m.head<2>() * kRugShare).cwiseMin(kRugMost_m);
    model->size_m = {plan.x(), plan.y(), kRugThickness_m};
    model->mesh = rug_model(model->size_m, random.bits());
  } else if (class_name == "picture") {
    model->size_m = {random.uniform(0.4f, 0.9f), kPictureThickness_m, random.uniform(0.4f, 0.7f)};
    model->mesh = picture_model(model->size_m, random.bits());
  } else if (class_name == "pillow") {
    model->size_m = {random.uniform(0.4f, 0.55f), random.uniform(0.32f, 0.4f), kPillow_m};
    model->mesh = pillow_model(model->size_m, random.bits());
  } else {
    model->size_m = {random.uniform(0.8f, 1.1f), random.uniform(0.6f, 0.8f), kBlanket_m};
    model->mesh = blanket_model(model->size_m, random.bits());
  }
  model->soft = class_name == "pillow" || class_name == "blanket";
  return model;
}

std::shared_ptr<const RoomModel> model_by_rule(const std::string& kind, Split split,
                                               Random& random) {
  MadeModel thing = make_model(kind, split, random);
  auto model = std::make_shared<RoomModel>();
  model->name = thing.name;
  model->class_name = thing.class_name;
  model->mesh = std::move(thing.mesh);
  model->size_m = bounds(model->mesh).sizes();
  model->upper_side = HeightMap(model->mesh);
  model->soft = thing.soft, model->stackable = thing.stackable;
  model->made = true;
  model->decks = std::move(thing.decks);
  model->glow = thing.glow;
  return model;
}

}  // namespace

std::shared_ptr<const RoomModel> ModelStore::get(const std::string& class_name,
                                                 const std::string& id,
                                                 const Eigen::Vector3f& room_size_m,
                                                 Random& random) {
  if (id.starts_with(kMade)) return model_by_rule(id.substr(kMade.size()), split_, random);
  if (!id.empty()) return load(id);
  const auto& choices = models_of_class(class_name);
  if (!choices.empty()) return load(choices[random.index(choices.size())]);
  if (made_up(class_name)) return made_model(class_name, room_size_m, random);
  throw Error(concat("furniture class '", class_name,
                     "': part of every room, it cannot be asked for as furniture"));
}

std::shared_ptr<const RoomModel> ModelStore::load(const std::string& id) {
  auto& model = loaded_[id];
  if (model) return model;
  if (!catalog_) catalog_.emplace(folder_);
  const FurnitureEntry& entry = catalog_->find(id);
  auto made = std::make_shared<RoomModel>();
  made->name = entry.name;
  made->source =
      concat("\"", entry.name, "\" (", entry.id, ") by ", entry.creator, ", ", entry.license);
  made->mesh = load_furniture_model(entry);
  made->size_m = bounds(made->mesh).sizes();
  made->upper_side = HeightMap(made->mesh);
  model = made;
  return model;
}

}  // namespace ovimap
