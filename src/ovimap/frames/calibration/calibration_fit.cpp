// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/calibration/calibration_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr int kUnknowns = 13;
/// Deviations from the given view: log of the focal length, log of fx / fy, principal point,
/// rotation vector, translation, outset, k1 and k2 of the lens; each in its standard deviations.
using Deviation = Eigen::Matrix<double, kUnknowns, 1>;
using Hessian = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// With `bends` the lens may differ as well.
Deviation sigmas(const ColorView& given, const CalibrationFitConfig& config, bool bends) {
  const double center_px = config.center_sigma * static_cast<float>(given.camera.width);
  const double turn = config.rotation_sigma_rad, move = config.translation_sigma_m;
  const double radial = bends ? config.radial_sigma : 0.f;
  Deviation sigma;
  sigma << config.focal_sigma, config.aspect_sigma, center_px, center_px, turn, turn, turn, move,
      move, move, config.outset_sigma_px, radial, radial;
  return sigma;
}

FittedView moved(const FittedView& origin, const Deviation& sigma, const Deviation& deviation) {
  const Deviation d = deviation.cwiseProduct(sigma);
  const ColorView& given = origin.view;
  ColorView view = given;
  view.camera.fx = static_cast<float>(given.camera.fx * std::exp(d[0] + d[1] / 2));
  view.camera.fy = static_cast<float>(given.camera.fy * std::exp(d[0] - d[1] / 2));
  view.camera.cx = static_cast<float>(given.camera.cx + d[2]);
  view.camera.cy = static_cast<float>(given.camera.cy + d[3]);
  const Eigen::Vector3d turn = d.segment<3>(4);
  if (turn.norm() > 0)
    view.color_from_depth.linear() =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() *
        given.color_from_depth.linear();
  view.color_from_depth.translation() += d.segment<3>(7);
  if (sigma[11] > 0) {
    view.lens.model = Lens::Model::kBrownConrady;
    view.lens.coefficients[0] += d[11];
    view.lens.coefficients[1] += d[12];
  }
  return {view, origin.outset_px + static_cast<float>(d[10])};
}

/// A field of distances between pixels, with its slope.
struct Sampled {
  float px, slope_x, slope_y;
};

bool in_field(const Image<std::uint8_t>& field, const Eigen::Vector2f& pixel) {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < static_cast<float>(field.width() - 1) &&
         pixel.y() < static_cast<float>(field.height() - 1);
}

Sampled sample(const Image<std::uint8_t>& field, const Eigen::Vector2f& pixel) {
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  const float u = pixel.x() - static_cast<float>(x), v = pixel.y() - static_cast<float>(y);
  const std::uint8_t* above = field.row(y) + x;
  const std::uint8_t* below = field.row(y + 1) + x;
  const float a = above[0], b = above[1], c = below[0], d = below[1];
  constexpr float kPixel = 1 / CalibrationEdges::kStepsPerPixel;
  return {kPixel * ((1 - v) * (a + u * (b - a)) + v * (c + u * (d - c))),
          kPixel * ((1 - v) * (b - a) + v * (d - c)), kPixel * ((1 - u) * (c - a) + u * (d - b))};
}

const Image<std::uint8_t>& field_of(const CalibrationEdges& frame, const DepthEdge& edge) {
  return frame.color_distance[static_cast<std::size_t>(edge.side)];
}

struct Normal {
  Hessian hessian = Hessian::Zero();
  Deviation gradient = Deviation::Zero();
  double loss = 0;
  std::size_t edges = 0;

  void operator+=(const Normal& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    loss += other.loss;
    edges += other.edges;
  }
};

/// A fitted view with what it takes to project many points fast.
class Projection {
 public:
  explicit Projection(const FittedView& fitted)
      : camera_(fitted.view.camera),
        k1_(static_cast<float>(fitted.view.lens.coefficients[0])),
        k2_(static_cast<float>(fitted.view.lens.coefficients[1])),
        rotation_(fitted.view.color_from_depth.linear().cast<float>()),
        translation_(fitted.view.color_from_depth.translation().cast<float>()),
        outset_px_(fitted.outset_px) {}

  /// Relative to the colour camera's centre, in the axes of its frame.
  Eigen::Vector3f turned(const DepthEdge& edge) const {
    return rotation_ * (edge.x_in_depth + outset_px_ * edge.outwards);
  }
  Eigen::Vector3f outwards(const DepthEdge& edge) const { return rotation_ * edge.outwards; }
  const Eigen::Vector3f& translation() const { return translation_; }
  const PinholeCamera& camera() const { return camera_; }

  /// Pixel of a point before the colour camera.
  Eigen::Vector2f pixel(const Eigen::Vector3f& x) const {
    const Eigen::Vector2f bent = scale(x) * x.head<2>() / x.z();
    return {camera_.fx * bent.x() + camera_.cx, camera_.fy * bent.y() + camera_.cy};
  }
  /// What a slope over the bent ray, focal length 1, is over the straight one.
  Eigen::Vector2f unbent(const Eigen::Vector2f& slope, const Eigen::Vector2f& ray) const {
    return scale_at(ray.squaredNorm()) * slope +
           2 * (k1_ + 2 * k2_ * ray.squaredNorm()) * slope.dot(ray) * ray;
  }

 private:
  float scale_at(float r2) const { return 1 + r2 * (k1_ + r2 * k2_); }
  float scale(const Eigen::Vector3f& x) const {
    return scale_at(x.head<2>().squaredNorm() / (x.z() * x.z()));
  }

  PinholeCamera camera_;
  float k1_, k2_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
  float outset_px_;
};

/// The loss of a distance r is Geman and McClure's, r^2 / (r^2 + reach^2): near edges pull, far
/// ones do not.
class Refinement {
 public:
  Refinement(const EdgeFrames& frames, const FittedView& origin, const Deviation& sigma,
             const CalibrationFitConfig& config, float reach_px, std::size_t stride)
      : frames_(frames),
        origin_(origin),
        sigma_(sigma),
        prior_(config.prior_weight),
        square_reach_(reach_px * reach_px),
        stride_(stride) {}

  /// Levenberg and Marquardt's steps from `deviation`.
  Deviation refine(Deviation deviation, int iterations) const {
    Normal at = normal(deviation);
    double damping = 1e-3;
    for (int i = 0; i < iterations && damping < 1e6; ++i) {
      Hessian damped = at.hessian;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-9;
      const Deviation step = -damped.ldlt().solve(at.gradient);
      const Deviation next = deviation + step;
      const Normal there = normal(next);
      if (there.loss < at.loss) {
        const bool small = at.loss - there.loss < 1e-5 * at.loss;
        deviation = next;
        at = there;
        damping = std::max(1e-7, damping / 5);
        if (small) break;
      } else {
        damping *= 6;
      }
    }
    return deviation;
  }

 private:
  Normal normal(const Deviation& deviation) const {
    const Projection projection(moved(origin_, sigma_, deviation));
    std::vector<Normal> parts(frames_.size());
    parallel_for(frames_.size(), 1,
                 [&](std::size_t i) { parts[i] = of_frame(*frames_[i], i, projection); });
    Normal sum;
    for (const Normal& part : parts) sum += part;
    const double share = 1 / static_cast<double>(std::max<std::size_t>(1, sum.edges));
    sum.hessian *= share;
    sum.gradient *= share;
    sum.loss = sum.loss * share + prior_ * deviation.squaredNorm();
    sum.hessian.diagonal().array() += prior_;
    sum.gradient += prior_ * deviation;
    return sum;
  }

  Normal of_frame(const CalibrationEdges& frame, std::size_t index,
                  const Projection& projection) const {
    Normal sum;
    for (std::size_t i = index % stride_; i < frame.depth.size(); i += stride_) {
      const DepthEdge& edge = frame.depth[i];
      const Eigen::Vector3f arm = projection.turned(edge);
      const Eigen::Vector3f x = arm + projection.translation();
      const Eigen::Vector2f pixel = projection.pixel(x);
      const Image<std::uint8_t>& field = field_of(frame, edge);
      if (!(x.z() > 0) || !in_field(field, pixel)) continue;
      const Sampled at = sample(field, pixel);
      const float square = at.px * at.px, near = square_reach_ / (square + square_reach_);
      const double weight = near * near / square_reach_;
      ++sum.edges;
      sum.loss += 1 - near;
      if (at.px == 0) continue;
      const Deviation slope = slope_of(at, arm, pixel, projection, edge);
      sum.gradient += weight * at.px * slope;
      sum.hessian.noalias() += (weight * slope) * slope.transpose();
    }
    return sum;
  }

  /// Derivative of the distance by the deviation.
  Deviation slope_of(const Sampled& at, const Eigen::Vector3f& arm, const Eigen::Vector2f& pixel,
                     const Projection& projection, const DepthEdge& edge) const {
    const PinholeCamera& camera = projection.camera();
    const float z = arm.z() + projection.translation().z();
    const float right = at.slope_x * (pixel.x() - camera.cx);
    const float down = at.slope_y * (pixel.y() - camera.cy);
    const Eigen::Vector2f ray = (arm + projection.translation()).head<2>() / z;
    const Eigen::Vector2f by_bent(at.slope_x * camera.fx, at.slope_y * camera.fy);
    const Eigen::Vector2f by_ray = projection.unbent(by_bent, ray);
    const Eigen::Vector3f by_point(by_ray.x() / z, by_ray.y() / z, -by_ray.dot(ray) / z);
    const Eigen::Vector3f by_turn = arm.cross(by_point);
    const float by_k1 = by_bent.dot(ray) * ray.squaredNorm();
    Deviation slope;
    slope << right + down, (right - down) / 2, at.slope_x, at.slope_y, by_turn.cast<double>(),
        by_point.cast<double>(), by_point.dot(projection.outwards(edge)), by_k1,
        by_k1 * ray.squaredNorm();
    return slope.cwiseProduct(sigma_);
  }

  const EdgeFrames& frames_;
  const FittedView& origin_;
  Deviation sigma_;
  double prior_;
  float square_reach_;
  std::size_t stride_;
};

struct Start {
  Deviation deviation;
  double score;
};

/// One of every so many edges, to look at `points` of them.
std::size_t stride_for(const EdgeFrames& frames, int points) {
  std::size_t edges = 0;
  for (const CalibrationEdges* frame : frames) edges += frame->depth.size();
  return std::max<std::size_t>(1, edges / static_cast<std::size_t>(points));
}

/// Focal lengths and shifts of the principal point, each scored by a few edges.
std::vector<Start> search(const EdgeFrames& frames, const ColorView& given,
                          const CalibrationFitConfig& config) {
  constexpr int kScales = 4, kShifts = 6;  // to either side
  constexpr int kSide = 2 * kShifts + 1;
  const Deviation sigma = sigmas(given, config, false);
  const FittedView origin{given, 0};
  const double shift_px = config.max_shift * static_cast<float>(given.camera.width) / kShifts;
  const float reach_px = 2 * config.truncation * static_cast<float>(given.camera.width);
  const std::size_t stride = stride_for(frames, config.search_points);
  std::vector<Start> starts((2 * kScales + 1) * kSide * kSide);
  parallel_for(starts.size(), 8, [&](std::size_t i) {
    const int cell = static_cast<int>(i);
    Deviation d = Deviation::Zero();
    d[0] = std::log(config.max_scale) * (cell / (kSide * kSide) - kScales) / kScales / sigma[0];
    d[2] = shift_px * (cell % kSide - kShifts) / sigma[2];
    d[3] = shift_px * (cell / kSide % kSide - kShifts) / sigma[3];
    starts[i] = {d, edge_score(frames, moved(origin, sigma, d), reach_px, stride).mean_px};
  });
  return starts;
}

/// The given view and the best of the search that are not near a better one.
std::vector<Deviation> find_starts(const EdgeFrames& frames, const ColorView& given,
                                   const CalibrationFitConfig& config) {
  if (config.starts == 1) return {Deviation::Zero()};
  const Deviation sigma = sigmas(given, config, false);
  std::vector<Start> starts = search(frames, given, config);
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.score < b.score; });
  std::vector<Deviation> best = {Deviation::Zero()};
  for (const Start& start : starts) {
    if (static_cast<int>(best.size()) >= config.starts) break;
    const bool known = std::any_of(best.begin(), best.end(), [&](const Deviation& other) {
      const Deviation apart = (start.deviation - other).cwiseProduct(sigma);
      return std::abs(apart[0]) < 0.1 && apart.segment<2>(2).norm() < 0.03 * given.camera.width;
    });
    if (!known) best.push_back(start.deviation);
  }
  return best;
}

}  // namespace

void list_fields(CalibrationFitConfig& config, ConfigFields& fields) {
  fields.add("focal_sigma", config.focal_sigma, 0.0001f, 10.f,
             "how far the focal length may lie from the given, share");
  fields.add("aspect_sigma", config.aspect_sigma, 0.0001f, 10.f, "likewise of fx / fy");
  fields.add("center_sigma", config.center_sigma, 0.0001f, 10.f,
             "likewise of the principal point, share of the width");
  fields.add("rotation_sigma_rad", config.rotation_sigma_rad, 0.0001f, 10.f,
             "likewise of the rotation, radians");
  fields.add("translation_sigma_m", config.translation_sigma_m, 0.0001f, 10.f,
             "likewise of the translation, metres");
  fields.add("radial_sigma", config.radial_sigma, 0.0001f, 10.f,
             "likewise of either radial coefficient of a lens");
  fields.add("prior_weight", config.prior_weight, 0.f, 100.f, "how firmly the given view holds");
  fields.add("outset_sigma_px", config.outset_sigma_px, 0.0001f, 10.f,
             "how far edges of depth may lie inside the true ones, pixels");
  fields.add("search_points", config.search_points, 100, 10000000,
             "edges that the search looks at");
  fields.add("start_points", config.start_points, 100, 10000000, "edges that refine the starts");
  fields.add("final_points", config.final_points, 100, 10000000,
             "edges that the last refinement looks at");
  fields.add("finest", config.finest, 0.0001f, 1.f,
             "reach of the last refinement, share of the width");
  fields.add("starts", config.starts, 1, 1000, "views that are refined");
  fields.add("iterations", config.iterations, 1, 1000, "of each level of each start");
  fields.add("truncation", config.truncation, 0.001f, 1.f,
             "edges farther off count as that far, share of the width");
  fields.add("max_shift", config.max_shift, 0.f, 1.f,
             "shifts of colour that are tried, share of the width");
  fields.add("max_scale", config.max_scale, 1.f, 10.f,
             "factors on the focal length that are tried");
}

Eigen::Vector2f ColorView::project(const Eigen::Vector3f& x_in_depth) const {
  const Eigen::Vector3f x_in_color = (color_from_depth * x_in_depth.cast<double>()).cast<float>();
  if (x_in_color.z() <= 0)
    return Eigen::Vector2f::Constant(std::numeric_limits<float>::quiet_NaN());
  const Eigen::Vector2d bent = lens.bend(x_in_color.head<2>().cast<double>() / x_in_color.z());
  return {camera.fx * static_cast<float>(bent.x()) + camera.cx,
          camera.fy * static_cast<float>(bent.y()) + camera.cy};
}

EdgeScore edge_score(const EdgeFrames& frames, const FittedView& fitted, float truncation_px,
                     std::size_t stride) {
  EdgeScore score;
  double sum = 0;
  const Projection projection(fitted);
  for (std::size_t k = 0; k < frames.size(); ++k)
    for (std::size_t i = k % stride; i < frames[k]->depth.size(); i += stride) {
      const DepthEdge& edge = frames[k]->depth[i];
      const Eigen::Vector3f x = projection.turned(edge) + projection.translation();
      const Eigen::Vector2f pixel = projection.pixel(x);
      const Image<std::uint8_t>& field = field_of(*frames[k], edge);
      if (!(x.z() > 0) || !in_field(field, pixel)) continue;
      sum += std::min(truncation_px, sample(field, pixel).px);
      ++score.edges;
    }
  score.mean_px = score.edges > 0 ? sum / static_cast<double>(score.edges) : truncation_px;
  return score;
}

FittedView fit_color_view(const EdgeFrames& frames, const ColorView& given,
                          const CalibrationFitConfig& config) {
  const Deviation sigma = sigmas(given, config, false);
  const FittedView origin{given, 0};
  const float width_px = static_cast<float>(given.camera.width);
  const auto refined = [&](const Deviation& from, float reach, std::size_t stride) {
    return Refinement(frames, origin, sigma, config, reach * width_px, stride)
        .refine(from, config.iterations);
  };
  const std::size_t stride = stride_for(frames, config.start_points);
  Deviation best = Deviation::Zero();
  double best_px = std::numeric_limits<double>::infinity();
  for (const Deviation& start : find_starts(frames, given, config)) {
    const Deviation found =
        refined(refined(start, 8 * config.finest, stride), 4 * config.finest, stride);
    const double px =
        edge_score(frames, moved(origin, sigma, found), config.truncation * width_px, stride)
            .mean_px;
    if (px < best_px) best_px = px, best = found;
  }
  for (const float reach : {2 * config.finest, config.finest})
    best = refined(best, reach, stride_for(frames, config.final_points));
  return moved(origin, sigma, best);
}

FittedView fit_lens(const EdgeFrames& frames, const FittedView& straight,
                    const CalibrationFitConfig& config) {
  const Deviation sigma = sigmas(straight.view, config, true);
  const float width_px = static_cast<float>(straight.view.camera.width);
  Deviation found = Deviation::Zero();
  for (const float widening : {8.f, 4.f, 2.f, 1.f}) {
    const int points = widening > 2 ? config.start_points : config.final_points;
    found = Refinement(frames, straight, sigma, config, widening * config.finest * width_px,
                       stride_for(frames, points))
                .refine(found, config.iterations);
  }
  return moved(straight, sigma, found);
}

}  // namespace ovimap
