// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_frames.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/row_words.h"

namespace ovimap {

namespace {

using map_tables::kKeptFrames;
using map_tables::kLiveSteps;

std::vector<Label> take_labels(RowReader& rows, const LabelForest& forest) {
  const std::span<const std::uint8_t> bytes = rows.blob();
  if (bytes.size() % 4 != 0) rows.fail(concat("has a list of ", bytes.size(), " bytes"));
  std::vector<Label> labels(bytes.size() / 4, 0);
  for (std::size_t i = 0; i < bytes.size(); ++i) labels[i / 4] |= Label{bytes[i]} << 8 * (i % 4);
  for (const Label label : labels)
    if (label > forest.last_label())
      rows.fail(concat("names label ", label, ", which was never given"));
  return labels;
}

Bytes take_bytes(RowReader& rows) {
  const std::span<const std::uint8_t> bytes = rows.blob();
  return Bytes(bytes.begin(), bytes.end());
}

}  // namespace

void write_kept_frames(SQLite::Database& database, const KeptFrames& frames) {
  KeptFramesTable().update(database, frames);
}

KeptFrames read_kept_frames(SQLite::Database& database, const LabelForest& forest,
                            std::size_t fused_frames) {
  KeptFrames frames;
  RowReader rows(database, kKeptFrames);
  while (rows.next()) {
    const auto position = rows.integer<std::size_t>();
    if (position >= fused_frames) rows.fail(concat("names frame ", position));
    auto frame = std::make_shared<KeptFrame>();
    frame->depth_png = take_bytes(rows);
    frame->color_jpeg = take_bytes(rows);
    frame->segments_png = take_bytes(rows);
    frame->labels = take_labels(rows, forest);
    frames[position] = std::move(frame);
  }
  return frames;
}

void KeptFramesTable::update(SQLite::Database& database, const KeptFrames& frames) {
  RowWriter writer(database, kKeptFrames);
  if (!begun_) database.exec(concat("DELETE FROM ", kKeptFrames.name));
  begun_ = true;
  SQLite::Statement gone(database, concat("DELETE FROM ", kKeptFrames.name, " WHERE position = ?"));
  std::erase_if(rows_, [&](const auto& entry) {
    const auto found = frames.find(entry.first);
    if (found != frames.end() && found->second == entry.second.frame) return false;
    gone.bind(1, static_cast<std::int64_t>(entry.first));
    gone.exec();
    gone.reset();
    return true;
  });
  for (const auto& [position, frame] : frames) {
    if (rows_.contains(position)) continue;
    const Bytes labels = label_bytes(frame->labels);
    const std::uint64_t before = writer.sum();
    writer.insert(position, std::span(frame->depth_png), std::span(frame->color_jpeg),
                  std::span(frame->segments_png), std::span(labels));
    rows_[position] = {frame, writer.sum() - before};
  }
  std::uint64_t sum = 0;
  for (const auto& [position, row] : rows_) sum += row.hash;
  write_check(database, kKeptFrames, static_cast<std::int64_t>(rows_.size()),
              static_cast<std::int64_t>(sum));
}

void write_live_steps(SQLite::Database& database, const std::vector<LiveStep>& steps) {
  if (steps.empty()) return;
  RowWriter rows(database, kLiveSteps);
  for (std::size_t i = 0; i < steps.size(); ++i)
    rows.insert(i, static_cast<int>(steps[i].kind), steps[i].frame, steps[i].asked,
                steps[i].looked);
  rows.finish();
}

std::vector<LiveStep> read_live_steps(SQLite::Database& database) {
  std::vector<LiveStep> steps;
  if (!holds_table(database, kLiveSteps)) return steps;
  RowReader rows(database, kLiveSteps);
  while (rows.next()) {
    if (rows.integer<std::size_t>() != steps.size()) rows.fail("has a gap");
    const int kind = rows.integer<int>();
    if (kind < 0 || kind > static_cast<int>(LiveStep::Kind::kResumed))
      rows.fail(concat("has a step of kind ", kind, ", which there is not"));
    LiveStep step{static_cast<LiveStep::Kind>(kind), rows.integer<std::int64_t>()};
    step.asked = rows.integer<int>() != 0;
    step.looked = rows.integer<int>() != 0;
    steps.push_back(step);
  }
  return steps;
}

}  // namespace ovimap
