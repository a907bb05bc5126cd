// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/class_names.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {
namespace {

std::string class_in(const char* set_name, const char* name) {
  const LabelSet set = read_label_set(set_name);
  const auto found = find_class(set, name);
  return found ? set.labels[*found].name : "";
}

TEST(ClassNames, AreFoundBySpellingAndByTable) {
  EXPECT_EQ(class_in("replica51", "tv-screen"), "tv-screen");
  EXPECT_EQ(class_in("replica51", "tv screen"), "tv-screen");
  EXPECT_EQ(class_in("replica51", "tv"), "tv-screen");
  EXPECT_EQ(class_in("scannet200", "tv"), "tv");
  EXPECT_EQ(class_in("scannet200", "mug"), "cup");
  EXPECT_EQ(class_in("scannet200", "sofa"), "couch");
  EXPECT_EQ(class_in("scannet20", "trash can"), "otherfurniture");
  EXPECT_EQ(class_in("scannet20", "mug"), "");
  EXPECT_EQ(class_in("scannet200", "no such thing"), "");
}

TEST(ClassNames, ASetOfOnesOwnGoesByItsNames) {
  const LabelSet own{"own", {{1, "cup"}, {2, "mug"}}};
  EXPECT_EQ(find_class(own, "mug"), 1u);
  EXPECT_FALSE(find_class(own, "sofa").has_value());
}

TEST(ClassNames, TheTableNamesOnlyWhatTheSetsHave) {
  std::set<std::string> seen;
  for (const std::string& line : list_entries(builtin_word_list("room_classes"))) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ';')
        cells.emplace_back();
      else if (c != ' ' || !cells.back().empty())
        cells.back() += c;
    }
    ASSERT_EQ(cells.size(), 4u) << line;
    EXPECT_TRUE(seen.insert(cells[0]).second) << "twice: " << line;
    const char* sets[] = {"replica51", "scannet200", "scannet20"};
    for (std::size_t i = 0; i < 3; ++i) {
      const LabelSet set = read_label_set(sets[i]);
      const auto found = find_class(set, cells[0]);
      EXPECT_EQ(found ? set.labels[*found].name : "-", cells[i + 1]) << line << " in " << sets[i];
    }
  }
}

TEST(LabelGroups, CoverTheirSetsOnce) {
  const LabelSet scannet = read_label_set("scannet200"), replica = read_label_set("replica51");
  const std::vector<std::size_t> sizes = {66, 68, 66};
  for (const LabelSet& set : {scannet, replica}) {
    const std::vector<LabelGroup> groups = label_groups(set);
    ASSERT_EQ(groups.size(), 3u);
    std::set<std::size_t> all;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      EXPECT_EQ(groups[g].name, (std::vector<std::string>{"head", "common", "tail"})[g]);
      EXPECT_EQ(groups[g].labels.size(), set.name == "scannet200" ? sizes[g] : 17u);
      all.insert(groups[g].labels.begin(), groups[g].labels.end());
    }
    EXPECT_EQ(all.size(), set.labels.size());
  }
  EXPECT_EQ(replica.labels[label_groups(replica)[1].labels[0]].name, "tv-stand");
  EXPECT_TRUE(label_groups(read_label_set("scannet20")).empty());
}

TEST(StuffLabels, LeaveTheBenchmarksNumberOfClasses) {
  EXPECT_EQ(stuff_labels(read_label_set("replica51")).size(), 3u);   // 48 stay
  EXPECT_EQ(stuff_labels(read_label_set("scannet200")).size(), 2u);  // 198 stay
  EXPECT_EQ(stuff_labels(read_label_set("scannet20")).size(), 2u);   // 18 stay
}

}  // namespace
}  // namespace ovimap
