// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/buildings/strewn.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ovimap/synth/furniture/furniture_palette.h"
#include "ovimap/synth/shapes/angles.h"

namespace ovimap {
namespace {

constexpr std::uint64_t kStrewnStream = 3001;
constexpr int kTries = 80;
constexpr float kGap_m = 0.004f, kLift_m = 3e-4f;
constexpr float kSheet_m = 0.016f;      // thinner things may half cover each other
constexpr float kCarriedShare = 0.75f;  // of a thing's extent that what carries it must hold
constexpr float kHighest_m = 0.22f;     // of a stack
constexpr float kTurned_rad = 0.25f;    // most things lie about square to their table
constexpr float kOpenDeck_m = 1.f;      // with more space above it a thing may lie at any angle

OrientedBox world_deck(const Carrier& carrier, const Deck& deck) {
  OrientedBox box = carrier.box;
  box.center_m = carrier.box.world_from_box(deck.center_m);
  box.half_m = deck.half_m;
  box.bottom_m = carrier.box.bottom_m + deck.height_m;
  box.top_m = box.bottom_m + deck.clearance_m;
  return box;
}

/// Whether all corners of `inner`, drawn in to a share, lie over `outer`.
bool carries(const OrientedBox& outer, OrientedBox inner) {
  inner.half_m *= kCarriedShare;
  const auto corners = inner.corners();
  return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector2f& corner) {
    const Eigen::Vector2f offset = corner - outer.center_m;
    return std::abs(offset.dot(outer.x_axis())) <= outer.half_m.x() &&
           std::abs(offset.dot(outer.y_axis())) <= outer.half_m.y();
  });
}

bool within(const OrientedBox& deck, const OrientedBox& box) {
  const auto corners = box.corners();
  return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector2f& corner) {
    const Eigen::Vector2f offset = corner - deck.center_m;
    return std::abs(offset.dot(deck.x_axis())) <= deck.half_m.x() &&
           std::abs(offset.dot(deck.y_axis())) <= deck.half_m.y();
  });
}

/// One deck and what lies on it so far.
class StrewnDeck {
 public:
  StrewnDeck(const OrientedBox& deck, const std::vector<OrientedBox>& taken, Random& random)
      : deck_(deck), random_(random) {
    // The piece that has the deck reaches into the space above it only with its own backs and
    // sides.
    for (const OrientedBox& box : taken)
      if (box.bottom_m > deck.bottom_m - 0.01f && overlap(box, deck) > 0) taken_.push_back(box);
  }

  std::optional<OrientedBox> place(const RoomModel& model) {
    for (int i = 0; i < kTries; ++i) {
      OrientedBox box = drawn(model);
      if (!within(deck_, box)) continue;
      const auto rest = rest_of(box, model);
      if (!rest) continue;
      box.bottom_m = *rest + kLift_m;
      box.top_m = box.bottom_m + model.size_m.z();
      if (box.top_m > deck_.top_m || !free(box)) continue;
      lying_.push_back({box, model.stackable});
      return box;
    }
    return std::nullopt;
  }

  /// Beside the thing that was placed so before, else anywhere.
  std::optional<OrientedBox> place_in_row(const RoomModel& model) {
    if (row_x_ > deck_.half_m.x() || model.size_m.z() > deck_.top_m - deck_.bottom_m)
      return std::nullopt;
    if (row_x_ < -deck_.half_m.x()) row_x_ = random_.uniform(-0.95f, 0.2f) * deck_.half_m.x();
    OrientedBox box = deck_;
    box.half_m = model.size_m.head<2>() / 2;
    const float back = deck_.half_m.y() - box.half_m.y();
    if (back < 0) return std::nullopt;
    const float x = row_x_ + box.half_m.x() + random_.uniform(0.0005f, 0.002f);
    box.center_m = deck_.world_from_box({x, random_.uniform(0.2f, 0.7f) * back});
    box.bottom_m = deck_.bottom_m + kLift_m;
    box.top_m = box.bottom_m + model.size_m.z();
    row_x_ = x + box.half_m.x();
    const bool clear = std::none_of(lying_.begin(), lying_.end(), [&](const Lying& other) {
      return footprint_overlap(box, other.box) > 0;
    });
    if (!clear || !within(deck_, box) || !free(box)) return std::nullopt;
    lying_.push_back({box, false});
    return box;
  }

 private:
  struct Lying {
    OrientedBox box;
    bool stackable;
  };

  OrientedBox drawn(const RoomModel& model) {
    OrientedBox box = deck_;
    box.half_m = model.size_m.head<2>() / 2;
    const bool square = deck_.top_m - deck_.bottom_m < kOpenDeck_m || random_.index(4) != 0;
    box.yaw_rad += square ? random_.uniform(-kTurned_rad, kTurned_rad) : random_.uniform(-kPi, kPi);
    const bool onto = !lying_.empty() && random_.index(3) == 0;
    const Eigen::Vector2f part(random_.uniform(-1, 1), random_.uniform(-1, 1));
    box.center_m = deck_.world_from_box(part.cwiseProduct(deck_.half_m));
    if (onto) {
      const OrientedBox& below = lying_[random_.index(lying_.size())].box;
      box.center_m = below.world_from_box(0.3f * part.cwiseProduct(below.half_m));
    }
    return box;
  }

  /// The height at which it comes to lie; nothing where it would not lie still.
  std::optional<float> rest_of(const OrientedBox& box, const RoomModel& model) const {
    float rest = deck_.bottom_m;
    for (const Lying& other : lying_) {
      const float depth = footprint_overlap(box, other.box);
      if (depth <= -kGap_m) continue;
      const float height = other.box.top_m - deck_.bottom_m;
      const bool sheets = model.size_m.z() < kSheet_m && height < kSheet_m && model.stackable;
      const bool stacked = height < kHighest_m && carries(other.box, box);
      if (!other.stackable || (!sheets && !stacked)) return std::nullopt;
      if (depth > 0) rest = std::max(rest, other.box.top_m);
    }
    return rest;
  }

  bool free(const OrientedBox& box) const {
    return std::none_of(taken_.begin(), taken_.end(),
                        [&](const OrientedBox& other) { return overlap(box, other) > 0; });
  }

  OrientedBox deck_;
  Random& random_;
  std::vector<OrientedBox> taken_;
  std::vector<Lying> lying_;
  float row_x_ = -1e3f;  ///< where the row of upright things ends
};

std::string class_of(const std::string& model_id, const RoomModel& model) {
  if (!model.class_name.empty()) return model.class_name;
  for (const std::string& name : room_classes()) {
    const auto& ids = models_of_class(name);
    if (std::find(ids.begin(), ids.end(), model_id) != ids.end()) return name;
  }
  return {};
}

void strew(const Clutter& clutter, StrewnDeck& deck, ModelStore& store, const RoomSpec& spec,
           Random& random, std::vector<Strewn>& things) {
  const auto span = static_cast<std::size_t>(clutter.most - clutter.least + 1);
  const int count = clutter.least + static_cast<int>(random.index(span));
  for (int i = 0; i < count; ++i) {
    const std::string& id = clutter.models[random.index(clutter.models.size())];
    const auto model = store.get({}, id, spec.size_m, random);
    const bool upright = id == made_id("standing book");
    const auto box = upright ? deck.place_in_row(*model) : deck.place(*model);
    if (box) things.push_back({class_of(id, *model), *box, model});
  }
}

}  // namespace

std::vector<Strewn> strewn(const RoomSpec& spec, const std::vector<Carrier>& carriers,
                           const std::vector<OrientedBox>& taken, ModelStore& store) {
  Random random(spec.seed, kStrewnStream);
  std::vector<Strewn> things;
  for (const Carrier& carrier : carriers)
    for (const Deck& deck : carrier.model->decks) {
      StrewnDeck strewn_deck(world_deck(carrier, deck), taken, random);
      for (const Clutter& clutter : spec.clutter)
        if (std::find(clutter.at.begin(), clutter.at.end(), carrier.class_name) != clutter.at.end())
          strew(clutter, strewn_deck, store, spec, random, things);
    }
  return things;
}

}  // namespace ovimap
