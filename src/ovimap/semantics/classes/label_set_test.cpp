// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/classes/label_set.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

TEST(LabelSet, BuiltInSetsHaveTheirSizesAndIds) {
  const LabelSet replica = read_label_set("replica51");
  ASSERT_EQ(replica.labels.size(), 51u);
  EXPECT_EQ(replica.labels[0].name, "wall");
  EXPECT_EQ(replica.labels[0].id, 93);
  EXPECT_EQ(replica.labels[13].name, "tv-screen");
  const LabelSet scannet200 = read_label_set("scannet200");
  ASSERT_EQ(scannet200.labels.size(), 200u);
  EXPECT_EQ(scannet200.labels.back().name, "mattress");
  EXPECT_EQ(scannet200.labels.back().id, 1191);
  const LabelSet scannet20 = read_label_set("scannet20");
  ASSERT_EQ(scannet20.labels.size(), 20u);
  EXPECT_EQ(scannet20.labels.back().id, 39);
  for (const std::string& name : label_set_names()) {
    std::set<int> ids;
    std::set<std::string> names;
    for (const ClassLabel& label : read_label_set(name).labels) {
      EXPECT_GT(label.id, 0);
      ids.insert(label.id);
      names.insert(label.name);
    }
    EXPECT_EQ(ids.size(), read_label_set(name).labels.size()) << name;
    EXPECT_EQ(names.size(), ids.size()) << name;
  }
}

TEST(LabelSet, ReadsAFile) {
  const fixture::TemporaryFolder folder;
  const std::string file = folder.path() / "pets.txt";
  folder.write("pets.txt", "# pets\ncat\r\n\n  guinea pig \n");
  const LabelSet set = read_label_set(file);
  EXPECT_EQ(set.name, "pets");
  ASSERT_EQ(set.labels.size(), 2u);
  EXPECT_EQ(set.labels[1].name, "guinea pig");
  EXPECT_EQ(set.labels[1].id, 2);
  folder.write("pets.txt", "# nothing\n");
  EXPECT_THROW(read_label_set(file), Error);
}

TEST(LabelSet, SaysWhichSetsThereAre) {
  const std::string fault = error_of([] { read_label_set("replica52"); });
  for (const std::string& name : label_set_names())
    EXPECT_NE(fault.find(name), std::string::npos) << fault;
}

TEST(ProjectClasses, TakesTheNearestClass) {
  WordEncoder encoder;
  const SearchIndex index = map_of({"chair", "", "tv screen", "rug"});
  const auto guesses = project_classes(index, encoder, read_label_set("replica51"), 3);
  const LabelSet set = read_label_set("replica51");
  ASSERT_EQ(guesses.size(), 4u);
  EXPECT_EQ(set.labels[guesses[0].at(0).label].name, "chair");
  EXPECT_TRUE(guesses[1].empty());
  EXPECT_EQ(set.labels[guesses[2].at(0).label].name, "tv-screen");
  EXPECT_EQ(set.labels[guesses[3].at(0).label].name, "rug");
  EXPECT_EQ(guesses[0].size(), 3u);
  EXPECT_GE(guesses[0][0].score, guesses[0][1].score);
  EXPECT_EQ(project_classes(index, encoder, set, 100)[0].size(), 51u);
}

TEST(ProjectClasses, AgreesWithTheNaiveArgmax) {
  WordEncoder encoder;
  const LabelSet set = read_label_set("scannet20");
  std::vector<std::string> things;
  for (int i = 0; i < 40; ++i) things.push_back("thing" + std::to_string(i));
  const SearchIndex index = map_of(things);
  const auto guesses = project_classes(index, encoder, set, 1, "a {} here");
  for (std::size_t i = 0; i < things.size(); ++i) {
    std::size_t best = 0;
    float highest = -2.f;
    for (std::size_t k = 0; k < set.labels.size(); ++k) {
      const Eigen::VectorXf text = WordEncoder::direction_of("a " + set.labels[k].name + " here");
      const float score = index.embeddings().row(static_cast<Eigen::Index>(i)).dot(text);
      if (score > highest) {
        highest = score;
        best = k;
      }
    }
    ASSERT_EQ(guesses[i].size(), 1u);
    EXPECT_EQ(guesses[i][0].label, best);
    EXPECT_NEAR(guesses[i][0].score, highest, 1e-5f);
  }
}

TEST(ProjectClasses, RefusesMapsOfOtherEncoders) {
  WordEncoder encoder;
  EXPECT_THROW(project_classes(map_of({""}), encoder, read_label_set("scannet20"), 1), Error);
  encoder.identity_.dimension = 5;
  EXPECT_THROW(project_classes(map_of({"chair"}), encoder, read_label_set("scannet20"), 1), Error);
}

}  // namespace
}  // namespace ovimap
