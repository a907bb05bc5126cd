// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/timings_text.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(TimingsText, WritesALinePerStage) {
  StageTimers timers;
  for (const double value : {3.0, 1.0, 2.0}) timers.add("integrate", value);
  timers.add("associate", 0.0004);
  EXPECT_EQ(timings_text(timers.summary()), "associate 0.000 0.000 1\nintegrate 2.000 3.000 3\n");
  EXPECT_EQ(timings_text({}), "");
}

TEST(TimingsText, ReadsWhatItWrote) {
  const auto stages = parse_timings(timings_text({{"a", {1.5, 20.25, 0, 0, 7}}, {"b", {}}}));
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages.at("a").p50_ms, 1.5);
  EXPECT_EQ(stages.at("a").p95_ms, 20.25);
  EXPECT_EQ(stages.at("a").count, 7u);
}

TEST(TimingsText, PassesOverWhatIsNoTiming) {
  EXPECT_TRUE(parse_timings("\na\na 1\na 1 2\na 1 2 -3\na 1 x 3\na 1 2 3 4\na nan 2 3\na 1 inf 3\n")
                  .empty());
  EXPECT_EQ(parse_timings("junk\na 1 2 3").size(), 1u);
}

}  // namespace
}  // namespace ovimap
