// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/gyroscope.h"

#include <algorithm>
#include <cstdio>

#include "ovimap/base/error.h"
#include "ovimap/frames/recording/number_text.h"

namespace ovimap {

namespace {

constexpr double kLongestGap_s = 0.1;      // between samples; in a longer one anything may happen
constexpr double kFastest_rad_per_s = 50;  // more than gyroscopes of 2000 degrees a second measure

TurnRate parse_rate(const TextLine& line, const std::filesystem::path& file) {
  const auto numbers = parse_numbers(line.text);
  if (!numbers || numbers->size() != 4)
    throw Error(concat(file.string(), " line ", line.number, " is '", line.text,
                       "'; expected a time in seconds and the turn about x, y and z of the depth "
                       "camera in radians a second"));
  const TurnRate rate{numbers->front(), Eigen::Vector3d(numbers->data() + 1)};
  if (!(std::abs(rate.time_s) < 1e15 && rate.rad_per_s.norm() < kFastest_rad_per_s))
    throw Error(concat(file.string(), " line ", line.number, " turns by ", rate.rad_per_s.norm(),
                       " radians a second, and ", kFastest_rad_per_s,
                       " are the most; are they degrees?"));
  return rate;
}

/// The turn from one moment to a later one, with a rate that changes evenly: by its mean.
Eigen::Quaterniond turn_between(const TurnRate& first, const TurnRate& second) {
  const Eigen::Vector3d turn =
      (second.time_s - first.time_s) * (first.rad_per_s + second.rad_per_s) / 2;
  const double angle = turn.norm();
  if (!(angle > 0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

bool earlier(const TurnRate& a, const TurnRate& b) {
  return a.time_s < b.time_s;
}

}  // namespace

std::vector<TurnRate> read_gyroscope(const std::filesystem::path& file) {
  std::vector<TurnRate> rates;
  for (const TextLine& line : read_lines(file)) rates.push_back(parse_rate(line, file));
  std::stable_sort(rates.begin(), rates.end(), earlier);
  return rates;
}

std::string gyroscope_text(const std::vector<TurnRate>& rates) {
  std::string text = "# time wx wy wz: seconds; radians a second, depth camera\n";
  char line[160];
  for (const TurnRate& rate : rates) {
    std::snprintf(line, sizeof(line), "%.6f %.9g %.9g %.9g\n", rate.time_s, rate.rad_per_s.x(),
                  rate.rad_per_s.y(), rate.rad_per_s.z());
    text += line;
  }
  return text;
}

OrientationTimeline::OrientationTimeline(std::vector<TurnRate> rates) : rates_(std::move(rates)) {
  for (std::size_t i = 0; i < rates_.size(); ++i)
    orientations_.push_back(
        i == 0 ? Eigen::Quaterniond::Identity()
               : (orientations_.back() * turn_between(rates_[i - 1], rates_[i])).normalized());
}

std::optional<Eigen::Quaterniond> OrientationTimeline::at(double time_s) const {
  TurnRate then{time_s, {}};
  const auto after = std::lower_bound(rates_.begin(), rates_.end(), then, earlier);
  if (after == rates_.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(after - rates_.begin());
  if (after->time_s == time_s) return orientations_[index];
  if (index == 0) return std::nullopt;
  const TurnRate& before = rates_[index - 1];
  const double gap_s = after->time_s - before.time_s;
  if (gap_s > kLongestGap_s) return std::nullopt;
  const double share = (time_s - before.time_s) / gap_s;
  then.rad_per_s = (1 - share) * before.rad_per_s + share * after->rad_per_s;
  return orientations_[index - 1] * turn_between(before, then);
}

}  // namespace ovimap
