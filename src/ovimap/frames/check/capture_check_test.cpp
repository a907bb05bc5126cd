// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/capture_check.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

const Finding* find(const std::vector<Finding>& findings, const std::string& name) {
  for (const Finding& finding : findings)
    if (finding.name == name) return &finding;
  return nullptr;
}

std::vector<Capture> at_times(const std::vector<double>& times_s) {
  std::vector<Capture> captures;
  for (const double time_s : times_s) captures.push_back({time_s, {}});
  return captures;
}

TEST(CaptureCheck, AClockMustGoForwards) {
  EXPECT_EQ(find(check_captures(at_times({0, 1, 2})), "clock")->severity, Severity::kOk);
  EXPECT_EQ(find(check_captures(at_times({0, 1, 1, 2})), "clock")->severity, Severity::kOk)
      << "a copied frame";
  const auto back = check_captures(at_times({0, 1, 0.5, 2, 1.5}));
  EXPECT_EQ(find(back, "clock")->severity, Severity::kWarning);
  EXPECT_NE(find(back, "clock")->message.find("in 2 places"), std::string::npos);
  EXPECT_EQ(find(check_captures(at_times({7, 7, 7})), "clock")->severity, Severity::kWarning);
  EXPECT_EQ(find(check_captures(at_times({0, 1, 2})), "blur"), nullptr) << "nothing tells";
  EXPECT_TRUE(check_captures(at_times({0})).empty());
}

/// Upright bars that rise and fall over so many pixels.
Capture bars(int ramp_px) {
  Frame frame;
  frame.color = RgbImage(320, 240);
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const int place = x % 80, rise = std::min(place, 80 - place) - (20 - ramp_px / 2);
      const int level = 60 + 120 * std::clamp(rise, 0, ramp_px) / ramp_px;
      const auto byte = static_cast<std::uint8_t>(level);
      frame.color.at(x, y) = {byte, byte, byte};
    }
  return capture_of(frame);
}

TEST(CaptureCheck, ARecordingIsBlurredWhenManyPicturesAre) {
  const Capture sharp = bars(2), smeared = bars(16);
  ASSERT_TRUE(sharp.smear && smeared.smear);
  EXPECT_LT(*sharp.smear, 0.01f);
  EXPECT_NEAR(*smeared.smear, 16.f / 320, 0.01f);
  EXPECT_EQ(find(check_captures({sharp, sharp, sharp, sharp, smeared}), "blur")->severity,
            Severity::kOk);
  const auto many = check_captures({sharp, smeared, sharp, smeared});
  EXPECT_EQ(find(many, "blur")->severity, Severity::kWarning);
  EXPECT_NE(find(many, "blur")->message.find("2 of 4"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
