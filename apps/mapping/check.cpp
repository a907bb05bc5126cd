// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "ovimap/pipeline/sequence/recording_check.h"

namespace ovimap::apps {

namespace {

const char* word(Severity severity) {
  return severity == Severity::kOk ? "ok" : severity == Severity::kWarning ? "warning" : "fault";
}

nlohmann::json json_of(const CheckReport& report) {
  nlohmann::json findings = nlohmann::json::array(), faults = nlohmann::json::array(),
                 errors = nlohmann::json::array();
  for (const Finding& finding : report.findings)
    findings.push_back({{"severity", word(finding.severity)},
                        {"name", finding.name},
                        {"message", finding.message},
                        {"remedy", finding.remedy}});
  for (const FaultCount& fault : report.faults)
    faults.push_back(
        {{"fault", fault.phrase}, {"example", fault.example}, {"frames", fault.frames}});
  for (const DepthError& error : report.depth_errors)
    errors.push_back({{"distance_m", error.distance_m},
                      {"pixel_m", error.pixel_m},
                      {"surface_m", error.surface_m}});
  return {{"kind", report.kind},
          {"frames", report.frames},
          {"checked", report.checked},
          {"usable", report.usable},
          {"median_depth_m", report.median_depth_m},
          {"valid_share", report.valid_share},
          {"overlap", report.overlap},
          {"depth_agreement", report.depth_agreement},
          {"depth_errors", errors},
          {"verdict", report.ok() ? "ok" : "fault"},
          {"findings", findings},
          {"faults", faults}};
}

void print(const CheckReport& report) {
  std::printf("%s recording, %lld frames, %lld of %lld checked are usable\n", report.kind.c_str(),
              static_cast<long long>(report.frames), static_cast<long long>(report.usable),
              static_cast<long long>(report.checked));
  for (const Finding& finding : report.findings) {
    std::printf("%-8s %-16s %s\n", word(finding.severity), finding.name.c_str(),
                finding.message.c_str());
    if (!finding.remedy.empty()) std::printf("%-25s -> %s\n", "", finding.remedy.c_str());
  }
  std::printf("verdict: %s\n", report.ok() ? "ok" : "fault");
}

}  // namespace

Action add_check(CLI::App& command) {
  auto source = std::make_shared<std::string>();
  auto frames = std::make_shared<std::string>(":");
  auto json = std::make_shared<bool>(false);
  command.add_option("SOURCE", *source, "recording")->required();
  add_frame_range(command, *frames);
  command.add_flag("--json", *json, "print one JSON object");
  return [source, frames, json] {
    const CheckReport report = check_recording(*source, {}, parse_frame_range(*frames));
    if (*json)
      print_json(json_of(report));
    else
      print(report);
    return int{report.ok() ? kDone : kAnswerIsNo};
  };
}

}  // namespace ovimap::apps
