// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/furniture/furniture_catalog.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <sstream>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/base/installation/installed_data.h"
#include "ovimap/synth/furniture/zip_archive.h"

namespace ovimap {
namespace {

constexpr const char* kPropertiesName = "PluginFurnitureCatalog.properties";
constexpr float kMetresPerCentimetre = 0.01f;

void append_utf8(std::string& text, unsigned code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | (code >> 6));
    text += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    text += static_cast<char>(0xe0 | (code >> 12));
    text += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
    text += static_cast<char>(0x80 | (code & 0x3f));
  }
}

/// Java's encoding of property files: ISO 8859-1 with \uXXXX escapes.
std::string property_value(const std::string& raw) {
  constexpr std::size_t kDigits = 4;
  std::string value;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\') {
      append_utf8(value, static_cast<unsigned char>(raw[i]));
    } else if (raw.compare(i + 1, 1, "u") == 0 && i + 2 + kDigits <= raw.size()) {
      unsigned code = 0;
      const char* digits = raw.data() + i + 2;
      const auto read = std::from_chars(digits, digits + kDigits, code, 16);
      if (read.ptr == digits + kDigits) append_utf8(value, code);
      i += 1 + kDigits;
    }
  }
  value.erase(value.find_last_not_of(" \t\r") + 1);
  return value;
}

using Properties = std::map<std::string, std::string>;

struct PropertiesFile {
  Properties library;
  std::map<int, Properties> models;  ///< by their number in the file
};

PropertiesFile split_properties(const std::string& text) {
  PropertiesFile file;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (line.empty() || line[0] == '#' || equals == std::string::npos) continue;
    const std::string key = line.substr(0, equals);
    const std::string value = property_value(line.substr(equals + 1));
    const std::size_t hash = key.find('#');
    if (hash == std::string::npos) {
      file.library[key] = value;
    } else {
      file.models[std::atoi(key.c_str() + hash + 1)][key.substr(0, hash)] = value;
    }
  }
  return file;
}

std::optional<float> number(const Properties& properties, const std::string& key) {
  const auto found = properties.find(key);
  if (found == properties.end()) return std::nullopt;
  std::istringstream in(found->second);
  in.imbue(std::locale::classic());
  float value = 0;
  if (!(in >> value)) return std::nullopt;
  return value;
}

std::string text_of(const Properties& properties, const std::string& key) {
  const auto found = properties.find(key);
  return found == properties.end() ? std::string() : found->second;
}

Eigen::Matrix3f rotation_of(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Eigen::Matrix3f read;
  for (int i = 0; i < 9; ++i)
    if (!(in >> read(i / 3, i % 3))) return rotation;
  return read;
}

std::optional<FurnitureEntry> entry_of(const Properties& properties, const PropertiesFile& file,
                                       const std::filesystem::path& archive) {
  FurnitureEntry entry;
  entry.model = text_of(properties, "model");
  const auto width = number(properties, "width"), depth = number(properties, "depth"),
             height = number(properties, "height");
  if (entry.model.empty() || !width || !depth || !height) return std::nullopt;
  entry.size_m = Eigen::Vector3f(*width, *depth, *height) * kMetresPerCentimetre;
  entry.id = archive.stem().string() + "/" + std::filesystem::path(entry.model).stem().string();
  entry.name = text_of(properties, "name");
  entry.category = text_of(properties, "category");
  entry.creator = text_of(properties, "creator");
  entry.license = text_of(file.library, "license");
  entry.archive = archive;
  entry.elevation_m = number(properties, "elevation").value_or(0.f) * kMetresPerCentimetre;
  entry.door_or_window = text_of(properties, "doorOrWindow") == "true";
  entry.model_rotation = rotation_of(text_of(properties, "modelRotation"));
  return entry;
}

}  // namespace

std::filesystem::path default_furniture_folder() {
  const std::filesystem::path of_debian = "/usr/share/sweethome3d/furniture";
  const auto brought = installed_data("furniture");
  return brought && !std::filesystem::is_directory(of_debian) ? *brought : of_debian;
}

std::vector<FurnitureEntry> parse_furniture_properties(const std::string& text,
                                                       const std::filesystem::path& archive) {
  const PropertiesFile file = split_properties(text);
  std::vector<FurnitureEntry> entries;
  for (const auto& [number, properties] : file.models)
    if (auto entry = entry_of(properties, file, archive)) entries.push_back(std::move(*entry));
  return entries;
}

FurnitureCatalog::FurnitureCatalog(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> archives;
  if (std::filesystem::is_directory(folder))
    for (const auto& file : std::filesystem::directory_iterator(folder))
      if (file.path().extension() == ".sh3f") archives.push_back(file.path());
  if (archives.empty())
    throw Error(concat(folder.string(),
                       ": no furniture libraries (*.sh3f) here; install the Debian package "
                       "sweethome3d-furniture"));
  for (const auto& archive : archives) {
    const auto bytes = ZipArchive(archive).read(kPropertiesName);
    if (!bytes)
      throw Error(concat(archive.string(), ": no ", kPropertiesName,
                         " inside; reinstall the Debian package sweethome3d-furniture"));
    auto entries = parse_furniture_properties(std::string(bytes->begin(), bytes->end()), archive);
    std::move(entries.begin(), entries.end(), std::back_inserter(entries_));
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
}

const FurnitureEntry& FurnitureCatalog::find(const std::string& id) const {
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), id,
                       [](const auto& entry, const auto& key) { return entry.id < key; });
  if (found != entries_.end() && found->id == id) return *found;
  std::vector<std::string> ids;
  for (const auto& entry : entries_) ids.push_back(entry.id);
  throw Error(concat("furniture model '", id, "': none of that id, did you mean '",
                     nearest_word(id, ids), "'?"));
}

}  // namespace ovimap
