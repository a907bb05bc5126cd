// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/map_alignment.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/revise/object_overlap.h"

namespace ovimap {

namespace {

/// A map's surface, thinned, with normals; and the space its cameras looked through.
struct SurfaceCloud {
  std::vector<Eigen::Vector3f> points, normals;
  std::vector<std::uint8_t> telling;  ///< whether a point counts when an answer is judged
  std::size_t telling_count = 0;
  ObservedSpace space;

  SurfaceCloud(const MapDocument& map, const AlignmentConfig& config)
      : space(map.map, map.depth_camera, poses(map), config.space) {
    Mesh mesh = extract_mesh(map.map);
    mesh.labels.assign(mesh.vertices.size(), 1);
    std::vector<std::pair<std::array<int, 3>, std::uint32_t>> cells(mesh.vertices.size());
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      const Eigen::Vector3i cell = floor_to_int(mesh.vertices[i] / config.spacing_m);
      cells[i] = {{cell.x(), cell.y(), cell.z()}, i};
    }
    std::sort(cells.begin(), cells.end());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 0 && cells[i].first == cells[i - 1].first) continue;
      points.push_back(mesh.vertices[cells[i].second]);
      normals.push_back(mesh.normals[cells[i].second]);
    }
    mark_telling(map.up);
  }

  /// Floors and ceilings lie on each other wherever one map is put on the other; only upright
  /// surface tells answers apart. Where there is hardly any, everything counts.
  void mark_telling(const Eigen::Vector3f& up) {
    constexpr float kLevel = 0.8f;
    constexpr std::size_t kFew = 200;
    telling.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      telling_count += telling[i] = std::fabs(normals[i].dot(up)) < kLevel;
    if (telling_count >= kFew) return;
    std::fill(telling.begin(), telling.end(), 1);
    telling_count = points.size();
  }

  static std::vector<Pose> poses(const MapDocument& map) {
    std::vector<Pose> result;
    for (const FrameLogEntry& frame : map.frames) result.push_back(frame.world_from_camera);
    return result;
  }
};

/// An object of b that may be one of a. Positions in the upright frames.
struct Partner {
  std::size_t b = 0;
  Eigen::Vector3d in_a = Eigen::Vector3d::Zero(), in_b = Eigen::Vector3d::Zero();
  double likeness = 0;
};

Eigen::Matrix3d upright_from_world(const Eigen::Vector3f& up) {
  return Eigen::Quaternionf::FromTwoVectors(up, Eigen::Vector3f::UnitZ())
      .toRotationMatrix()
      .cast<double>();
}

std::vector<Partner> find_partners(const MapDocument& a, const MapDocument& b,
                                   const AlignmentConfig& config) {
  const Eigen::Matrix3d turn_a = upright_from_world(a.up), turn_b = upright_from_world(b.up);
  std::vector<Partner> partners;
  for (std::size_t j = 0; j < b.instances.size(); ++j) {
    std::vector<Partner> of_one;
    for (const InstanceSummary& other : a.instances) {
      const float size = size_similarity(other, b.instances[j]);
      if (size < config.min_likeness) continue;
      const auto look = look_similarity(a, other.id, b, b.instances[j].id);
      of_one.push_back({j, turn_a * other.centroid.cast<double>(),
                        turn_b * b.instances[j].centroid.cast<double>(),
                        double{size} * (look ? std::max(double{*look}, 0.) : 0.5)});
    }
    std::stable_sort(of_one.begin(), of_one.end(),
                     [](const Partner& x, const Partner& y) { return x.likeness > y.likeness; });
    of_one.resize(std::min(of_one.size(), static_cast<std::size_t>(config.max_partners)));
    partners.insert(partners.end(), of_one.begin(), of_one.end());
  }
  constexpr std::size_t kMostPartners = 400;  // their pairs are all tried
  std::stable_sort(partners.begin(), partners.end(),
                   [](const Partner& x, const Partner& y) { return x.likeness > y.likeness; });
  partners.resize(std::min(partners.size(), kMostPartners));
  return partners;
}

/// A turn about the vertical and a shift, in the upright frames.
struct Proposal {
  double yaw = 0;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double votes = 0;

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()) + shift;
  }
  bool near(const Proposal& other, const Eigen::Vector3d& somewhere) const {
    constexpr double kSameShift_m = 0.4, kSameYaw_rad = 0.25;
    return std::fabs(std::remainder(yaw - other.yaw, 2 * M_PI)) < kSameYaw_rad &&
           ((*this)(somewhere)-other(somewhere)).norm() < kSameShift_m;
  }
};

/// The best partner of each object of b that the proposal puts in its place.
double votes_for(const Proposal& proposal, const std::vector<Partner>& partners,
                 std::vector<double>& best_of_object) {
  constexpr double kSamePlace_m = 0.25;
  std::fill(best_of_object.begin(), best_of_object.end(), 0.);
  for (const Partner& partner : partners)
    if ((proposal(partner.in_b) - partner.in_a).squaredNorm() < kSamePlace_m * kSamePlace_m)
      best_of_object[partner.b] = std::max(best_of_object[partner.b], partner.likeness);
  return std::accumulate(best_of_object.begin(), best_of_object.end(), 0.);
}

/// What two partners propose together, if their distances agree.
std::optional<Proposal> propose(const Partner& p, const Partner& q) {
  constexpr double kNearest_m = 0.6, kSlack_m = 0.2;
  if (p.b == q.b) return std::nullopt;
  const Eigen::Vector3d in_a = q.in_a - p.in_a, in_b = q.in_b - p.in_b;
  const double flat_a = in_a.head<2>().norm(), flat_b = in_b.head<2>().norm();
  if (flat_a < kNearest_m || std::fabs(flat_a - flat_b) > kSlack_m ||
      std::fabs(in_a.z() - in_b.z()) > kSlack_m)
    return std::nullopt;
  Proposal proposal;
  proposal.yaw = std::atan2(in_a.y(), in_a.x()) - std::atan2(in_b.y(), in_b.x());
  proposal.shift = 0.5 * (p.in_a + q.in_a) - proposal(0.5 * (p.in_b + q.in_b));
  return proposal;
}

/// The proposals that most objects speak for, different ones.
std::vector<Proposal> best_proposals(const std::vector<Partner>& partners, std::size_t objects) {
  constexpr std::size_t kKept = 24;
  std::vector<std::vector<Proposal>> of_first(partners.size());
  parallel_for(partners.size(), 1, [&](std::size_t i) {
    std::vector<double> best(objects);
    for (std::size_t j = i + 1; j < partners.size(); ++j)
      if (auto proposal = propose(partners[i], partners[j])) {
        proposal->votes = votes_for(*proposal, partners, best);
        of_first[i].push_back(*proposal);
      }
  });
  std::vector<Proposal> all;
  for (const auto& list : of_first) all.insert(all.end(), list.begin(), list.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Proposal& x, const Proposal& y) { return x.votes > y.votes; });
  std::vector<Proposal> kept;
  const Eigen::Vector3d somewhere = partners.empty() ? Eigen::Vector3d(0, 0, 0) : partners[0].in_b;
  for (const Proposal& proposal : all) {
    if (kept.size() == kKept) break;
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Proposal& other) { return proposal.near(other, somewhere); }))
      kept.push_back(proposal);
  }
  return kept;
}

/// Fits b's surface to a's: point-to-plane ICP with a shrinking reach (Chen and Medioni 1992).
class SurfaceFit {
 public:
  SurfaceFit(const SurfaceCloud& a, const SurfaceCloud& b) : a_(a), b_(b), nearest_(a.points) {}

  Pose refine(Pose pose, std::initializer_list<float> reaches_m, int rounds) const {
    for (const float reach : reaches_m)
      for (int i = 0; i < rounds; ++i) pose = step(pose, reach);
    return pose;
  }

  const NearestPoints& nearest() const { return nearest_; }

 private:
  Pose step(const Pose& pose, float reach_m) const {
    const Eigen::Isometry3f moved_from_b = pose.cast<float>();
    std::vector<Eigen::Vector3f> moved(b_.points.size());
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = moved_from_b * b_.points[i];
    const auto found = nearest_.find_all(moved, reach_m);
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Identity() * 1e-6;
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < moved.size(); ++i) {
      if (!found[i]) continue;
      const Eigen::Vector3f& plane = a_.normals[found[i]->index];
      if (plane.dot(moved_from_b.linear() * b_.normals[i]) < 0.6f) continue;
      const Eigen::Vector3d p = moved[i].cast<double>(), n = plane.cast<double>();
      Eigen::Matrix<double, 6, 1> row;
      row << p.cross(n), n;
      normal += row * row.transpose();
      right += row * n.dot(a_.points[found[i]->index].cast<double>() - p);
    }
    const Eigen::Matrix<double, 6, 1> change = normal.ldlt().solve(right);
    if (!change.allFinite()) return pose;
    Pose correction = Pose::Identity();
    const Eigen::Vector3d turn = change.head<3>();
    if (turn.norm() > 0)
      correction.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    correction.translation() = change.tail<3>();
    return rigid_pose((correction * pose).matrix());  // products drift
  }

  const SurfaceCloud& a_;
  const SurfaceCloud& b_;
  NearestPoints nearest_;
};

struct Tally {
  std::size_t meets = 0, contradicted = 0;
};

/// Surface of one map against the other: meets its surface, or lies where it saw through.
Tally tally(const SurfaceCloud& from, const Pose& to_from, const SurfaceCloud& to,
            const NearestPoints& nearest, float reach_m) {
  const Eigen::Isometry3f pose = to_from.cast<float>();
  std::vector<std::uint8_t> verdict(from.points.size());
  parallel_for(from.points.size(), 64, [&](std::size_t i) {
    if (from.telling[i] == 0) return;
    const Eigen::Vector3f point = pose * from.points[i];
    const auto found = nearest.find(point, reach_m);
    if (found && to.normals[found->index].dot(pose.linear() * from.normals[i]) > 0.6f)
      verdict[i] = 1;
    else if (to.space.seen_through(point, 2) >= 2)
      verdict[i] = 2;
  });
  return {static_cast<std::size_t>(std::count(verdict.begin(), verdict.end(), 1)),
          static_cast<std::size_t>(std::count(verdict.begin(), verdict.end(), 2))};
}

class Judge {
 public:
  Judge(const SurfaceCloud& a, const SurfaceCloud& b, const AlignmentConfig& config)
      : a_(a),
        b_(b),
        in_a_(a.points),
        in_b_(b.points),
        // A point of a thinned surface may be a step away sideways.
        reach_m_(std::hypot(config.tolerance_m, 0.75f * config.spacing_m)) {}

  MapAlignment operator()(const Pose& a_from_b) const {
    const Tally of_b = tally(b_, a_from_b, a_, in_a_, reach_m_),
                of_a = tally(a_, a_from_b.inverse(), b_, in_b_, reach_m_);
    MapAlignment result;
    result.a_from_b = a_from_b;
    const std::size_t smaller =
        std::max<std::size_t>(1, std::min(a_.telling_count, b_.telling_count));
    result.overlap = static_cast<float>(of_b.meets) / static_cast<float>(smaller);
    result.overlap = std::min(result.overlap, 1.f);
    const std::size_t agree = of_a.meets + of_b.meets,
                      judged = agree + of_a.contradicted + of_b.contradicted;
    result.fit = judged == 0 ? 0.f : static_cast<float>(agree) / static_cast<float>(judged);
    return result;
  }

 private:
  const SurfaceCloud &a_, &b_;
  NearestPoints in_a_, in_b_;
  float reach_m_;
};

bool same_answer(const Pose& x, const Pose& y) {
  constexpr double kSameShift_m = 0.2, kSameTurn_rad = 0.1;
  const Pose between = x.inverse() * y;
  return between.translation().norm() < kSameShift_m &&
         Eigen::AngleAxisd(between.linear()).angle() < kSameTurn_rad;
}

std::string share(float value) {
  return std::to_string(std::lround(100 * value)) + " %";
}

void require_convincing(const MapAlignment& best, const AlignmentConfig& config) {
  const bool clear = best.runner_up < 0.5f * best.score();
  const char* why = nullptr;
  if (best.overlap < config.min_overlap)
    why = "too little of their surfaces would meet";
  else if (best.fit < (clear ? config.min_clear_fit : config.min_fit))
    why = "they would contradict each other";
  else if (best.score() - best.runner_up < config.min_lead * best.score())
    why = "another answer fits as well";
  if (why != nullptr)
    throw Error(concat("the maps cannot be aligned with confidence: ", why, " (overlap ",
                       share(best.overlap), ", fit ", share(best.fit), ", next best ",
                       share(best.score() > 0 ? best.runner_up / best.score() : 1.f),
                       " of it); give the transform with --transform FILE"));
}

}  // namespace

void list_fields(AlignmentConfig& config, ConfigFields& fields) {
  fields.add("min_overlap", config.min_overlap, 0.f, 1.f, "of surface that must meet");
  fields.add("min_fit", config.min_fit, 0.f, 1.f, "of surface where both looked that must agree");
  fields.add("min_clear_fit", config.min_clear_fit, 0.f, 1.f,
             "the same where the next other answer is not half as good");
  fields.add("min_lead", config.min_lead, 0.f, 1.f, "over the next other answer, as a share");
  fields.add("min_likeness", config.min_likeness, 0.f, 1.f, "of size, for two objects to be one");
  fields.add("max_partners", config.max_partners, 1, 100, "objects that one object may be");
  fields.add("spacing_m", config.spacing_m, 0.001f, 1.f, "between fitted surface points, metres");
  fields.add("tolerance_m", config.tolerance_m, 0.001f, 1.f, "surfaces this near agree, metres");
  fields.group("space", [&](ConfigFields& space) { list_fields(config.space, space); });
}

MapAlignment judge_alignment(const MapDocument& a, const MapDocument& b, const Pose& a_from_b,
                             const AlignmentConfig& config) {
  const SurfaceCloud cloud_a(a, config), cloud_b(b, config);
  return Judge(cloud_a, cloud_b, config)(a_from_b);
}

MapAlignment align_maps(const MapDocument& a, const MapDocument& b, const AlignmentConfig& config) {
  const std::vector<Partner> partners = find_partners(a, b, config);
  const std::vector<Proposal> proposals = best_proposals(partners, b.instances.size());
  if (proposals.empty())
    throw Error(
        "the maps cannot be aligned: too few objects are alike; give the transform with "
        "--transform FILE");
  const SurfaceCloud cloud_a(a, config), cloud_b(b, config);
  const SurfaceFit fit(cloud_a, cloud_b);
  const Judge judge(cloud_a, cloud_b, config);
  const Eigen::Matrix3d turn_a = upright_from_world(a.up), turn_b = upright_from_world(b.up);
  std::vector<MapAlignment> answers;
  for (const Proposal& proposal : proposals) {
    Pose upright = Pose::Identity();
    upright.linear() = Eigen::AngleAxisd(proposal.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    upright.translation() = proposal.shift;
    const Pose start = Pose(turn_a.transpose()) * upright * Pose(turn_b);
    answers.push_back(judge(fit.refine(start, {0.4f, 0.2f, 0.1f}, 6)));
  }
  std::stable_sort(answers.begin(), answers.end(),
                   [](const auto& x, const auto& y) { return x.score() > y.score(); });
  MapAlignment best = judge(fit.refine(answers[0].a_from_b, {0.1f, 0.06f}, 10));
  for (const MapAlignment& other : answers)
    if (!same_answer(other.a_from_b, best.a_from_b))
      best.runner_up = std::max(best.runner_up, other.score());
  require_convincing(best, config);
  return best;
}

}  // namespace ovimap
