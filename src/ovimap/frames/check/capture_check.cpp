// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/capture_check.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/base/median.h"
#include "ovimap/image/blur.h"

namespace ovimap {

namespace {

constexpr int kFewEdges = 40;       // fewer may all be shading, or what noise made
constexpr int kLines = 60;          // rows, and columns, that are enough of a picture
constexpr float kSmeared = 0.015f;  // of the picture's width: 10 px of 640
constexpr double kFew = 0.25;       // of the frames: who turns smears some

Finding clock_finding(const std::vector<Capture>& captures) {
  std::size_t back = 0, same = 0;
  for (std::size_t i = 1; i < captures.size(); ++i) {
    back += captures[i].timestamp_s < captures[i - 1].timestamp_s;
    same += captures[i].timestamp_s == captures[i - 1].timestamp_s;
  }
  if (back > 0)
    return {Severity::kWarning, "clock",
            concat("times of frames go backwards in ", back, " places"),
            "frames count in their order, so what depends on time (--dynamic, live poses, dates of "
            "the map's history) may be wrong: record by one clock that is never set"};
  if (same > 0 && same + 1 == captures.size())
    return {Severity::kWarning, "clock", "all frames have the same time",
            "give each frame the time at which it was taken"};
  return {Severity::kOk, "clock", "times of frames go forwards", {}};
}

std::string finely(double share) {
  constexpr double kTenths = 10;
  return concat(std::round(kTenths * 100 * share) / kTenths, " %");
}

std::optional<Finding> blur_finding(const std::vector<Capture>& captures) {
  std::vector<float> smears;
  for (const Capture& capture : captures)
    if (capture.smear) smears.push_back(*capture.smear);
  if (smears.empty()) return std::nullopt;
  const auto smeared =
      std::count_if(smears.begin(), smears.end(), [](float smear) { return smear > kSmeared; });
  const std::string message =
      concat(smeared, " of ", smears.size(), " pictures are smeared; edges are as wide as ",
             finely(double{median_of(smears)}), " of a picture in the median");
  if (static_cast<double>(smeared) <= kFew * static_cast<double>(smears.size()))
    return Finding{Severity::kOk, "blur", message, {}};
  return Finding{Severity::kWarning, "blur", message,
                 "masks and words are worse in such pictures: move the camera slower, give it more "
                 "light or a shorter exposure, and clean or focus its lens"};
}

}  // namespace

Capture capture_of(const Frame& frame) {
  const RgbImage& picture = frame.color;
  const int side = std::min(picture.width(), picture.height());
  const Blur blur = measure_blur(picture, std::max(1, side / kLines));
  Capture capture{frame.timestamp_s, {}};
  for (const EdgeWidth& edge : {blur.across, blur.down})
    if (edge.edges >= kFewEdges)
      capture.smear =
          std::max(capture.smear.value_or(0.f), edge.px / static_cast<float>(picture.width()));
  return capture;
}

std::vector<Finding> check_captures(const std::vector<Capture>& captures) {
  std::vector<Finding> findings;
  if (captures.size() < 2) return findings;
  findings.push_back(clock_finding(captures));
  if (auto blur = blur_finding(captures)) findings.push_back(std::move(*blur));
  return findings;
}

}  // namespace ovimap
