// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/masks/id_mask_sources.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/image/codec.h"
#include "ovimap/inference/masks/entity_ids.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

/// The number that the text ends in; nullopt when it ends otherwise.
std::optional<std::int64_t> number_at_end(const std::string& text) {
  const std::size_t last_other = text.find_last_not_of("0123456789");
  const std::size_t begin = last_other == std::string::npos ? 0 : last_other + 1;
  std::int64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [read_end, error] = std::from_chars(text.data() + begin, end, number);
  if (begin == text.size() || error != std::errc() || read_end != end) return std::nullopt;
  return number;
}

/// Beside a mask: how sure its maker is of each entity.
fs::path scores_file(const fs::path& mask) {
  return fs::path(mask).replace_extension(".json");
}

/// {"scores": [of id 1, of id 2, ...]}, each from 0 to 1, of `count` ids; 1 where there is no such
/// file.
std::vector<float> read_scores(const fs::path& mask, std::size_t count) {
  const fs::path file = scores_file(mask);
  if (!fs::exists(file)) return std::vector<float>(count, 1.f);
  const auto refuse = [&](const std::string& what) {
    throw Error(concat("scores ", file.string(), " ", what, "; write {\"scores\": [0.9, 0.75]}, ",
                       "for id 1, id 2 and so on from 0 to 1"));
  };
  const nlohmann::json document = read_json(file, kLargeDocument);
  const auto list = document.find("scores");  // end() of what is no object
  if (list == document.end() || !list->is_array()) refuse("hold no list of scores");
  std::vector<float> scores;
  for (const nlohmann::json& score : *list) {
    const double value = score.is_number() ? score.get<double>() : -1;
    if (value < 0 || value > 1) refuse("hold what is no score");
    scores.push_back(static_cast<float>(value));
  }
  if (scores.size() < count)
    refuse(concat("hold ", scores.size(), " scores, but ", mask.filename().string(), " has id ",
                  count));
  scores.resize(count);
  return scores;
}

/// The entities of a mask that is kept as a file.
Entities read_entities(const fs::path& mask, const IdImage& ids) {
  return keep_visible({ids, read_scores(mask, last_id(ids))}, 0);
}

void write_entities(const fs::path& mask, const Entities& entities) {
  const std::string scores = nlohmann::json{{"scores", entities.scores}}.dump() + "\n";
  write_file(scores_file(mask), Bytes(scores.begin(), scores.end()));
  write_file(mask, encode_png(entities.ids));  // last: whoever sees it may read its scores
}

/// Reads something of one frame; what is wrong with it is that frame's fault alone.
template <class Read>
auto of_this_frame(const Read& read) {
  try {
    return read();
  } catch (const Error& fault) {
    throw FrameError(fault.what());
  }
}

}  // namespace

GtMaskSource::GtMaskSource(const FrameSource& frames) : frames_(frames) {
  for (std::int64_t position = 0; position < frames.size(); ++position)
    if (frames.truth_ids(position)) return;
  throw Error(concat("masks 'gt' need true instance images, and this ", frames.kind(),
                     " source has none; choose none, sam, a folder of masks or a model"));
}

std::optional<Entities> GtMaskSource::entities(const Frame& frame, std::span<const MaskPrompt>) {
  if (frame.index < 0 || frame.index >= frames_.size())
    throw FrameError(concat("masks 'gt' know frames 0 to ", frames_.size() - 1,
                            " of their recording, and this frame's index is ", frame.index));
  const std::optional<IdImage> ids = of_this_frame([&] { return frames_.truth_ids(frame.index); });
  if (!ids) return std::nullopt;
  return entities_of_ids(*ids);
}

DirMaskSource::DirMaskSource(const fs::path& folder, const FrameSource* frames) : folder_(folder) {
  if (!fs::is_directory(folder))
    throw Error(concat("mask folder ", folder.string(), " does not exist; name a folder of PNGs"));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    by_stem_.emplace(stem, file);
    if (const auto number = number_at_end(stem)) by_index_.emplace(*number, file);
  }
  if (files.empty())
    throw Error(concat("mask folder ", folder.string(), " holds no .png file; write one a frame"));
  if (frames) require_match(*frames);
}

void DirMaskSource::require_match(const FrameSource& frames) const {
  std::string first_name;
  for (std::int64_t i = 0; i < frames.size(); ++i) {
    if (file_of("", i)) return;
    const FrameRead read = frames.read(i);
    if (!read.frame) continue;
    if (file_of(read.frame->name, i)) return;
    if (first_name.empty()) first_name = read.frame->name;
  }
  throw Error(concat("mask folder ", folder_.string(), " has no file for any of the ",
                     frames.size(), " frames; name the first frame's mask ", first_name,
                     ".png or 0.png"));
}

const fs::path* DirMaskSource::file_of(const std::string& name, std::int64_t index) const {
  for (const std::string& stem : {name, name.substr(0, name.rfind('.'))})
    if (const auto found = by_stem_.find(stem); found != by_stem_.end()) return &found->second;
  const auto found = by_index_.find(index);
  return found == by_index_.end() ? nullptr : &found->second;
}

std::optional<Entities> DirMaskSource::entities(const Frame& frame, std::span<const MaskPrompt>) {
  const fs::path* file = file_of(frame.name, frame.index);
  if (!file) return std::nullopt;
  const GrayPng mask = of_this_frame([&] { return read_gray(*file); });
  if (!mask.values.same_size(frame.color))
    throw FrameError(concat("mask ", file->string(), " is ", mask.values.width(), "x",
                            mask.values.height(), ", but the colour image of frame ", frame.index,
                            " is ", frame.color.width(), "x", frame.color.height(),
                            "; write masks at the colour image's size"));
  return of_this_frame([&] { return read_entities(*file, mask.values); });
}

KeptMaskSource::KeptMaskSource(fs::path folder, std::unique_ptr<MaskSource> source)
    : folder_(std::move(folder)), source_(std::move(source)) {
  std::error_code fault;
  fs::create_directories(folder_, fault);
  if (fault)
    throw Error(concat("mask folder ", folder_.string(), " cannot be made: ", fault.message(),
                       "; choose a place that you can write to"));
}

std::optional<Entities> KeptMaskSource::entities(const Frame& frame,
                                                 std::span<const MaskPrompt> prompts) {
  const fs::path file = folder_ / concat(frame.index, ".png");
  if (fs::exists(file)) return read_entities(file, read_gray(file).values);
  std::optional<Entities> entities = source_->entities(frame, prompts);
  if (entities) write_entities(file, *entities);
  return entities;
}

}  // namespace ovimap
