// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/people/people_filter.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/frames/decoding/frame_decoder.h"
#include "ovimap/inference/sam/box_mask.h"

namespace ovimap {

namespace {

constexpr int kLeastMargin_px = 2;  // depth and colour mix at edges

void add(const PeopleMask& mask, PeopleMask& all) {
  for (std::size_t i = 0; i < all.size(); ++i) all[i] |= mask[i];
}

/// In the box and as much around as `radius_px`: a network's mask may run away over a sofa.
void keep_in(const Eigen::AlignedBox2f& box_px, int radius_px, PeopleMask& mask) {
  const Eigen::Vector2f margin = Eigen::Vector2f::Constant(static_cast<float>(radius_px));
  const Eigen::AlignedBox2f wide(box_px.min() - margin, box_px.max() + margin);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (!wide.contains(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y))))
        mask.at(x, y) = 0;
}

}  // namespace

void list_fields(PeopleConfig& config, ConfigFields& fields) {
  fields.add_choice("mode", config.mode, {{"keep", PeopleMode::kKeep}, {"drop", PeopleMode::kDrop}},
                    "people are seen as everything else (keep), or taken out of each frame (drop)");
  fields.add("detector", config.detector, "model of kind detector that finds people");
  fields.add("min_score", config.min_score, 0.f, 1.f,
             "score of a detector's box that counts as a person");
  fields.add("mask_network", config.mask_network,
             "a network of --masks that takes boxes is asked for the outline of people");
  fields.add("least_fill", config.least_fill, 0.f, 1.f,
             "share of the box's height and width that such a mask must fill; else depth is asked");
  fields.add("margin_share", config.margin_share, 0.f, 1.f,
             "pixels around people that go as well, as a share of the box's height");
  fields.add("seed_m", config.seed_m, 0.f, 10.f,
             "by depth: a body is so near to the surface in the middle of the box, metres");
  fields.add("reach_m", config.reach_m, 0.f, 10.f, "and reaches so far from that, metres");
  fields.add("step_share", config.step_share, 0.f, 1.f,
             "over steps of at most such a share of the depth");
}

FrameRead PeopleFilter::without_people(Frame frame) const {
  const std::vector<PersonBox> people = finder_->find(frame.color, config_.min_score);
  if (people.empty()) return {std::move(frame), ""};
  {
    const std::lock_guard lock(mutex_);
    seen_in_.insert(frame.index);
  }
  const Image<std::int32_t> places = color_places(frame);
  const PeopleMask mask = people_in(frame, places, people);
  frame.taken_out = DepthImage(frame.depth.width(), frame.depth.height());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i] >= 0 && mask[static_cast<std::size_t>(places[i])])
      std::swap(frame.depth[i], frame.taken_out[i]);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) frame.color[i] = {};
  if (!has_depth(frame.depth)) return {std::nullopt, frame.name + ": shows nothing but people"};
  return {std::move(frame), ""};
}

std::size_t PeopleFilter::frames_with_people() const {
  const std::lock_guard lock(mutex_);
  return seen_in_.size();
}

PeopleMask PeopleFilter::people_in(const Frame& frame, const Image<std::int32_t>& places,
                                   const std::vector<PersonBox>& people) const {
  std::optional<ImageFeatures> features;
  if (outlines_) features = outlines_->encode(frame.color);
  PeopleMask all(frame.color.width(), frame.color.height());
  for (const PersonBox& person : people) {
    const Eigen::AlignedBox2f& box = person.in_image_px;
    const int margin_px = std::max(
        kLeastMargin_px, static_cast<int>(std::lround(config_.margin_share * box.sizes().y())));
    std::optional<PeopleMask> mask;
    if (features) mask = outline(*features, frame, box);
    if (!mask) mask = pixels_by_depth(frame, places, box, config_);
    PeopleMask around = grown(*mask, margin_px);
    keep_in(box, margin_px, around);
    add(around, all);
  }
  return all;
}

/// Nothing where the network sees a part of the person alone, as a shirt.
std::optional<PeopleMask> PeopleFilter::outline(const ImageFeatures& features, const Frame& frame,
                                                const Eigen::AlignedBox2f& box_px) const {
  PeopleMask mask =
      mask_in_box(*outlines_, features, box_px, frame.color.width(), frame.color.height());
  const Eigen::AlignedBox2f filled = extent_of(mask).intersection(box_px);
  if (filled.isEmpty() ||
      (filled.sizes().array() < config_.least_fill * box_px.sizes().array()).any())
    return std::nullopt;
  return mask;
}

}  // namespace ovimap
