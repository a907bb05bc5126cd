// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/motion/mover_tracker.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace ovimap {

namespace {

constexpr float kFirstReach_m = 0.5f;  // a thing of unknown speed, and how far centroids jump

double gap_m(const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) {
  return static_cast<double>(a.exteriorDistance(b));
}

void join(MovingPatch& thing, const MovingPatch& part) {
  const auto a = static_cast<float>(thing.area_px), b = static_cast<float>(part.area_px);
  thing.centroid = (a * thing.centroid + b * part.centroid) / (a + b);
  thing.area_px += part.area_px;
  thing.box.extend(part.box);
}

/// Over the last step of a mover's path, which took so long.
Eigen::Vector3f velocity_of(const Mover& mover, double step_s, float fastest_mps) {
  if (mover.path.size() < 2 || !(step_s > 0)) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f step = mover.path.back().place - mover.path[mover.path.size() - 2].place;
  const Eigen::Vector3f velocity = step / static_cast<float>(step_s);
  const float speed = velocity.norm();
  return speed > fastest_mps ? Eigen::Vector3f(velocity * (fastest_mps / speed)) : velocity;
}

}  // namespace

std::vector<MovingPatch> MoverTracker::things_of(std::span<const MovingPatch> patches) const {
  std::vector<MovingPatch> things(patches.begin(), patches.end());
  for (std::size_t i = 0; i < things.size(); ++i)
    for (std::size_t k = i + 1; k < things.size();) {
      if (gap_m(things[i].box, things[k].box) > static_cast<double>(config_.same_thing_m)) {
        ++k;
        continue;
      }
      join(things[i], things[k]);
      things.erase(things.begin() + static_cast<std::ptrdiff_t>(k));
      k = i + 1;  // the larger thing may reach what the smaller one did not
    }
  return things;
}

void MoverTracker::add(std::span<const MovingPatch> patches, double timestamp_s,
                       std::int64_t number) {
  std::erase_if(live_, [&](const Live& live) {
    return timestamp_s - live.last_s > static_cast<double>(config_.forget_s);
  });
  const std::vector<MovingPatch> things = things_of(patches);
  std::vector<std::tuple<float, std::size_t, std::size_t>> pairs;  // distance, live, thing
  for (std::size_t i = 0; i < live_.size(); ++i) {
    const auto gone_s = static_cast<float>(std::max(timestamp_s - live_[i].last_s, 0.));
    const Eigen::Vector3f expected =
        movers_[live_[i].mover].path.back().place + live_[i].velocity_mps * gone_s;
    for (std::size_t k = 0; k < things.size(); ++k) {
      const float off_m = (things[k].centroid - expected).norm();
      if (off_m <= kFirstReach_m + config_.fastest_mps * gone_s) pairs.emplace_back(off_m, i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> followed(live_.size(), false), known(things.size(), false);
  for (const auto& [off_m, i, k] : pairs) {
    if (followed[i] || known[k]) continue;
    followed[i] = known[k] = true;
    follow(live_[i], things[k], timestamp_s, number);
  }
  for (std::size_t k = 0; k < things.size(); ++k)
    if (!known[k]) begin(things[k], timestamp_s, number);
}

void MoverTracker::follow(Live& live, const MovingPatch& thing, double timestamp_s,
                          std::int64_t number) {
  Mover& mover = movers_[live.mover];
  mover.size_m = mover.size_m.cwiseMax(thing.box.sizes());
  mover.path.push_back({number, thing.centroid});
  live.velocity_mps = velocity_of(mover, timestamp_s - live.last_s, config_.fastest_mps);
  live.last_s = timestamp_s;
}

void MoverTracker::begin(const MovingPatch& thing, double timestamp_s, std::int64_t number) {
  live_.push_back({movers_.size(), timestamp_s, Eigen::Vector3f::Zero()});
  movers_.push_back(
      {static_cast<int>(movers_.size()) + 1, thing.box.sizes(), {{number, thing.centroid}}});
}

void MoverTracker::restore(std::vector<Mover> movers, const std::vector<FrameLogEntry>& frames) {
  movers_ = std::move(movers);
  if (frames.empty()) return;
  std::map<std::int64_t, double> times;
  for (const FrameLogEntry& frame : frames) times[frame.index] = frame.timestamp_s;
  const double now_s = frames.back().timestamp_s;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const std::vector<MoverStep>& path = movers_[i].path;
    const double last_s = times[path.back().frame];
    if (now_s - last_s > static_cast<double>(config_.forget_s)) continue;
    const double before_s = path.size() < 2 ? last_s : times[path[path.size() - 2].frame];
    live_.push_back({i, last_s, velocity_of(movers_[i], last_s - before_s, config_.fastest_mps)});
  }
}

}  // namespace ovimap
