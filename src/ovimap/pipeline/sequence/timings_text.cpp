// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/timings_text.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

std::string milliseconds(double value) {
  char text[400];  // the largest double has 309 digits before the point
  constexpr int kDecimals = 3;
  return {text,
          std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed, kDecimals).ptr};
}

/// The whole word as a number.
template <class Number>
bool read_number(const std::string& word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::string timings_text(const std::map<std::string, StageSummary>& stages) {
  std::string text;
  for (const auto& [stage, summary] : stages)
    text += concat(stage, ' ', milliseconds(summary.p50_ms), ' ', milliseconds(summary.p95_ms), ' ',
                   std::to_string(summary.count), '\n');
  return text;
}

std::map<std::string, StageSummary> parse_timings(const std::string& text) {
  std::map<std::string, StageSummary> stages;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string stage, p50, p95, count, rest;
    StageSummary summary;
    if (words >> stage >> p50 >> p95 >> count && !(words >> rest) &&
        read_number(p50, summary.p50_ms) && read_number(p95, summary.p95_ms) &&
        read_number(count, summary.count) && std::isfinite(summary.p50_ms) &&
        std::isfinite(summary.p95_ms))
      stages[stage] = summary;
  }
  return stages;
}

}  // namespace ovimap
