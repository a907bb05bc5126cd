// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "synth_catalog.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>

#include "apps/command/command.h"
#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"
#include "ovimap/synth/furniture/furniture_model.h"
#include "ovimap/synth/furniture/furniture_palette.h"

namespace ovimap::apps {

namespace {

constexpr int kJpegQuality = 88;
constexpr std::size_t kBatch = 16;  // models drawn between two reports of progress

std::string quoted(const std::string& text) {
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

/// Catalogue id -> the class that rooms know it by; few models are in rooms.
std::map<std::string, std::string> classes_of_models() {
  std::map<std::string, std::string> classes;
  for (const std::string& name : room_classes())
    for (const std::string& model : models_of_class(name)) classes[model] = name;
  return classes;
}

std::string file_stem(std::size_t model, std::size_t view) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%04zu_%02zu", model, view);
  return text.data();
}

/// Draws one model, writes its pictures, returns its lines of crops.csv: none where the library's
/// file is unreadable or all of glass.
std::string draw_model(const PortraitStudio& studio, const std::filesystem::path& out,
                       const FurnitureEntry& entry, std::size_t number,
                       const std::string& room_class) {
  std::vector<Portrait> portraits;
  try {
    portraits = studio.draw(entry, load_furniture_model(entry), number);
  } catch (const Error&) {
    return {};
  }
  std::string lines;
  for (std::size_t i = 0; i < portraits.size(); ++i) {
    const std::string picture = "crops/" + file_stem(number, i) + ".jpg";
    const std::string mask = "crops/" + file_stem(number, i) + ".mask.png";
    write_file(out / picture, encode_jpeg(portraits[i].color, kJpegQuality));
    write_file(out / mask, encode_png(portraits[i].visible));
    lines += concat(picture, ",", mask, ",", quoted(entry.id), ",", quoted(entry.name), ",",
                    quoted(entry.category), ",", quoted(room_class), ",", quoted(entry.creator),
                    ",", quoted(entry.license), "\n");
  }
  return lines;
}

std::string notice(const std::vector<FurnitureEntry>& entries) {
  std::set<std::string> lines;
  for (const FurnitureEntry& entry : entries)
    lines.insert(concat("- \"", entry.name, "\" (", entry.id, ") by ", entry.creator, ", ",
                        entry.license, "\n"));
  std::string text =
      "# Notice\n\nThe pictures in crops/ were drawn by ovimap. They show these models of the "
      "Sweet "
      "Home 3D furniture libraries (https://www.sweethome3d.com), turned, lit and placed:\n\n";
  for (const std::string& line : lines) text += line;
  return text;
}

}  // namespace

int synth_catalog(const CatalogRun& run) {
  const FurnitureCatalog catalog(run.furniture);
  const auto& entries = catalog.entries();
  const auto classes = classes_of_models();
  PortraitConfig config;
  config.views = run.views;
  const PortraitStudio studio(run.seed, config);
  std::filesystem::create_directories(run.out / "crops");
  std::vector<std::string> lines(entries.size());
  {
    Progress progress("drawing");
    for (std::size_t begin = 0; begin < entries.size(); begin += kBatch) {
      progress.show(begin, entries.size());
      parallel_for(std::min(kBatch, entries.size() - begin), 1, [&](std::size_t i) {
        const FurnitureEntry& entry = entries[begin + i];
        const auto found = classes.find(entry.id);
        lines[begin + i] = draw_model(studio, run.out, entry, begin + i,
                                      found == classes.end() ? "" : found->second);
      });
    }
  }
  std::string table = "file,mask,model,name,category,room_class,creator,license\n";
  for (const std::string& line : lines) table += line;
  write_text(run.out / "crops.csv", table);
  write_text(run.out / "NOTICE.md", notice(entries));
  const auto pictures = std::count(table.begin(), table.end(), '\n') - 1;
  const auto drawn = std::count_if(lines.begin(), lines.end(),
                                   [](const std::string& line) { return !line.empty(); });
  if (run.json)
    print_json({{"out", run.out.string()},
                {"models", drawn},
                {"left_out", std::ssize(entries) - drawn},
                {"pictures", pictures}});
  else
    std::printf("%s: %td pictures of %td models, %td left out (unreadable or too large)\n",
                run.out.string().c_str(), pictures, drawn, std::ssize(entries) - drawn);
  return kDone;
}

}  // namespace ovimap::apps
