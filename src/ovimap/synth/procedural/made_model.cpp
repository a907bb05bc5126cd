// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/procedural/made_model.h"

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/synth/procedural/makers.h"

namespace ovimap {
namespace {

const Makers& makers() {
  static const Makers all = [] {
    Makers made;
    add_seating(made);
    add_storage(made);
    add_fittings(made);
    add_pictures(made);
    add_papers(made);
    add_tableware(made);
    add_desk_things(made);
    return made;
  }();
  return all;
}

/// The middle of its base goes to the origin.
void centre(MadeModel& model) {
  const Eigen::AlignedBox3f box = bounds(model.mesh);
  const Eigen::Vector3f base(box.center().x(), box.center().y(), box.min().z());
  for (Eigen::Vector3f& vertex : model.mesh.vertices) vertex -= base;
  for (Deck& deck : model.decks) {
    deck.center_m -= base.head<2>();
    deck.height_m -= base.z();
  }
}

}  // namespace

std::vector<std::string> made_kinds() {
  std::vector<std::string> kinds;
  for (const auto& [kind, maker] : makers()) kinds.push_back(kind);
  return kinds;
}

MadeModel make_model(const std::string& kind, Split split, Random& random) {
  const auto found = makers().find(kind);
  if (found == makers().end())
    throw Error(concat("kind of thing '", kind, "': none of that name can be made, did you mean '",
                       nearest_word(kind, made_kinds()), "'?"));
  MadeModel model;
  model.name = kind;
  model.class_name = found->second.class_name;
  Craft craft{split, random};
  found->second.make(craft, model);
  centre(model);
  return model;
}

}  // namespace ovimap
