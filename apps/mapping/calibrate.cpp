// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate.h"

#include <cstdio>

#include "ovimap/base/parallel.h"
#include "ovimap/frames/calibration/color_calibration.h"
#include "ovimap/image/codec.h"

namespace ovimap::apps {

namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  fs::path source, out, picture;
  std::string frames = ":";
  bool force = false, json = false;
  int threads = 0;
};

const char* word(ColorCalibration::Verdict verdict) {
  using Verdict = ColorCalibration::Verdict;
  return verdict == Verdict::kFound     ? "found"
         : verdict == Verdict::kAligned ? "aligned"
                                        : "refused";
}

/// Differences in pixels by distance: what moves is told apart from what turns.
constexpr float kDistances_m[] = {1, 2, 3, 4};

nlohmann::ordered_json json_of(const ColorCalibration& result, const fs::path& written) {
  const PinholeCamera& camera = result.found.camera;
  const Lens& lens = result.found.lens;
  const Eigen::AngleAxisd turn(result.found.color_from_depth.linear());
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  const Eigen::Vector3d& offset = result.found.color_from_depth.translation();
  nlohmann::ordered_json moved = nlohmann::ordered_json::array();
  for (const float depth_m : kDistances_m)
    moved.push_back(
        {{"depth_m", depth_m},
         {"px", view_difference_px(result.depth_camera, result.given, result.found, depth_m)}});
  return {{"verdict", word(result.verdict)},
          {"message", result.message},
          {"frames", result.positions.size()},
          {"edges", result.edges},
          {"given_px", result.given_px},
          {"found_px", result.found_px},
          {"spread_px", result.spread_px},
          {"sharpness", result.sharpness},
          {"moved", moved},
          {"color_camera",
           {{"width", camera.width},
            {"height", camera.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"radial", {lens.coefficients[0], lens.coefficients[1]}}}},
          {"color_from_depth",
           {{"rotation_vector", {rotation.x(), rotation.y(), rotation.z()}},
            {"translation", {offset.x(), offset.y(), offset.z()}}}},
          {"written",
           written.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(written.string())}};
}

void print(const ColorCalibration& result, const fs::path& written) {
  std::printf("%s\n", result.message.c_str());
  if (result.verdict == ColorCalibration::Verdict::kRefused) return;
  std::printf("from         %zu frames, %zu points on edges of depth\n", result.positions.size(),
              result.edges);
  std::printf(
      "confidence   halves of the frames agree to %.2f px; moved by 1%% of the width, edges "
      "meet %.0f%% worse\n",
      result.spread_px, 100 * result.sharpness);
  std::printf("moves colour");
  for (const float depth_m : kDistances_m)
    std::printf(" %.1f px at %.0f m%s",
                view_difference_px(result.depth_camera, result.given, result.found, depth_m),
                double{depth_m}, depth_m == kDistances_m[3] ? "\n" : ",");
  if (!written.empty()) std::printf("written      %s\n", written.c_str());
}

int calibrate(const CalibrateOptions& options) {
  const ThreadLimit limit(options.threads);
  const auto source = open_frame_source(options.source);
  const fs::path present = calibration_file(options.source);
  const fs::path out = options.out.empty() ? present : options.out;
  if (fs::exists(out) && !options.force)
    throw Error(concat(out.string(), " exists; give --force to replace it, or -o another file"));
  check_file_target(out);
  if (!options.picture.empty()) check_file_target(options.picture);
  ColorCalibration result;
  {
    Progress progress("calibrating");
    result =
        calibrate_color(*source, positions(parse_frame_range(options.frames), source->size()), {},
                        [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  }
  using Verdict = ColorCalibration::Verdict;
  const bool writes =
      result.verdict == Verdict::kFound || (result.verdict == Verdict::kAligned && options.force);
  if (writes) {
    const std::string text = calibrated_text(present, result);
    write_text(out, text);
  }
  if (!options.picture.empty() && !result.positions.empty())
    write_file(options.picture, encode_png(calibration_picture(*source, result)));
  const fs::path written = writes ? out : fs::path();
  if (options.json)
    print_json(json_of(result, written));
  else
    print(result, written);
  return result.verdict == Verdict::kRefused ? kAnswerIsNo : kDone;
}

}  // namespace

Action add_calibrate(CLI::App& command) {
  auto options = std::make_shared<CalibrateOptions>();
  command.add_option("SOURCE", options->source, "recording")->required();
  command.add_option("-o,--output", options->out, "file to write; default SOURCE/calibration.yaml");
  add_frame_range(command, options->frames);
  command.add_option("--picture", options->picture,
                     "PNG: edges of depth over colour, as given (left) and as found (right)");
  command.add_flag("--force", options->force, "replace FILE, also where colour is right already");
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return calibrate(*options); };
}

}  // namespace ovimap::apps
