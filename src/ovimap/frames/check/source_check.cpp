// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/source_check.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "ovimap/base/config.h"
#include "ovimap/base/median.h"
#include "ovimap/base/parallel.h"
#include "ovimap/frames/check/check_sample.h"
#include "ovimap/frames/check/pose_offset.h"

namespace ovimap {

namespace {

std::string percent(double share) {
  return concat(static_cast<int>(std::floor(100 * share + 0.5)), "%");
}

std::string rounded(double value) {
  std::ostringstream text;
  text << std::setprecision(3) << value;
  return text.str();
}

std::string metres(double value) {
  return rounded(value) + " m";
}

void add(CheckReport& report, Severity severity, const char* name, std::string message,
         std::string remedy = {}) {
  report.findings.push_back({severity, name, std::move(message), std::move(remedy)});
}

void check_frames(const CheckSample& sample, const SourceCheckConfig& config, CheckReport& report) {
  report.checked = static_cast<std::int64_t>(sample.frames.size());
  report.usable = report.checked - static_cast<std::int64_t>(sample.faults.size());
  std::vector<std::string> faults;
  for (const auto& [position, fault] : sample.faults) faults.push_back(fault);
  report.faults = count_faults(faults);
  const double faulty = report.checked > 0 ? 1 - double(report.usable) / double(report.checked) : 1;
  const Severity severity = faulty == 0                        ? Severity::kOk
                            : faulty > config.max_faulty_share ? Severity::kFault
                                                               : Severity::kWarning;
  add(report, severity, "frames",
      concat(report.usable, " of ", report.checked, " checked frames are usable (the source has ",
             report.frames, ")"),
      severity == Severity::kOk ? ""
                                : "mend what the bad_frames lines name; such frames are skipped");
  for (const FaultCount& fault : report.faults)
    add(report, severity, "bad_frames",
        concat(fault.frames, " x ", fault.phrase, " (", fault.example, ")"),
        "mend or remove these files; where all frames are concerned, correct camera.yaml");
}

void check_depth(const CheckSample& sample, const SourceCheckConfig& config, CheckReport& report) {
  std::vector<float> depths_m;
  std::size_t pixels = 0;
  for (const auto& [position, frame] : sample.frames) {
    if (!frame) continue;
    pixels += frame->depth.size();
    for (const float depth_m : frame->depth)
      if (depth_m > 0) depths_m.push_back(depth_m);
  }
  if (depths_m.empty()) return;
  report.median_depth_m = median_of(depths_m);
  report.valid_share = double(depths_m.size()) / double(pixels);
  const bool sparse = report.valid_share < config.min_valid_share;
  add(report, sparse ? Severity::kWarning : Severity::kOk, "depth_valid",
      concat(percent(report.valid_share), " of the depth pixels are valid"),
      sparse ? "check the depth images and depth_scale; a map needs more valid depth" : "");
}

bool plausible(double median_m, const SourceCheckConfig& config) {
  return median_m >= config.min_median_depth_m && median_m <= config.max_median_depth_m;
}

/// Called when the frames agree with the poses, or could not be judged by them.
void check_scale(const SourceCheckConfig& config, CheckReport& report) {
  const bool fine = plausible(report.median_depth_m, config);
  add(report, fine ? Severity::kOk : Severity::kWarning, "depth_scale",
      concat("median depth is ", metres(report.median_depth_m)),
      fine
          ? ""
          : concat("expected is ", metres(config.min_median_depth_m), " to ",
                   metres(config.max_median_depth_m), "; check depth_scale in camera.yaml (stored ",
                   "values per metre: 1000 for millimetres, 5000 for TUM, 6553.5 for Replica)"));
}

bool all_poses_equal(const CheckSample& sample) {
  const ThinFrame* first = nullptr;
  std::size_t usable = 0;
  for (const auto& [position, frame] : sample.frames) {
    if (!frame) continue;
    ++usable;
    if (first == nullptr) first = &*frame;
    if (!frame->world_from_camera.isApprox(first->world_from_camera, 1e-9)) return false;
  }
  return usable > 1;
}

struct Fit {
  Reinterpretation reading;
  Agreement agreement;
};

int changes(const Reinterpretation& reading) {
  const Reinterpretation as_read;
  return (reading.direction != as_read.direction) + (reading.axes != as_read.axes) +
         (reading.depth_factor != as_read.depth_factor) +
         (reading.focal_factor != as_read.focal_factor);
}

/// The reading that fits best; of those about as good, the one that changes least.
Fit best_fit(const CheckSample& sample, const SourceCheckConfig& config) {
  constexpr double kTie = 0.02;
  const std::vector<Reinterpretation> readings = usual_reinterpretations();
  std::vector<Fit> fits(readings.size());
  parallel_for(readings.size(), 1, [&](std::size_t i) {
    fits[i] = {readings[i],
               measure_agreement(sample.neighbours, readings[i], config.depth_tolerance)};
    if (fits[i].agreement.overlap() < config.min_overlap) fits[i].agreement = {};
  });
  double best = 0;
  for (const Fit& fit : fits) best = std::max(best, fit.agreement.share());
  std::erase_if(fits, [best](const Fit& fit) { return fit.agreement.share() < best - kTie; });
  return *std::min_element(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) {
    const int more = changes(a.reading) - changes(b.reading);
    return more != 0 ? more < 0 : a.agreement.share() > b.agreement.share();
  });
}

std::string convention_remedy(const Reinterpretation& reading) {
  std::string keys;
  if (reading.direction == PoseConvention::Direction::kCameraFromWorld)
    keys = "direction: camera_from_world";
  if (reading.axes != PoseConvention::Axes::kOpenCv)
    keys += concat(keys.empty() ? "" : ", ",
                   "axes: ", reading.axes == PoseConvention::Axes::kOpenGl ? "opengl" : "ros");
  return concat("write 'poses: {", keys,
                "}' into calibration.yaml (or take it out where it stands)");
}

std::string convention_message(const Reinterpretation& reading) {
  std::string what;
  if (reading.direction == PoseConvention::Direction::kCameraFromWorld)
    what = "inverted (camera_from_world)";
  if (reading.axes != PoseConvention::Axes::kOpenCv)
    what += concat(what.empty() ? "" : " and ", "in ",
                   reading.axes == PoseConvention::Axes::kOpenGl ? "OpenGL" : "ROS", " axes");
  return "poses are " + what;
}

void report_better_fit(const Fit& fit, const SourceCheckConfig& config, CheckReport& report) {
  const Reinterpretation& reading = fit.reading;
  const std::string gain =
      concat(": neighbouring frames then agree in ", percent(fit.agreement.share()),
             " of their depth instead of ", percent(report.depth_agreement));
  if (reading.direction != Reinterpretation{}.direction || reading.axes != Reinterpretation{}.axes)
    add(report, Severity::kFault, "pose_convention", convention_message(reading) + gain,
        convention_remedy(reading));
  if (reading.focal_factor != 1) {
    const bool longer = reading.focal_factor > 1;
    const std::string times = rounded(longer ? reading.focal_factor : 1 / reading.focal_factor);
    add(report, Severity::kFault, "intrinsics",
        concat("the depth camera's focal length is about ", times, " times too ",
               longer ? "short" : "long", gain),
        concat(longer ? "multiply" : "divide", " fx and fy of depth_camera by about ", times,
               " in calibration.yaml, or give the camera's calibrated figures"));
  }
  const double factor = reading.depth_factor;
  if (factor == 1) return check_scale(config, report);
  const bool larger = factor > 1;
  const double times = larger ? factor : 1 / factor;
  if (plausible(report.median_depth_m * factor, config) ||
      !plausible(report.median_depth_m, config))
    add(report, Severity::kFault, "depth_scale",
        concat("depth is ", times, " times too ", larger ? "small" : "large", " (median ",
               metres(report.median_depth_m), ")", gain),
        concat(larger ? "divide" : "multiply", " depth_scale by ", times, " in calibration.yaml"));
  else
    add(report, Severity::kFault, "pose_unit",
        concat("the positions of the poses are ", times, " times too ", larger ? "large" : "small",
               gain),
        "write the positions of the poses in metres");
}

/// Whether the poses fit other images clearly better than their own; if so, says so.
bool report_time_offset(const FrameSource& source, const CheckSample& sample,
                        const SourceCheckConfig& config, CheckReport& report) {
  const PoseOffset best = find_pose_offset(source, sample.neighbours, config);
  if (best.agreement < config.good_agreement ||
      best.agreement < report.depth_agreement + config.min_gain)
    return false;
  const char* when = best.frames > 0 ? "late" : "early";
  check_scale(config, report);
  add(report, Severity::kFault, "time_offset",
      concat("the poses come ", std::abs(best.frames), " frame(s) too ", when, " (",
             rounded(std::abs(best.seconds)), " s): neighbouring frames then agree in ",
             percent(best.agreement), " of their depth instead of ",
             percent(report.depth_agreement)),
      concat("give each image the pose that is stored ", std::abs(best.frames), " frame(s) ",
             best.frames > 0 ? "after" : "before",
             " its own, or record images and poses by one clock"));
  return true;
}

void check_agreement(const FrameSource& source, const CheckSample& sample,
                     const SourceCheckConfig& config, CheckReport& report) {
  const Agreement as_read = measure_agreement(sample.neighbours, {}, config.depth_tolerance);
  report.overlap = as_read.overlap();
  report.depth_agreement = as_read.share();
  const bool judged = as_read.overlap() >= config.min_overlap;
  if (!judged || as_read.share() + config.min_gain < 1) {
    const Fit best = sample.neighbours.empty() ? Fit{} : best_fit(sample, config);
    const double known = judged ? as_read.share() : 0;
    if (changes(best.reading) > 0 && best.agreement.share() >= known + config.min_gain &&
        best.agreement.share() >= config.good_agreement)
      return report_better_fit(best, config, report);
  }
  if (as_read.share() < config.good_agreement && !sample.neighbours.empty() &&
      report_time_offset(source, sample, config, report))
    return;
  check_scale(config, report);
  const std::string message =
      concat("depth of neighbouring frames agrees in ", percent(as_read.share()),
             " of the pixels both see (overlap ", percent(as_read.overlap()), ")");
  if (!judged)
    add(report, Severity::kWarning, "agreement",
        "too little overlap between frames to judge the poses",
        "check that poses and images belong together, or record with more overlap");
  else if (as_read.share() < config.good_agreement)
    add(report, as_read.share() < config.min_agreement ? Severity::kFault : Severity::kWarning,
        "agreement", message + "; none of the usual conventions fits better",
        "check the depth camera's intrinsics, the order of the poses, and that depth and poses "
        "share one clock");
  else
    add(report, Severity::kOk, "agreement", message);
}

void check_poses(const FrameSource& source, const CheckSample& sample,
                 const SourceCheckConfig& config, CheckReport& report) {
  if (!source.posed()) {
    check_scale(config, report);
    return add(report, Severity::kOk, "poses",
               "there are none, `ovimap run` finds them itself (docs/tracking.md); whether frames "
               "agree with each other can be told with poses alone");
  }
  if (report.usable < 2) return;
  if (!all_poses_equal(sample)) return check_agreement(source, sample, config, report);
  report.depth_agreement = measure_agreement(sample.neighbours, {}, config.depth_tolerance).share();
  const bool still = report.depth_agreement >= config.good_agreement;
  check_scale(config, report);
  add(report, still ? Severity::kWarning : Severity::kFault, "still_poses",
      concat("all poses are identical", still ? "" : " although the images change"),
      still ? "a camera that never moves maps what it sees from one side only"
            : "give the camera's pose for each frame");
}

void check_capture(const CheckSample& sample, CheckReport& report) {
  std::vector<Capture> captures;
  for (const auto& [position, capture] : sample.captures) captures.push_back(capture);
  for (Finding& finding : check_captures(captures)) report.findings.push_back(std::move(finding));
}

bool has_fault(const CheckReport& report, const std::string& name) {
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& finding) {
    return finding.name == name && finding.severity == Severity::kFault;
  });
}

/// Call last: what is wrong with depth alone is not told again as colour's fault.
void check_registration(const CheckSample& sample, const SourceCheckConfig& config,
                        CheckReport& report) {
  const EdgeAlignment::Verdict alignment = sample.alignment.verdict();
  if (!alignment.registered && has_fault(report, "depth_scale"))
    return add(report, Severity::kWarning, "registration",
               "colour cannot be compared with depth of a wrong scale",
               "mend the scale first and check again");
  if (!alignment.registered) {
    // Few views show few edges, and chance puts a step of colour beside the same one in all of
    // them.
    const bool few = report.usable < config.max_frames / 2;
    add(report, few ? Severity::kWarning : Severity::kFault, "registration",
        concat("colour lies about ", rounded(alignment.shift_px),
               " px beside the edges of depth, in ", alignment.misplaced, " of ", alignment.judged,
               " parts of the image"),
        few ? concat("check more of the recording: ", report.usable, " frames do not tell for sure")
        : sample.registered
            ? "let ovimap calibrate find the colour camera, or put a calibration.yaml with both "
              "cameras and color_from_depth beside the recording (docs/sources.md shows one)"
            : "let ovimap calibrate --force find the colour camera again, or record colour and "
              "depth at the same time");
    return;
  }
  const bool suspicious = report.kind == "7scenes" && sample.registered && report.usable > 0;
  add(report, suspicious ? Severity::kWarning : Severity::kOk, "registration",
      suspicious ? "7-Scenes records colour and depth with two cameras, here they are taken as one"
      : sample.registered ? "colour and depth share one camera"
                          : "colour and depth are two cameras of known offset",
      suspicious ? "let ovimap calibrate find the colour camera, or put a calibration.yaml beside "
                   "the recording (docs/sources.md shows one)"
                 : "");
}

/// Colour that lies where depth says in the middle may be bent away from it towards its borders.
void check_lens(const FrameSource& source, const CheckSample& sample,
                const SourceCheckConfig& config, CheckReport& report) {
  if (source.rectified() || has_fault(report, "registration") || has_fault(report, "depth_scale"))
    return;
  std::vector<std::int64_t> usable;
  for (const auto& [position, frame] : sample.frames)
    if (frame) usable.push_back(position);
  const ColorCalibration found = calibrate_color(source, usable, config.lens);
  if (found.verdict != ColorCalibration::Verdict::kFound || found.found.lens == Lens{}) return;
  add(report, Severity::kWarning, "lens",
      concat("colour is bent by a lens that the recording says nothing of (k1 ",
             rounded(found.found.lens.coefficients[0]), ", k2 ",
             rounded(found.found.lens.coefficients[1]), "): edges meet to ",
             rounded(found.found_px), " px instead of ", rounded(found.given_px), " px"),
      "give the camera's distortion in calibration.yaml, or let ovimap calibrate find it");
}

}  // namespace

ColorCalibrationConfig SourceCheckConfig::quick_calibration() {
  ColorCalibrationConfig config;
  config.fit.starts = 1;
  config.edges.max_points = 1000;
  return config;
}

void list_fields(SourceCheckConfig& config, ConfigFields& fields) {
  fields.add("max_frames", config.max_frames, 2, 100000, "frames read for the check");
  fields.add("max_faulty_share", config.max_faulty_share, 0.f, 1.f,
             "more unusable frames than this are a fault");
  fields.add("min_valid_share", config.min_valid_share, 0.f, 1.f,
             "fewer valid depth pixels than this are a warning");
  fields.add("min_median_depth_m", config.min_median_depth_m, 0.f, 1000.f,
             "a nearer median depth is suspicious, metres");
  fields.add("max_median_depth_m", config.max_median_depth_m, 0.f, 1000.f,
             "a farther median depth is suspicious, metres");
  fields.add("pair_gap", config.pair_gap, 1, 10000,
             "frames between two neighbours that are compared");
  fields.add("max_pair_rotation_deg", config.max_pair_rotation_deg, 0.f, 180.f,
             "largest rotation between two neighbours, degrees");
  fields.add("compared_width_px", config.compared_width_px, 8, 4096,
             "width to which depth is thinned before comparing, pixels");
  fields.add("depth_tolerance", config.depth_tolerance, 0.f, 1.f,
             "depths agree within this share of the distance");
  fields.add("min_overlap", config.min_overlap, 0.f, 1.f,
             "less overlap of neighbours is not judged");
  fields.add("min_agreement", config.min_agreement, 0.f, 1.f, "less depth agreement is a fault");
  fields.add("good_agreement", config.good_agreement, 0.f, 1.f,
             "less depth agreement is a warning");
  fields.add("min_gain", config.min_gain, 0.f, 1.f,
             "by how much another reading of poses or depth must agree better to be named");
  fields.group("alignment", [&](ConfigFields& inner) { list_fields(config.alignment, inner); });
  fields.group("lens", [&](ConfigFields& inner) { list_fields(config.lens, inner); });
}

bool CheckReport::ok() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.severity == Severity::kFault; });
}

CheckReport check_source(const FrameSource& source, const SourceCheckConfig& config) {
  CheckReport report;
  report.kind = source.kind();
  report.frames = source.size();
  const CheckSample sample = draw_sample(source, config);
  check_frames(sample, config, report);
  check_depth(sample, config, report);
  if (report.usable == 0) return report;
  check_poses(source, sample, config, report);
  check_registration(sample, config, report);
  check_lens(source, sample, config, report);
  check_capture(sample, report);
  return report;
}

}  // namespace ovimap
