// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/object_layout.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/semantics/relations/object_shape.h"

namespace ovimap {

namespace {

constexpr float kThin_m = 0.02f;  // thinner is noise

/// The smallest ratio of sides.
float size_ratio(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Array3f p = a.array().max(kThin_m), q = b.array().max(kThin_m);
  return (p.min(q) / p.max(q)).minCoeff();
}

Landmark landmark_of(const ObjectShape& shape) {
  const PlaneRectangle around = smallest_rectangle(shape.footprint);
  Landmark landmark;
  landmark.at << around.center.cast<double>(), double{shape.middle_m()};
  landmark.sizes_m << around.sides.maxCoeff(), around.sides.minCoeff(), shape.height_m();
  return landmark;
}

/// An object of b that may be one of a.
struct Partner {
  std::size_t b = 0;
  Eigen::Vector3d in_a = Eigen::Vector3d::Zero(), in_b = Eigen::Vector3d::Zero();
  double likeness = 0;
};

/// What the objects of both maps have in common tells none of them: embeddings of pictures all lie
/// in one narrow cone, whose axis is taken out.
class Looks {
 public:
  Looks(const ObjectLayout& a, const ObjectLayout& b) {
    if (a.encoder != b.encoder) return;
    for (const ObjectLayout* layout : {&a, &b})
      for (const Landmark& landmark : layout->landmarks) {
        if (landmark.look.size() == 0) continue;
        // Made apart and moved: GCC 12 takes a resizing here for a use of freed memory.
        if (mean_.size() == 0) mean_ = Eigen::VectorXf(Eigen::VectorXf::Zero(landmark.look.size()));
        mean_ += landmark.look, ++count_;
      }
    if (count_ > 0) mean_ /= static_cast<float>(count_);
  }

  /// 0 to 1; half where nothing is known.
  double operator()(const Landmark& a, const Landmark& b) const {
    constexpr int kFew = 8;  // of so few the mean would take out what tells them apart
    if (mean_.size() == 0 || a.look.size() != b.look.size() || a.look.size() == 0) return 0.5;
    const Eigen::VectorXf shared = count_ < kFew ? Eigen::VectorXf::Zero(mean_.size()) : mean_;
    const Eigen::VectorXf x = a.look - shared, y = b.look - shared;
    const double lengths = double{x.norm()} * double{y.norm()};
    return lengths > 0 ? std::max(0., double{x.dot(y)} / lengths) : 0.5;
  }

 private:
  Eigen::VectorXf mean_;
  int count_ = 0;
};

void keep_likeliest(std::vector<Partner>& partners, std::size_t count) {
  std::stable_sort(partners.begin(), partners.end(),
                   [](const Partner& x, const Partner& y) { return x.likeness > y.likeness; });
  partners.resize(std::min(partners.size(), count));
}

std::vector<Partner> find_partners(const ObjectLayout& a, const ObjectLayout& b,
                                   const ObjectLayoutConfig& config) {
  constexpr std::size_t kMostPartners = 400;  // their pairs are all tried
  const Looks looks(a, b);
  std::vector<Partner> partners;
  for (std::size_t j = 0; j < b.landmarks.size(); ++j) {
    std::vector<Partner> of_one;
    for (const Landmark& other : a.landmarks) {
      const float size = size_ratio(other.sizes_m, b.landmarks[j].sizes_m);
      if (size < config.min_likeness) continue;
      of_one.push_back(
          {j, other.at, b.landmarks[j].at, double{size} * looks(other, b.landmarks[j])});
    }
    keep_likeliest(of_one, static_cast<std::size_t>(config.max_partners));
    partners.insert(partners.end(), of_one.begin(), of_one.end());
  }
  keep_likeliest(partners, kMostPartners);
  return partners;
}

/// A turn about the vertical and a shift, in the ground frames.
struct UprightPose {
  double yaw = 0;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double votes = 0;
  int objects = 0;

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()) + shift;
  }
  bool near(const UprightPose& other, const Eigen::Vector3d& somewhere) const {
    constexpr double kSamePlace_m = 0.25, kSameYaw_rad = 0.15;
    return std::fabs(std::remainder(yaw - other.yaw, 2 * M_PI)) < kSameYaw_rad &&
           ((*this)(somewhere)-other(somewhere)).norm() < kSamePlace_m;
  }
  Pose pose() const {
    Pose result(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    result.translation() = shift;
    return result;
  }
};

/// What pairs of points propose together: the turn and shift of least squares (Horn 1987, about one
/// axis). `weights` sum to more than 0.
UprightPose fitted(const std::vector<const Partner*>& pairs) {
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = mean_a;
  double sum = 0;
  for (const Partner* pair : pairs) {
    mean_a += pair->likeness * pair->in_a, mean_b += pair->likeness * pair->in_b;
    sum += pair->likeness;
  }
  mean_a /= sum, mean_b /= sum;
  double cosine = 0, sine = 0;
  for (const Partner* pair : pairs) {
    const Eigen::Vector3d p = pair->in_b - mean_b, q = pair->in_a - mean_a;
    cosine += pair->likeness * (p.x() * q.x() + p.y() * q.y());
    sine += pair->likeness * (p.x() * q.y() - p.y() * q.x());
  }
  UprightPose pose;
  pose.yaw = std::atan2(sine, cosine);
  pose.shift = mean_a - pose(mean_b);
  return pose;
}

/// Poses by votes of all partners.
class Ballot {
 public:
  Ballot(const std::vector<Partner>& partners, std::size_t objects,
         const ObjectLayoutConfig& config)
      : partners_(partners), objects_(objects), config_(config) {}

  /// All that two partners propose, in their order.
  std::vector<UprightPose> all() const {
    std::vector<std::vector<UprightPose>> of_first(partners_.size());
    parallel_for(partners_.size(), 1, [&](std::size_t i) {
      for (std::size_t j = i + 1; j < partners_.size(); ++j) {
        if (!fit_together(partners_[i], partners_[j])) continue;
        UprightPose pose = fitted({&partners_[i], &partners_[j]});
        count(pose);
        of_first[i].push_back(pose);
      }
    });
    std::vector<UprightPose> poses;
    for (const auto& list : of_first) poses.insert(poses.end(), list.begin(), list.end());
    return poses;
  }

  /// The pose that all of its voters agree with best.
  UprightPose agreed(UprightPose pose) const {
    for (int round = 0; round < 2; ++round) {
      const std::vector<const Partner*> voters = voters_of(pose);
      if (voters.size() < 2) break;
      UprightPose next = fitted(voters);
      count(next);
      if (next.votes < pose.votes) break;
      pose = next;
    }
    return pose;
  }

 private:
  /// Two that look nothing alike propose nothing: no weight would be left to fit them by.
  bool fit_together(const Partner& p, const Partner& q) const {
    if (p.b == q.b || p.likeness + q.likeness <= 0) return false;
    const Eigen::Vector3d in_a = q.in_a - p.in_a, in_b = q.in_b - p.in_b;
    const double flat_a = in_a.head<2>().norm(), flat_b = in_b.head<2>().norm();
    const auto nearest = static_cast<double>(config_.nearest_m),
               slack = static_cast<double>(config_.slack_m);
    return flat_a >= nearest && std::fabs(flat_a - flat_b) <= slack &&
           std::fabs(in_a.z() - in_b.z()) <= slack;
  }

  /// The likeliest partner of each object of b that the pose puts in its place.
  std::vector<const Partner*> voters_of(const UprightPose& pose) const {
    const auto slack = static_cast<double>(config_.slack_m);
    std::vector<const Partner*> best(objects_, nullptr);
    for (const Partner& partner : partners_)
      if ((best[partner.b] == nullptr || best[partner.b]->likeness < partner.likeness) &&
          (pose(partner.in_b) - partner.in_a).squaredNorm() < slack * slack)
        best[partner.b] = &partner;
    std::erase(best, nullptr);
    return best;
  }

  void count(UprightPose& pose) const {
    pose.votes = 0, pose.objects = 0;
    for (const Partner* voter : voters_of(pose)) pose.votes += voter->likeness, ++pose.objects;
  }

  const std::vector<Partner>& partners_;
  std::size_t objects_;
  const ObjectLayoutConfig& config_;
};

}  // namespace

void list_fields(ObjectLayoutConfig& config, ConfigFields& fields) {
  fields.add("min_likeness", config.min_likeness, 0.f, 1.f, "of size, for two objects to be one");
  fields.add("max_partners", config.max_partners, 1, 100, "objects that one object may be");
  fields.add("nearest_m", config.nearest_m, 0.f, 100.f,
             "two objects nearer to each other propose nothing, metres");
  fields.add("slack_m", config.slack_m, 0.f, 10.f,
             "by which distances between objects may differ, metres");
  fields.add("max_proposals", config.max_proposals, 1, 10000, "poses that are tried");
}

ObjectLayout layout_of(const MapRecord& map) {
  const Eigen::Matrix3f turn = ground_from_world(map.up);
  ObjectLayout layout;
  layout.ground_from_world.linear() = turn.cast<double>();
  layout.encoder = map.semantics.encoder;
  for (const InstanceSummary& instance : map.instances) {
    if (instance.box.isEmpty()) continue;
    const auto surface = map.surfaces.find(instance.id);
    const bool known = surface != map.surfaces.end() && !surface->second.empty();
    Landmark& landmark = layout.landmarks.emplace_back(
        landmark_of(known ? shape_of_points(turn, surface->second)
                          : shape_of_box(turn, instance.box, instance.centroid)));
    landmark.look = fuse_views(appearance_of(map, instance.id).views, map.semantics.views.fusion);
  }
  return layout;
}

std::vector<LayoutProposal> propose_poses(const ObjectLayout& a, const ObjectLayout& b,
                                          const ObjectLayoutConfig& config) {
  const std::vector<Partner> partners = find_partners(a, b, config);
  if (partners.empty()) return {};
  const Ballot ballot(partners, b.landmarks.size(), config);
  std::vector<UprightPose> all = ballot.all();
  std::stable_sort(all.begin(), all.end(),
                   [](const UprightPose& x, const UprightPose& y) { return x.votes > y.votes; });
  const auto most = static_cast<std::size_t>(config.max_proposals);
  std::vector<UprightPose> kept;
  for (std::size_t i = 0; i < all.size() && kept.size() < most; ++i) {
    const UprightPose pose = ballot.agreed(all[i]);
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const UprightPose& other) {
      return pose.near(other, partners.front().in_b);
    });
    if (!is_known) kept.push_back(pose);
  }
  std::vector<LayoutProposal> proposals;
  for (const UprightPose& pose : kept)
    proposals.push_back({a.ground_from_world.inverse() * pose.pose() * b.ground_from_world,
                         pose.votes, pose.objects});
  return proposals;
}

std::optional<float> look_similarity(const MapRecord& a, InstanceId id_a, const MapRecord& b,
                                     InstanceId id_b) {
  if (a.semantics.encoder != b.semantics.encoder) return std::nullopt;
  const Eigen::VectorXf x = fuse_views(appearance_of(a, id_a).views, a.semantics.views.fusion),
                        y = fuse_views(appearance_of(b, id_b).views, b.semantics.views.fusion);
  if (x.size() == 0 || x.size() != y.size()) return std::nullopt;
  return x.dot(y);
}

float size_similarity(const InstanceSummary& a, const InstanceSummary& b) {
  if (a.box.isEmpty() || b.box.isEmpty()) return 0.f;
  Eigen::Vector3f x = a.box.sizes(), y = b.box.sizes();
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  return size_ratio(x, y);
}

}  // namespace ovimap
