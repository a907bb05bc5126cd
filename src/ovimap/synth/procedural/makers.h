// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ovimap/synth/procedural/craft.h"

namespace ovimap {

/// Fills a model whose name and class are set.
using Make = void (*)(Craft&, MadeModel&);

struct Maker {
  std::string class_name;
  Make make;
};
using Makers = std::map<std::string, Maker>;  ///< by kind

void add_seating(Makers& makers);      ///< sofas, chairs, beds
void add_storage(Makers& makers);      ///< tables, cabinets, shelves
void add_fittings(Makers& makers);     ///< lamps, windows, doors, plants
void add_pictures(Makers& makers);     ///< frames, screens
void add_tableware(Makers& makers);    ///< cups, bottles, bowls
void add_papers(Makers& makers);       ///< sheets, books
void add_desk_things(Makers& makers);  ///< keyboards, pens, cables

}  // namespace ovimap
