// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report.h"

#include <cmath>

#include "ovimap/io/exports/json_values.h"

namespace ovimap::apps {

namespace {

constexpr const char* kPaperMasks = "CropFormer (hornet_3x_03823a)";
constexpr const char* kPaperEncoder = "siglip-large-patch16-384";

/// The table as the ablations have theirs: what varies is the method.
Ablation table_of(const Reproduction& made) {
  Ablation table{"method", concat("The paper's scenes of ", made.dataset.name), {}, {}, {}, false};
  table.columns = comparison_columns();
  table.published = published_methods(made.dataset.name);
  return table;
}

nlohmann::json figures_json(const std::vector<AblationColumn>& columns,
                            const AblationResult& result, Protocol protocol) {
  nlohmann::json json = nlohmann::json::object();
  for (const AblationColumn& column : columns) {
    json[column.name] = json_or_null(column.figure(result.figures, protocol));
  }
  return json;
}

nlohmann::json published_json(const std::vector<AblationColumn>& columns, const PublishedRow& row) {
  nlohmann::json json = {{"method", row.name}, {"figures", nlohmann::json::object()}};
  for (std::size_t i = 0; i < columns.size(); ++i)
    json["figures"][columns[i].name] =
        std::isfinite(row.figures[i]) ? nlohmann::json(row.figures[i]) : nlohmann::json();
  return json;
}

}  // namespace

std::vector<std::string> differences_from_paper(const Reproduction& made, const std::string& masks,
                                                const std::string& encoder) {
  std::vector<std::string> notes;
  const std::size_t all = made.dataset.scenes.size(), found = made.found.scenes.size();
  if (found < all)
    notes.push_back(concat("scenes: ", found, " of the paper's ", all,
                           "; its figures are those of all together"));
  if (masks_by_scene(masks))
    notes.push_back(concat("masks: those in ", masks, "; the published rows compare if ",
                           kPaperMasks, " made them, on every frame"));
  else
    notes.push_back(concat("masks: ", masks, "; the paper's are ", kPaperMasks,
                           ": give them as FOLDER/SCENE/FRAME.png with --masks FOLDER"));
  if (encoder.find(kPaperEncoder) == std::string::npos)
    notes.push_back(concat("encoder: ", encoder.empty() ? "none, hence no classes" : encoder,
                           "; the paper's is ", kPaperEncoder,
                           ", which docs/models.md says how to export"));
  return notes;
}

std::string reproduction_markdown(const Reproduction& made, const std::string& heading) {
  std::string text = ablation_markdown(table_of(made), made.results, heading);
  if (!made.notes.empty()) text += "\nWhat differs from the paper:\n\n";
  for (const std::string& note : made.notes) text += concat("- ", note, "\n");
  if (!made.found.missing.empty()) text += "\nScenes that are missing:\n\n";
  for (const std::string& line : made.found.missing) text += concat("- ", line, "\n");
  return text;
}

std::string reproduction_csv(const Reproduction& made) {
  return ablation_csv(table_of(made), made.results);
}

nlohmann::json reproduction_json(const Reproduction& made) {
  const Ablation table = table_of(made);
  nlohmann::json json = {{"scenes", nlohmann::json::array()},
                         {"missing", made.found.missing},
                         {"notes", made.notes},
                         {"measured", nlohmann::json::array()},
                         {"published", nlohmann::json::array()}};
  for (const PaperScene& scene : made.found.scenes) json["scenes"].push_back(scene.name);
  for (const AblationResult& result : made.results)
    json["measured"].push_back(
        {{"method", result.variant.name},
         {"standard", figures_json(table.columns, result, Protocol::kStandard)},
         {"reference", figures_json(table.columns, result, Protocol::kReference)}});
  for (const PublishedRow& row : table.published)
    json["published"].push_back(published_json(table.columns, row));
  return json;
}

}  // namespace ovimap::apps
