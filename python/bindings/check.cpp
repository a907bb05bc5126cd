// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "ovimap/pipeline/sequence/recording_check.h"
#include "settings.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

const char* severity_name(const Finding& finding) {
  switch (finding.severity) {
    case Severity::kOk:
      return "ok";
    case Severity::kWarning:
      return "warning";
    case Severity::kFault:
      return "fault";
  }
  return "fault";
}

}  // namespace

void bind_check(nb::module_& module) {
  nb::class_<Finding>(module, "Finding", "One result of a check.")
      .def_prop_ro("severity", &severity_name, "\"ok\", \"warning\" or \"fault\"")
      .def_ro("name", &Finding::name,
              "stable, for programs: \"depth_scale\", \"pose_convention\" ...")
      .def_ro("message", &Finding::message, "one line, with the figures")
      .def_ro("remedy", &Finding::remedy, "what to do; empty when ok")
      .def("__repr__", [](const Finding& finding) {
        return concat("Finding(", severity_name(finding), " ", finding.name, ": ", finding.message,
                      ")");
      });
  nb::class_<CheckReport>(module, "CheckReport", "What is wrong with a recording, if anything.")
      .def_prop_ro("ok", &CheckReport::ok, "no finding is a fault")
      .def_ro("kind", &CheckReport::kind, "the layout")
      .def_ro("frames", &CheckReport::frames, "in the recording")
      .def_ro("checked", &CheckReport::checked, "read for this check")
      .def_ro("usable", &CheckReport::usable, "of those")
      .def_ro("median_depth_m", &CheckReport::median_depth_m)
      .def_ro("valid_share", &CheckReport::valid_share, "of the depth pixels in usable frames")
      .def_ro("overlap", &CheckReport::overlap, "share of depth that neighbouring frames both see")
      .def_ro("depth_agreement", &CheckReport::depth_agreement, "share of that which agrees")
      .def_prop_ro(
          "depth_errors",
          [](const CheckReport& report) {
            std::vector<std::tuple<float, float, float>> errors;
            for (const DepthError& error : report.depth_errors)
              errors.emplace_back(error.distance_m, error.pixel_m, error.surface_m);
            return errors;
          },
          "how much depth errs, standard deviations: (distance, of a pixel, of the surface through "
          "a window of pixels), metres; nearest first")
      .def_ro("findings", &CheckReport::findings)
      .def("__repr__", [](const CheckReport& report) {
        std::string faults;
        for (const Finding& finding : report.findings)
          if (finding.severity == Severity::kFault)
            faults += concat(faults.empty() ? ", faults: " : ", ", finding.name);
        return concat("CheckReport(", report.kind, ", ", report.usable, " of ", report.checked,
                      " frames usable", faults.empty() ? ", ok" : faults, ")");
      });
  module.def(
      "check",
      [](const nb::object& path, const std::string& frames, const Settings& settings) {
        const std::filesystem::path folder = to_path(path, "path");
        const auto config = configured<SourceCheckConfig>(settings);
        const WithoutGil release;
        return check_recording(folder, config, parse_frame_range(frames));
      },
      nb::arg("path"), nb::kw_only(), nb::arg("frames") = ":", nb::arg("settings") = nb::none(),
      nb::sig("def check(path: str | os.PathLike[str], *, frames: str = ':', settings: dict[str, "
              "typing.Any] | None = None) -> CheckReport"),
      "Reads some frames of a recording and says what is wrong with it: depth in another unit, "
      "poses "
      "inverted or in other axes, unusable frames. frames: \"FIRST:LAST:STEP\", each part "
      "optional. "
      "Raises Error when it cannot be opened.");
}

}  // namespace ovimap::python
