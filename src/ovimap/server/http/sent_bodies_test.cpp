// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/sent_bodies.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(SentBodiesTest, AreHeldOnceAsLongAsSomebodyHoldsThem) {
  SentBodies sent;
  int made = 0;
  const auto make = [&] {
    ++made;
    return std::make_shared<const std::string>("body");
  };
  auto first = sent.share("a", make);
  EXPECT_EQ(sent.share("a", make), first);
  EXPECT_NE(sent.share("b", make), first);
  EXPECT_EQ(made, 2);
  first.reset();
  EXPECT_EQ(*sent.share("a", make), "body");
  EXPECT_EQ(made, 3);
  for (int i = 0; i < 10000; ++i) sent.share(std::to_string(i), make);  // forgets, and goes on
}

}  // namespace
}  // namespace ovimap
