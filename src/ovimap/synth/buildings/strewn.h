// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ovimap/synth/furniture/model_store.h"
#include "ovimap/synth/rooms/room_spec.h"
#include "ovimap/synth/shapes/oriented_box.h"

namespace ovimap {

/// A piece in its place, whose decks things may lie on.
struct Carrier {
  std::string class_name;
  OrientedBox box;
  std::shared_ptr<const RoomModel> model;
};

/// A thing where it came to lie.
struct Strewn {
  std::string class_name;
  OrientedBox box;
  std::shared_ptr<const RoomModel> model;
};

/// Strews the clutter of a spec over the decks: side by side, sheets over sheets, books in stacks
/// and in rows. Nothing meets what is `taken`, nor another thing; what finds no place is left out.
/// The same spec gives the same things.
std::vector<Strewn> strewn(const RoomSpec& spec, const std::vector<Carrier>& carriers,
                           const std::vector<OrientedBox>& taken, ModelStore& store);

}  // namespace ovimap
