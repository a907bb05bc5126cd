// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/attribute_rating.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"

namespace ovimap {

void add_evidence(std::string& evidence, const std::string& clause) {
  evidence += (evidence.empty() ? "" : "; ") + clause;
}

std::string with_anchor(const std::string& clause, const std::string& anchor_evidence) {
  return anchor_evidence.empty() ? clause : clause + ", which is " + anchor_evidence;
}

void rate_color(const SurfaceColors& surface, const ShadedColor& wanted, AttributeRating& rating) {
  constexpr float kPlain = 0.5f, kLeast = 0.05f;
  const auto color = static_cast<std::size_t>(wanted.color);
  const float share = surface.shares[color];
  float score = std::min(share / kPlain, 1.f);
  std::string shown =
      concat(static_cast<int>(std::lround(100.f * share)), " % ", color_name(wanted.color));
  if (wanted.shade) {
    score *= shade_rating(wanted.color, surface.lightness[color], *wanted.shade);
    shown += concat(", ", std::lround(100.f * surface.lightness[color]), " % light");
  }
  rating.score *= std::max(score, kLeast);
  add_evidence(rating.evidence, shown);
}

void rate_size(const ObjectMeasures& measures, const SizeBound& size, AttributeRating& rating) {
  constexpr float kDeviation = 0.05f;  // of the logarithm
  const float side_m = size.side == Side::kHeight   ? measures.height_m
                       : size.side == Side::kLength ? measures.length_m
                                                    : measures.depth_m;
  const float excess = std::log(std::max(side_m, 1e-3f) / size.bound_m) / kDeviation;
  rating.score *= 1.f / (1.f + std::exp(size.more ? -excess : excess));
  add_evidence(rating.evidence,
               concat(std::round(100.f * side_m) / 100.f, " m ", side_name(size.side)));
}

void rate_writing(std::span<const std::u32string> wanted, std::span<const WrittenLine> lines,
                  AttributeRating& rating) {
  const WritingMatch match = match_writing(wanted, lines);
  rating.score *= match.share;
  if (match.line) add_evidence(rating.evidence, concat("reads \"", match.line->text, "\""));
}

}  // namespace ovimap
