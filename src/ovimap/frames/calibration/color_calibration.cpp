// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/calibration/color_calibration.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::array kCompared = {0.1, 0.5, 0.9};  ///< of the edges, sorted by depth

struct Sample {
  std::vector<CalibrationEdges> edges;
  std::vector<std::int64_t> positions;
  std::optional<Frame> first;  ///< without images
};

bool moved(const Pose& a, const Pose& b, const ColorCalibrationConfig& config) {
  const Pose step = a.inverse() * b;
  return step.translation().norm() >= config.min_move_m ||
         Eigen::AngleAxisd(step.linear()).angle() >= config.min_turn_rad;
}

struct ReadEdges {
  std::optional<Frame> frame;  ///< without images
  CalibrationEdges edges;
};

ReadEdges read_edges(const FrameSource& source, std::int64_t position,
                     const CalibrationEdgesConfig& config) {
  ReadEdges result;
  FrameRead read = source.read(position);
  if (!read.frame) return result;
  result.edges = find_calibration_edges(*read.frame, config);
  result.frame = std::move(read.frame);
  result.frame->color = {};
  result.frame->depth = {};
  return result;
}

/// Frames of one pair of cameras, each from another place than the one before. `step` is called
/// with the number of frames read since the last call.
Sample draw(const FrameSource& source, const std::vector<std::int64_t>& positions,
            const ColorCalibrationConfig& config, const std::function<void(std::size_t)>& step) {
  constexpr std::size_t kTogether = 16;
  Sample sample;
  Pose last = Pose::Identity();
  for (std::size_t begin = 0; begin < positions.size(); begin += kTogether) {
    const std::size_t count = std::min(kTogether, positions.size() - begin);
    std::vector<ReadEdges> reads(count);
    parallel_for(count, 1, [&](std::size_t i) {
      reads[i] = read_edges(source, positions[begin + i], config.edges);
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (!reads[i].frame) continue;
      const Frame& frame = *reads[i].frame;
      if (sample.first && (!moved(last, frame.world_from_camera, config) ||
                           frame.color_camera != sample.first->color_camera ||
                           frame.depth_camera != sample.first->depth_camera))
        continue;
      last = frame.world_from_camera;
      sample.positions.push_back(positions[begin + i]);
      sample.edges.push_back(std::move(reads[i].edges));
      if (!sample.first) sample.first = frame;
    }
    step(count);
  }
  return sample;
}

std::vector<std::int64_t> evenly_chosen(const std::vector<std::int64_t>& positions, int wanted) {
  const std::size_t count = std::min(positions.size(), static_cast<std::size_t>(wanted));
  std::vector<std::int64_t> chosen(count);
  for (std::size_t i = 0; i < count; ++i) chosen[i] = positions[i * positions.size() / count];
  return chosen;
}

/// Quarters of the recording by turns, so that the halves see different places.
std::array<EdgeFrames, 2> halves(const std::vector<CalibrationEdges>& edges) {
  std::array<EdgeFrames, 2> parts;
  for (std::size_t i = 0; i < edges.size(); ++i)
    parts[i * 4 / edges.size() % 2].push_back(&edges[i]);
  return parts;
}

EdgeFrames all_of(const std::vector<CalibrationEdges>& edges) {
  EdgeFrames frames;
  for (const CalibrationEdges& frame : edges) frames.push_back(&frame);
  return frames;
}

/// Cells of the depth image, three by three, with at least a third of an even share of the edges.
int filled_cells(const std::vector<CalibrationEdges>& edges, const PinholeCamera& camera) {
  std::array<std::size_t, 9> counts{};
  std::size_t total = 0;
  for (const CalibrationEdges& frame : edges)
    for (const DepthEdge& edge : frame.depth) {
      const Eigen::Vector2f pixel = camera.project(edge.x_in_depth);
      const int x = std::clamp(static_cast<int>(3 * pixel.x()) / camera.width, 0, 2);
      const int y = std::clamp(static_cast<int>(3 * pixel.y()) / camera.height, 0, 2);
      ++counts[static_cast<std::size_t>(3 * y + x)];
      ++total;
    }
  return static_cast<int>(std::count_if(counts.begin(), counts.end(),
                                        [&](std::size_t count) { return 27 * count >= total; }));
}

std::array<float, kCompared.size()> edge_depths_m(const std::vector<CalibrationEdges>& edges) {
  std::vector<float> depths_m;
  for (const CalibrationEdges& frame : edges)
    for (const DepthEdge& edge : frame.depth) depths_m.push_back(edge.x_in_depth.z());
  std::sort(depths_m.begin(), depths_m.end());
  std::array<float, kCompared.size()> chosen{};
  for (std::size_t i = 0; i < chosen.size(); ++i)
    chosen[i] = depths_m[static_cast<std::size_t>(kCompared[i] * double(depths_m.size() - 1))];
  return chosen;
}

/// Views fitted to all frames, and to either half of them.
struct Fits {
  FittedView all, by_one, by_other;
};

/// Each half judged in the view that the other half gave.
double crossed_px(const Fits& fits, const EdgeFrames& one, const EdgeFrames& other,
                  float truncation_px) {
  return (edge_score(one, fits.by_other, truncation_px).mean_px +
          edge_score(other, fits.by_one, truncation_px).mean_px) /
         2;
}

/// The largest distance of two views' pixels at usual depths.
double largest_difference_px(const PinholeCamera& depth_camera, const ColorView& a,
                             const ColorView& b, std::span<const float> depths_m) {
  double largest = 0;
  for (const float depth_m : depths_m)
    largest = std::max(largest, view_difference_px(depth_camera, a, b, depth_m));
  return largest;
}

/// The smallest rise of the score when colour is moved by 1% of its width, as a share.
double sharpness_of(const EdgeFrames& frames, const FittedView& fitted, float truncation_px) {
  const double here = edge_score(frames, fitted, truncation_px).mean_px;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const double shift_px = 0.01 * fitted.view.camera.width;
    FittedView off = fitted;
    off.view.camera.cx += static_cast<float>(shift_px * std::cos(angle));
    off.view.camera.cy += static_cast<float>(shift_px * std::sin(angle));
    least = std::min(least, edge_score(frames, off, truncation_px).mean_px / here - 1);
  }
  return least;
}

std::string text_of(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// Why so few edges cannot tell where colour lies; empty when they may.
std::string too_little(const Sample& sample, const ColorCalibration& calibration,
                       const ColorCalibrationConfig& config) {
  if (static_cast<int>(sample.edges.size()) < config.min_frames)
    return concat("only ", sample.edges.size(), " usable frames from different places, ",
                  config.min_frames, " are needed; record while the camera moves");
  if (calibration.edges < static_cast<std::size_t>(config.min_edges))
    return concat("only ", calibration.edges, " points lie on edges of depth, ", config.min_edges,
                  " are needed; record objects that stand before others");
  const int cells = filled_cells(sample.edges, calibration.depth_camera);
  if (cells < config.min_cells)
    return concat("edges of depth lie in ", cells, " of 9 parts of the image, ", config.min_cells,
                  " are needed; turn the camera so that objects cross all of it");
  return {};
}

/// Fills in verdict and message from the measures.
void judge(ColorCalibration& result, double moved_px, const ColorCalibrationConfig& config) {
  using Verdict = ColorCalibration::Verdict;
  const float width_px = static_cast<float>(result.given.camera.width);
  if (!(result.spread_px <= config.max_spread * width_px)) {
    result.message = concat("the two halves of the frames differ by ", text_of(result.spread_px, 1),
                            " px; give more frames, with objects near and far");
  } else if (!(result.sharpness >= config.min_sharpness)) {
    result.message = concat("edges of colour and depth meet hardly better here than elsewhere (",
                            text_of(100 * result.sharpness, 0),
                            "%); record plain objects that stand before others, in good light");
  } else if (moved_px <= std::max<double>(config.aligned * width_px, result.spread_px)) {
    result.verdict = Verdict::kAligned;
    result.message = concat("colour lies where depth says, to ", text_of(moved_px, 1), " px");
  } else if (!(result.found_px <= (1 - config.min_gain) * result.given_px)) {
    result.message = concat("edges meet no better than as given (", text_of(result.found_px, 2),
                            " px instead of ", text_of(result.given_px, 2),
                            " px); give more frames, or a calibration nearer to the truth");
  } else {
    result.verdict = Verdict::kFound;
    result.message =
        concat("colour is off by ", text_of(moved_px, 1), " px; edges meet to ",
               text_of(result.found_px, 2), " px instead of ", text_of(result.given_px, 2), " px");
    if (result.found.lens != Lens{})
      result.message +=
          concat("; its lens bends: k1 ", text_of(result.found.lens.coefficients[0], 3), ", k2 ",
                 text_of(result.found.lens.coefficients[1], 3));
  }
}

}  // namespace

void list_fields(ColorCalibrationConfig& config, ConfigFields& fields) {
  fields.add("max_frames", config.max_frames, 2, 100000, "frames read");
  fields.add("min_frames", config.min_frames, 2, 100000, "fewer tell nothing");
  fields.add("min_edges", config.min_edges, 1, 1000000000, "fewer edge points tell nothing");
  fields.add("min_cells", config.min_cells, 1, 9, "parts of the image that must hold edges");
  fields.add("min_move_m", config.min_move_m, 0.f, 100.f, "a frame that moved less, metres,");
  fields.add("min_turn_rad", config.min_turn_rad, 0.f, 4.f,
             "and turned less, radians, than the one before is left out");
  fields.add("aligned", config.aligned, 0.f, 1.f,
             "colour that is off by less is right, share of the width");
  fields.add("max_spread", config.max_spread, 0.f, 1.f,
             "the halves of the frames must agree to this share of the width");
  fields.add("min_sharpness", config.min_sharpness, 0.f, 100.f,
             "how much worse edges must meet when colour is off by 1%");
  fields.add("min_gain", config.min_gain, 0.f, 1.f, "how much better than as given");
  fields.group("edges", [&](ConfigFields& inner) { list_fields(config.edges, inner); });
  fields.group("fit", [&](ConfigFields& inner) { list_fields(config.fit, inner); });
}

double view_difference_px(const PinholeCamera& depth_camera, const ColorView& a, const ColorView& b,
                          float depth_m) {
  constexpr int kPoints = 9;  // along each side
  double sum = 0;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const auto share = [](int k) { return static_cast<float>(k) / (kPoints - 1); };
    const Eigen::Vector3f x = depth_camera.unproject(
        share(i % kPoints) * static_cast<float>(depth_camera.width - 1),
        share(i / kPoints) * static_cast<float>(depth_camera.height - 1), depth_m);
    sum += (a.project(x) - b.project(x)).squaredNorm();
  }
  return std::sqrt(sum / (kPoints * kPoints));
}

ColorCalibration calibrate_color(
    const FrameSource& source, const std::vector<std::int64_t>& positions,
    const ColorCalibrationConfig& config,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
  constexpr std::size_t kFits = 3;
  const std::vector<std::int64_t> chosen = evenly_chosen(positions, config.max_frames);
  const std::size_t fit_steps = 1 + chosen.size() / 4, steps = chosen.size() + kFits * fit_steps;
  std::size_t done = 0;
  const auto advance = [&](std::size_t by) {
    done += by;
    if (progress) progress(done, steps);
  };
  const Sample sample = draw(source, chosen, config, advance);
  ColorCalibration result;
  result.positions = sample.positions;
  for (const CalibrationEdges& frame : sample.edges) result.edges += frame.depth.size();
  if (sample.first) {
    result.depth_camera = sample.first->depth_camera;
    result.given = {sample.first->color_camera, sample.first->color_from_depth};
    result.found = result.given;
  }
  result.message = too_little(sample, result, config);
  if (!result.message.empty()) return result;

  const EdgeFrames all = all_of(sample.edges);
  const auto [one, other] = halves(sample.edges);
  const auto fit = [&](const EdgeFrames& part) {
    const FittedView fitted = fit_color_view(part, result.given, config.fit);
    advance(fit_steps);
    return fitted;
  };
  Fits fits = {fit(all), fit(one), fit(other)};
  const float width_px = static_cast<float>(result.given.camera.width);
  const float truncation_px = config.fit.truncation * width_px;
  const auto depths_m = edge_depths_m(sample.edges);
  const auto differ = [&](const FittedView& a, const FittedView& b) {
    return largest_difference_px(result.depth_camera, a.view, b.view, depths_m);
  };
  result.found_px = crossed_px(fits, one, other, truncation_px);
  if (!source.rectified()) {
    const auto bent = [&](const EdgeFrames& part, const FittedView& straight) {
      return fit_lens(part, straight, config.fit);
    };
    const Fits with_lens = {bent(all, fits.all), bent(one, fits.by_one),
                            bent(other, fits.by_other)};
    const double px = crossed_px(with_lens, one, other, truncation_px);
    const double bent_px = differ(with_lens.all, fits.all);
    if (px <= (1 - config.min_gain) * result.found_px &&
        bent_px > std::max<double>(config.aligned * width_px,
                                   differ(with_lens.by_one, with_lens.by_other)))
      fits = with_lens, result.found_px = px;
  }
  result.found = fits.all.view;
  result.given_px = edge_score(all, {result.given, fits.all.outset_px}, truncation_px).mean_px;
  result.sharpness = sharpness_of(all, fits.all, truncation_px);
  result.spread_px = differ(fits.by_one, fits.by_other);
  judge(result, differ({result.given, 0}, fits.all), config);
  return result;
}

}  // namespace ovimap
