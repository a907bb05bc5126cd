// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/config.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"

namespace ovimap {
namespace {

enum class Mode { kFast, kExact };

struct ExampleConfig {
  int count = 3;
  float size_m = 0.25f;
  bool on = false;
  Mode mode = Mode::kFast;
};

ConfigFields fields_of(ExampleConfig& config) {
  ConfigFields fields;
  fields.group("part", [&](ConfigFields& f) {
    f.add("count", config.count, 1, 10, "how many");
    f.add("size_m", config.size_m, 0.f, 1.f, "how large");
    f.add("on", config.on, "whether");
    f.add_choice<Mode>("mode", config.mode, {{"fast", Mode::kFast}, {"exact", Mode::kExact}},
                       "which");
  });
  return fields;
}

std::string message_of(ConfigFields& fields, const char* name, const char* text) {
  return error_of([&] { fields.set(name, text); });
}

TEST(ConfigFields, SetsEveryKindOfField) {
  ExampleConfig config;
  ConfigFields fields = fields_of(config);
  fields.set("part.count", "7");
  fields.set("part.size_m", "0.5");
  fields.set("part.on", "true");
  fields.set("part.mode", "exact");
  EXPECT_EQ(config.count, 7);
  EXPECT_EQ(config.size_m, 0.5f);
  EXPECT_TRUE(config.on);
  EXPECT_EQ(config.mode, Mode::kExact);
  EXPECT_EQ(fields.dump(), "part.count: 7\npart.size_m: 0.5\npart.on: true\npart.mode: exact\n");
}

TEST(ConfigFields, NamesTheNearestFieldForAnUnknownOne) {
  ExampleConfig config;
  ConfigFields fields = fields_of(config);
  EXPECT_NE(message_of(fields, "part.cuont", "1").find("did you mean 'part.count'"),
            std::string::npos);
  EXPECT_NE(message_of(fields, "siz", "1").find("did you mean 'part.size_m'"), std::string::npos)
      << "though 'part.on' is nearer in letters";
}

TEST(ConfigFields, RefusesWhatIsOutOfRangeOrUnreadable) {
  ExampleConfig config;
  ConfigFields fields = fields_of(config);
  EXPECT_NE(message_of(fields, "part.count", "11").find("from 1 to 10"), std::string::npos);
  EXPECT_NE(message_of(fields, "part.count", "3x"), "");
  EXPECT_NE(message_of(fields, "part.size_m", "nan"), "");
  EXPECT_NE(message_of(fields, "part.mode", "slow").find("fast or exact"), std::string::npos);
  EXPECT_EQ(config.count, 3);
}

}  // namespace
}  // namespace ovimap
