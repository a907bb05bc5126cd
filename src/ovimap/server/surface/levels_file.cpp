// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/levels_file.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"

namespace ovimap {

namespace {

using nlohmann::json;
using Binary = json::binary_t;

constexpr int kFormat = 1;  // another when chunks are made or written in another way
constexpr const char* kEnding = ".levels";
constexpr std::size_t kMostFiles = 16;

Binary binary_of(const std::string& bytes) {
  return Binary({bytes.begin(), bytes.end()});
}

json errors_json(const BlockErrors& errors) {
  json blocks = json::array();
  Binary::container_type values;
  for (const auto& [block, error] : errors) {
    blocks.push_back(block);
    values.push_back(error);
  }
  return {{"blocks", std::move(blocks)}, {"values", Binary(std::move(values))}};
}

BlockErrors errors_of(const json& value) {
  BlockErrors errors;
  const Binary& values = value.at("values").get_binary();
  for (std::size_t i = 0; i < values.size(); ++i)
    errors[value.at("blocks").at(i).get<std::uint64_t>()] = values[i];
  return errors;
}

json chunk_json(const MadeChunk& chunk) {
  json totals = json::array(), coarse = json::array();
  for (const ChunkTotals& level : chunk.totals)
    totals.push_back({level.patches, level.vertices, level.triangles});
  for (const auto& level : chunk.coarse) coarse.push_back(binary_of(*level));
  return {{"index", {chunk.index.x(), chunk.index.y(), chunk.index.z()}},
          {"totals", std::move(totals)},
          {"coarse", std::move(coarse)},
          {"errors", errors_json(chunk.errors)}};
}

std::shared_ptr<const MadeChunk> chunk_of(const json& value) {
  auto chunk = std::make_shared<MadeChunk>();
  for (int axis = 0; axis < 3; ++axis)
    chunk->index[axis] = value.at("index").at(static_cast<std::size_t>(axis)).get<int>();
  for (std::size_t level = 0; level < chunk->totals.size(); ++level) {
    const json& totals = value.at("totals").at(level);
    chunk->totals[level] = {totals.at(0).get<std::uint32_t>(), totals.at(1).get<std::uint32_t>(),
                            totals.at(2).get<std::uint32_t>()};
  }
  for (std::size_t level = 0; level < chunk->coarse.size(); ++level) {
    const Binary& bytes = value.at("coarse").at(level).get_binary();
    chunk->coarse[level] = std::make_shared<const std::string>(bytes.begin(), bytes.end());
  }
  chunk->errors = errors_of(value.at("errors"));
  return chunk;
}

/// Those nobody wrote anew for the longest.
void remove_oldest(const std::filesystem::path& folder) {
  std::error_code fault;
  std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, fault))
    if (entry.path().extension() == kEnding)
      files.emplace_back(entry.last_write_time(fault), entry.path());
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i + kMostFiles < files.size(); ++i)
    std::filesystem::remove(files[i].second, fault);
}

}  // namespace

std::filesystem::path levels_file(const std::filesystem::path& folder, std::uint64_t content_hash) {
  if (folder.empty()) return {};
  return folder / "surfaces" / concat(content_hash, "-", kFormat, kEnding);
}

MadeChunks read_levels(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  XXH64_hash_t hash = 0;
  if (bytes.size() < sizeof hash) return {};
  std::memcpy(&hash, bytes.data(), sizeof hash);
  const std::string_view body = std::string_view(bytes).substr(sizeof hash);
  if (XXH3_64bits(body.data(), body.size()) != hash) return {};
  MadeChunks chunks;
  try {
    for (const json& chunk : json::from_cbor(body)) chunks.push_back(chunk_of(chunk));
  } catch (const json::exception&) {  // of a program that writes it in another way
    return {};
  }
  return chunks;
}

void write_levels(const std::filesystem::path& file, const MadeChunks& chunks) {
  json all = json::array();
  for (const auto& chunk : chunks) all.push_back(chunk_json(*chunk));
  constexpr std::size_t kHead = sizeof(XXH64_hash_t);
  Bytes bytes(kHead);
  json::to_cbor(all, bytes);
  const XXH64_hash_t hash = XXH3_64bits(bytes.data() + kHead, bytes.size() - kHead);
  std::memcpy(bytes.data(), &hash, kHead);
  std::error_code fault;
  std::filesystem::create_directories(file.parent_path(), fault);
  try {
    write_file(file, bytes);
  } catch (const Error&) {  // they are made again when they are needed
  }
  remove_oldest(file.parent_path());
}

}  // namespace ovimap
