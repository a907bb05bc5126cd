// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "arrays.h"
#include "bindings.h"
#include "ovimap/frames/calibration/color_calibration.h"
#include "settings.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

/// A calibration with the text that stands for it.
struct Calibrated {
  ColorCalibration result;
  std::string yaml;
};

const char* verdict_name(const ColorCalibration& result) {
  switch (result.verdict) {
    case ColorCalibration::Verdict::kFound:
      return "found";
    case ColorCalibration::Verdict::kAligned:
      return "aligned";
    case ColorCalibration::Verdict::kRefused:
      return "refused";
  }
  return "refused";
}

Calibrated calibrate(const std::filesystem::path& path, const std::string& frames,
                     const ColorCalibrationConfig& config) {
  const auto source = open_frame_source(path);
  Calibrated calibrated;
  calibrated.result =
      calibrate_color(*source, positions(parse_frame_range(frames), source->size()), config);
  calibrated.yaml = calibrated_text(calibration_file(path), calibrated.result);
  return calibrated;
}

}  // namespace

void bind_calibrate(nb::module_& module) {
  nb::class_<Calibrated>(module, "ColorCalibration",
                         "Where the colour camera is, and how far that can be trusted.")
      .def_prop_ro(
          "verdict", [](const Calibrated& self) { return verdict_name(self.result); },
          "\"found\", \"aligned\" (what is given is right) or \"refused\" (nothing can be told)")
      .def_prop_ro(
          "message", [](const Calibrated& self) { return self.result.message; }, "one line")
      .def_prop_ro(
          "frames", [](const Calibrated& self) { return self.result.positions.size(); }, "used")
      .def_prop_ro(
          "edges", [](const Calibrated& self) { return self.result.edges; },
          "points on edges of depth")
      .def_prop_ro(
          "given_px", [](const Calibrated& self) { return self.result.given_px; },
          "mean distance of depth's edges from colour's, far ones cut off, as given")
      .def_prop_ro(
          "found_px", [](const Calibrated& self) { return self.result.found_px; },
          "the same as found, each half of the frames judged by what the other half gave")
      .def_prop_ro(
          "spread_px", [](const Calibrated& self) { return self.result.spread_px; },
          "how far the two halves of the frames put colour apart")
      .def_prop_ro(
          "sharpness", [](const Calibrated& self) { return self.result.sharpness; },
          "by what share edges meet worse when colour moves by 1% of its width")
      .def_prop_ro(
          "radial",
          [](const Calibrated& self) {
            const auto& k = self.result.found.lens.coefficients;
            return std::pair(k[0], k[1]);
          },
          "k1 and k2 of colour's lens; 0 where none was found, or one is given")
      .def_prop_ro("color_camera", [](const Calibrated& self) { return self.result.found.camera; })
      .def_prop_ro(
          "color_from_depth",
          [](const Calibrated& self) { return to_matrix(self.result.found.color_from_depth); },
          nb::rv_policy::automatic, "[4, 4]: x_in_color = color_from_depth @ x_in_depth")
      .def_ro("yaml", &Calibrated::yaml, "the calibration.yaml to put beside the recording");
  module.def(
      "calibrate",
      [](const nb::object& path, const std::string& frames, const Settings& settings) {
        const std::filesystem::path folder = to_path(path, "path");
        const auto config = configured<ColorCalibrationConfig>(settings);
        const WithoutGil release;
        return calibrate(folder, frames, config);
      },
      nb::arg("path"), nb::kw_only(), nb::arg("frames") = ":", nb::arg("settings") = nb::none(),
      nb::sig("def calibrate(path: str | os.PathLike[str], *, frames: str = ':', settings: "
              "dict[str, typing.Any] | None = None) -> ColorCalibration"),
      "Finds the colour camera of a recording and its offset from the depth camera, from edges of "
      "both. Writes nothing. Raises Error when the recording cannot be opened.");
}

}  // namespace ovimap::python
