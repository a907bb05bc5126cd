// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/instance_csv.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace ovimap {

namespace {

/// Spreadsheets would take a name that begins so for a formula, and obey it.
std::string no_formula(const std::string& text) {
  const bool formula =
      !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  return formula ? "'" + text : text;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + '"';
}

std::string number(float value) {
  if (!std::isfinite(value)) return {};
  char text[48];
  return {text, std::to_chars(text, text + sizeof(text), value).ptr};
}

}  // namespace

std::string instances_csv(std::span<const InstanceSummary> instances, const ObjectTitles& titles) {
  std::string csv =
      "id,name,min_x,min_y,min_z,max_x,max_y,max_z,centroid_x,centroid_y,centroid_z,points,"
      "views,confidence,label\r\n";
  for (const InstanceSummary& instance : instances) {
    csv += std::to_string(instance.id) + ',' + quoted(no_formula(titles.name_of(instance.id)));
    for (const Eigen::Vector3f& point : {Eigen::Vector3f(instance.box.min()),
                                         Eigen::Vector3f(instance.box.max()), instance.centroid})
      for (const float value : point) csv += ',' + number(value);
    csv += ',' + std::to_string(instance.points) + ',' + std::to_string(instance.views) + ',' +
           (instance.confidence ? number(*instance.confidence) : "") + ',' +
           quoted(titles.label_of(instance.id)) + "\r\n";
  }
  return csv;
}

}  // namespace ovimap
