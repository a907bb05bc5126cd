// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/semantics/classes/class_names.h"
#include "ovimap/semantics/words/word_lists.h"
#include "ovimap/synth/furniture/furniture_palette.h"

namespace ovimap {
namespace {

/// Whether the table says what the sets call the class, or that they have none.
bool is_tabled(const std::string& name) {
  for (const std::string& line : list_entries(builtin_word_list("room_classes")))
    if (line.starts_with(name + ";")) return true;
  return false;
}

TEST(RoomClasses, EachIsMappedToTheDataSetsClasses) {
  for (const std::string& name : room_classes())
    for (const char* set : {"replica51", "scannet200", "scannet20"})
      EXPECT_TRUE(is_tabled(name) || find_class(read_label_set(set), name))
          << name << " neither in " << set << " nor in room_classes.txt";
}

}  // namespace
}  // namespace ovimap
