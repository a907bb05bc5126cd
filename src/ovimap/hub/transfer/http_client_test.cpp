// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/http_client.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(TransferClient, KnowsOrigins) {
  EXPECT_EQ(origin_of("https://hub.example/a/b"), "https://hub.example:443");
  EXPECT_EQ(origin_of("https://hub.example:443/c"), origin_of("https://hub.example"));
  EXPECT_NE(origin_of("http://hub.example"), origin_of("https://hub.example"));
  EXPECT_NE(origin_of("http://hub.example:81"), origin_of("http://hub.example"));
  EXPECT_NE(origin_of("https://hub.example.evil.test"), origin_of("https://hub.example"));
  EXPECT_EQ(origin_of("https://hub.example@evil.test/"), "https://evil.test:443");
  for (const char* none :
       {"", "file:///etc/passwd", "ftp://hub.example", "hub.example", "https://"})
    EXPECT_EQ(origin_of(none), "") << none;
}

}  // namespace
}  // namespace ovimap
