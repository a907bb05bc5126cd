// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "kept_settings.h"

#include <algorithm>

#include "ovimap/image/codec.h"

namespace ovimap::apps {

std::string settings_text(const MappingOptions& mapping) {
  std::string text = concat("masks ", mapping.masks, "\nencoder ", mapping.encoder, "\nframes ",
                            mapping.frames, "\n");
  for (const std::string& setting : mapping.settings) text += "set " + setting + "\n";
  return text;
}

void require_same_settings(const std::filesystem::path& folder, const std::string& settings) {
  const std::filesystem::path file = folder / "settings.txt";
  if (!std::filesystem::exists(file)) return write_text(file, settings);
  const Bytes kept = read_file(file);
  if (!std::equal(kept.begin(), kept.end(), settings.begin(), settings.end()))
    throw Error(concat(folder.string(),
                       " holds maps made with other options (settings.txt lists them); choose "
                       "another folder"));
}

}  // namespace ovimap::apps
