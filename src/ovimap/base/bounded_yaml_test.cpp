// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/bounded_yaml.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "ovimap/base/error.h"
#include "ovimap/base/error_fixture.h"

namespace ovimap {
namespace {

/// The message of the Error for `text`; empty: none.
std::string yaml_fault(const std::string& text, std::size_t most_bytes = kSmallDocument) {
  return fault_of([&] { parse_yaml(text, "calibration.yaml", most_bytes); });
}

std::string copies_of(const std::string& piece, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

TEST(BoundedYaml, ReadsWhatPeopleWrite) {
  const YAML::Node root =
      parse_yaml("# mine\ncamera: {fx: 5, list: [1, 2]}\nname: a b\n", "x", kSmallDocument);
  EXPECT_EQ(root["camera"]["list"].size(), 2u);
  EXPECT_EQ(root["name"].as<std::string>(), "a b");
  EXPECT_TRUE(parse_yaml("", "x", kSmallDocument).IsNull());
  EXPECT_TRUE(parse_yaml("# nothing\n", "x", kSmallDocument).IsNull());
  EXPECT_TRUE(parse_yaml(R"({"camera": {"fx": 5}})", "x", kSmallDocument)["camera"].IsMap());
}

TEST(BoundedYaml, EndsAtADepth) {
  const auto nested = [](std::size_t levels) {
    return copies_of("[", levels) + copies_of("]", levels);
  };
  EXPECT_EQ(yaml_fault(nested(kDeepestDocument)), "");
  EXPECT_NE(yaml_fault(nested(kDeepestDocument + 1)).find("nested more than 32 levels"),
            std::string::npos);
  for (const char* opening : {"[", "{", "- ", "? ", "{a: ", "[{a: ", "&a [", "!a {"})
    EXPECT_NE(yaml_fault(copies_of(opening, 40'000)), "") << opening;
}

TEST(BoundedYaml, RefusesWhatHasNoOneMeaning) {
  EXPECT_NE(yaml_fault("a: 1\nb: 2\na: 3\n").find("line 3"), std::string::npos);
  EXPECT_NE(yaml_fault("a: 1\n---\nb: 2\n").find("second document"), std::string::npos);
  EXPECT_NE(yaml_fault("[a]: 1\n").find("a key must be a text"), std::string::npos);
  EXPECT_NE(yaml_fault("~: 1\n").find("a key must be a text"), std::string::npos);
  EXPECT_EQ(yaml_fault("a: {x: 1}\nb: {x: 1}\n"), "") << "maps of their own";
}

TEST(BoundedYaml, RefusesAliases) {
  EXPECT_NE(yaml_fault("a: &a\n  b: *a\n").find("aliases"), std::string::npos) << "contains itself";
  EXPECT_NE(yaml_fault("a: &a 1\nb: *a\n").find("line 2"), std::string::npos);
}

TEST(BoundedYaml, SaysWhereItGoesWrong) {
  EXPECT_NE(yaml_fault("a: 1\nb: [1, 2\nc: }").find("calibration.yaml: line 3"), std::string::npos);
  EXPECT_NE(yaml_fault("a: 1", 3).find("larger than 3 bytes"), std::string::npos);
  EXPECT_NE(yaml_fault(std::string("a: 1\0b", 6)).find("NUL"), std::string::npos);
  EXPECT_THROW(read_yaml("/dev/zero", kSmallDocument), Error);
}

}  // namespace
}  // namespace ovimap
