// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/frame_source.h"

#include <algorithm>
#include <charconv>

#include "ovimap/base/config.h"
#include "ovimap/frames/frame/wrapped_source.h"

namespace ovimap {

namespace {

/// The number in `text`, or `absent` when it is empty; nullopt when it is no whole number >= `min`.
std::optional<std::int64_t> parse_part(std::string_view text, std::int64_t absent,
                                       std::int64_t min) {
  if (text.empty()) return absent;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < min) return std::nullopt;
  return value;
}

class ChosenFrames : public WrappedSource {
 public:
  ChosenFrames(std::unique_ptr<FrameSource> source, std::vector<std::int64_t> positions)
      : WrappedSource(std::move(source)), positions_(std::move(positions)) {}

  std::int64_t size() const override { return static_cast<std::int64_t>(positions_.size()); }
  FrameRead read(std::int64_t position) const override { return WrappedSource::read(at(position)); }
  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    return WrappedSource::truth_ids(at(position));
  }

 private:
  std::int64_t at(std::int64_t position) const {
    return positions_[static_cast<std::size_t>(position)];
  }

  std::vector<std::int64_t> positions_;
};

}  // namespace

void list_fields(FrameSourceConfig& config, ConfigFields& fields) {
  fields.add("min_depth_m", config.min_depth_m, 0.f, 1000.f, "nearer depth is invalid, metres");
  fields.add("max_depth_m", config.max_depth_m, 0.f, 1e6f, "farther depth is invalid, metres");
  fields.add("max_time_gap_s", config.max_time_gap_s, 0.f, 10.f,
             "colour, depth and pose farther apart in time do not belong together, seconds");
  fields.add("min_confidence", config.min_confidence, 0, 2,
             "depth of a lower confidence is invalid (Record3D: 0 low, 1 medium, 2 high)");
}

FrameRange parse_frame_range(const std::string& text) {
  const FrameRange whole;
  const std::size_t first_colon = text.find(':');
  const std::size_t second_colon = text.find(':', first_colon + 1);
  if (first_colon != std::string::npos) {
    const std::string_view all = text;
    const bool stepped = second_colon != std::string::npos;
    const std::size_t last_length = stepped ? second_colon - first_colon - 1 : std::string::npos;
    const auto first = parse_part(all.substr(0, first_colon), whole.first, 0);
    const auto last = parse_part(all.substr(first_colon + 1, last_length), whole.last, 0);
    const auto step = parse_part(stepped ? all.substr(second_colon + 1) : "", whole.step, 1);
    if (first && last && step) return {*first, *last, *step};
  }
  throw Error(
      concat("frame range is '", text,
             "'; accepted is FIRST:LAST:STEP with whole numbers, each of which may be left out "
             "(0:500:5, 100:, ::10)"));
}

std::vector<std::int64_t> positions(const FrameRange& range, std::int64_t size) {
  const std::int64_t last = range.last < 0 ? size : std::min(range.last, size);
  std::vector<std::int64_t> result;
  for (std::int64_t at = std::max<std::int64_t>(range.first, 0); at < last;) {
    result.push_back(at);
    if (range.step >= last - at) break;  // a huge step must not overflow
    at += std::max<std::int64_t>(range.step, 1);
  }
  return result;
}

std::vector<FaultCount> count_faults(const std::vector<std::string>& faults) {
  std::vector<FaultCount> counts;
  for (const std::string& fault : faults) {
    const std::size_t colon = fault.find(": ");
    const std::string phrase = colon == std::string::npos ? fault : fault.substr(colon + 2);
    const auto known = std::find_if(counts.begin(), counts.end(), [&](const FaultCount& count) {
      return count.phrase == phrase;
    });
    if (known == counts.end())
      counts.push_back({phrase, fault, 1});
    else
      ++known->frames;
  }
  std::stable_sort(counts.begin(), counts.end(),
                   [](const FaultCount& a, const FaultCount& b) { return a.frames > b.frames; });
  return counts;
}

std::unique_ptr<FrameSource> choose_frames(std::unique_ptr<FrameSource> source,
                                           const FrameRange& range) {
  std::vector<std::int64_t> chosen = positions(range, source->size());
  if (chosen.empty())
    throw Error(concat("the chosen range holds none of the recording's ", source->size(),
                       " frames, which count from 0"));
  return std::make_unique<ChosenFrames>(std::move(source), std::move(chosen));
}

}  // namespace ovimap
