// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/teaching.h"

#include <cstdlib>

#include "ovimap/base/error.h"
#include "ovimap/io/corrections/taught_file.h"

namespace ovimap {

namespace {

/// One name for a file, by whatever way it is reached; also while it is not written yet.
std::string name_of(const std::filesystem::path& map) {
  return std::filesystem::weakly_canonical(std::filesystem::absolute(map)).string();
}

}  // namespace

std::filesystem::path default_taught_file() {
  const auto folder_in = [](const char* variable) -> std::filesystem::path {
    const char* value = std::getenv(variable);
    return value == nullptr ? "" : value;
  };
  if (const auto data = folder_in("XDG_DATA_HOME"); data.is_absolute())
    return data / "ovimap" / "taught.json";
  if (const auto home = folder_in("HOME"); home.is_absolute())
    return home / ".local" / "share" / "ovimap" / "taught.json";
  throw Error("neither HOME nor XDG_DATA_HOME is set; name the file: --teach FILE");
}

std::size_t teach(const std::filesystem::path& file, const std::filesystem::path& map,
                  const MapSearch& search) {
  const std::string of_map = name_of(map);
  std::vector<TaughtThing> things;
  for (std::size_t i = 0; i < search.index.size(); ++i) {
    const SearchObject& object = search.index.object(i);
    if (object.name.empty() || !search.index.has_embedding(i)) continue;
    things.push_back({object.name, of_map, object.id, search.info.encoder,
                      search.index.embeddings().row(static_cast<Eigen::Index>(i)).transpose()});
  }
  replace_taught_things(file, of_map, things);
  return things.size();
}

TaughtThings taught_elsewhere(const std::filesystem::path& file, const std::filesystem::path& map,
                              const EncoderIdentity& encoder) {
  if (file.empty()) return {};
  const std::string of_map = name_of(map);
  TaughtThings taught;
  std::vector<TaughtThing> things = read_taught_file(file);
  std::erase_if(things, [&](const TaughtThing& thing) {
    return thing.map == of_map || !(thing.encoder == encoder);
  });
  taught.looks.resize(static_cast<Eigen::Index>(things.size()), encoder.dimension);
  for (std::size_t i = 0; i < things.size(); ++i) {
    taught.names.push_back(things[i].name);
    taught.looks.row(static_cast<Eigen::Index>(i)) = things[i].look.transpose();
  }
  return taught;
}

}  // namespace ovimap
