// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth_scannet.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/semantics/classes/label_set.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLabelledMesh = "_vh_clean_2.labels.ply";
constexpr std::string_view kPlainMesh = "_vh_clean_2.ply";
constexpr const char* kTable = "scannetv2-labels.combined.tsv";
constexpr int kFoldersAbove = 3;  ///< where the table is looked for: scene, scans, ScanNet

struct ClassOfName {
  std::int32_t id = 0;  ///< 0 = not a class of this numbering
  std::string name;
};

/// What an object is.
struct Annotation {
  std::int32_t instance = 0;
  std::string name;
};

fs::path mesh_in(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().ends_with(ending)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  if (found.size() > 1)
    throw Error(concat("'", folder.string(), "' holds the truth of ", found.size(),
                       " scenes; give the folder of one scene"));
  return found.empty() ? fs::path() : found.front();
}

std::string scene_of(const fs::path& mesh) {
  const std::string name = mesh.filename().string();
  return name.substr(0, name.find("_vh_clean_2"));
}

fs::path scene_file(const fs::path& mesh, const std::string& ending) {
  const fs::path file = mesh.parent_path() / (scene_of(mesh) + ending);
  if (!fs::exists(file))
    throw Error(concat("the truth of '", mesh.string(), "' lacks the file '", file.string(),
                       "'; it should lie beside the mesh (ScanNet layout)"));
  return file;
}

fs::path find_table(const fs::path& mesh) {
  fs::path folder = fs::absolute(mesh).parent_path();
  for (int i = 0; i <= kFoldersAbove; ++i, folder = folder.parent_path())
    if (fs::exists(folder / kTable)) return folder / kTable;
  throw Error(concat("the truth of '", mesh.string(), "' lacks ", kTable,
                     ", which numbers its class names; put it beside the mesh or up to ",
                     kFoldersAbove, " folders above"));
}

template <class Read>
auto read_form(const fs::path& file, const char* expected, Read&& read) {
  const nlohmann::json document = read_json(file, kLargeDocument);
  try {
    return read(document);
  } catch (const nlohmann::json::exception&) {
    throw Error(concat("'", file.string(), "' is not of the form ", expected));
  }
}

std::vector<std::int64_t> read_segments(const fs::path& file) {
  return read_form(file, R"({"segIndices": [1, 1, 5]})", [](const nlohmann::json& document) {
    return document.at("segIndices").get<std::vector<std::int64_t>>();
  });
}

using Annotations = std::unordered_map<std::int64_t, Annotation>;  ///< by segment

Annotations read_annotations(const fs::path& file) {
  return read_form(file, R"({"segGroups": [{"objectId": 0, "label": "sofa", "segments": [1, 5]}]})",
                   [](const nlohmann::json& document) {
                     Annotations annotations;
                     for (const auto& group : document.at("segGroups")) {
                       const Annotation annotation{group.at("objectId").get<std::int32_t>() + 1,
                                                   group.at("label").get<std::string>()};
                       for (const auto& segment : group.at("segments"))
                         annotations[segment.get<std::int64_t>()] = annotation;
                     }
                     return annotations;
                   });
}

std::vector<std::string_view> split(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t tab = line.find('\t');
    cells.push_back(line.substr(0, tab));
    if (tab == std::string_view::npos) return cells;
    line.remove_prefix(tab + 1);
  }
}

/// The table of ScanNet's names, by raw name.
class NameTable {
 public:
  explicit NameTable(const fs::path& file) : file_(file) {
    const Bytes bytes = read_file(file);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    int number = 0;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (++number == 1)
        read_head(split(line));
      else if (!line.empty())
        read_row(split(line), number);
    }
    if (number == 0) read_head({});
  }

  ClassOfName find(const std::string& name, ScanNetClasses classes) const {
    const auto row = rows_.find(name);
    if (row == rows_.end())
      throw Error(concat("'", file_.string(), "' has no row for the name '", name,
                         "' of the scene; take the table of the same release"));
    if (classes == ScanNetClasses::kNyu40) return {row->second.nyu40, row->second.nyu40_name};
    return {row->second.raw, name};
  }

 private:
  struct Row {
    std::int32_t raw = 0, nyu40 = 0;
    std::string nyu40_name;
  };

  void read_head(const std::vector<std::string_view>& cells) {
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const auto found = std::find(cells.begin(), cells.end(), kColumns[i]);
      if (found == cells.end())
        throw Error(
            concat("'", file_.string(), "' has no column '", kColumns[i], "'; it is not ", kTable));
      column_[i] = static_cast<std::size_t>(found - cells.begin());
    }
  }

  void read_row(const std::vector<std::string_view>& cells, int number) {
    if (cells.size() <= *std::max_element(column_.begin(), column_.end()))
      throw Error(concat("'", file_.string(), "' line ", number, " has ", cells.size(),
                         " columns, fewer than its head"));
    rows_[std::string(cells[column_[1]])] = {whole_number(cells[column_[0]], number),
                                             whole_number(cells[column_[2]], number),
                                             std::string(cells[column_[3]])};
  }

  std::int32_t whole_number(std::string_view cell, int line) const {
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size())
      throw Error(
          concat("'", file_.string(), "' line ", line, ": '", cell, "' is no whole number"));
    return value;
  }

  static constexpr std::array<std::string_view, 4> kColumns = {"id", "raw_category", "nyu40id",
                                                               "nyu40class"};
  fs::path file_;
  std::array<std::size_t, 4> column_{};
  std::unordered_map<std::string, Row> rows_;
};

/// Classes by name, each looked up once. Names are those of the built-in sets where they have one.
class ClassFinder {
 public:
  ClassFinder(const fs::path& table, ScanNetClasses classes) : table_(table), classes_(classes) {
    if (classes == ScanNetClasses::kRaw) return;
    const bool nyu40 = classes == ScanNetClasses::kNyu40;
    for (const ClassLabel& label : read_label_set(nyu40 ? "scannet20" : "scannet200").labels)
      official_[label.id] = label.name;
  }

  const ClassOfName& find(const std::string& name) {
    const auto known = found_.find(name);
    if (known != found_.end()) return known->second;
    ClassOfName found = table_.find(name, classes_);
    if (const auto official = official_.find(found.id); official != official_.end())
      found.name = official->second;
    else if (classes_ == ScanNetClasses::kScanNet200)
      found.id = 0;
    return found_[name] = found;
  }

 private:
  NameTable table_;
  ScanNetClasses classes_;
  std::unordered_map<std::int32_t, std::string> official_;
  std::unordered_map<std::string, ClassOfName> found_;
};

void annotate(const std::vector<std::int64_t>& segments, const Annotations& annotations,
              ClassFinder& classes, Truth& truth) {
  truth.instances.assign(segments.size(), 0);
  truth.classes.assign(segments.size(), 0);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto annotation = annotations.find(segments[i]);
    if (annotation == annotations.end()) continue;
    const auto& [instance, name] = annotation->second;
    truth.instances[i] = instance;
    truth.instance_names[instance] = name;
    const ClassOfName& found = classes.find(name);
    truth.classes[i] = found.id;
    if (found.id > 0) truth.class_names[found.id] = found.name;
  }
}

}  // namespace

fs::path find_scannet_mesh(const fs::path& folder) {
  for (const fs::path& place : {folder, folder.parent_path()})
    for (const std::string_view ending : {kLabelledMesh, kPlainMesh})
      if (const fs::path mesh = mesh_in(place, ending); !mesh.empty()) return mesh;
  return {};
}

Truth load_scannet_truth(const fs::path& mesh, ScanNetClasses classes) {
  Truth truth;
  truth.mesh = read_ply(mesh);
  truth.mesh.labels.clear();  // NYU40 ids, which the table gives as well
  const fs::path segment_file = scene_file(mesh, "_vh_clean_2.0.010000.segs.json");
  const fs::path annotation_file = scene_file(mesh, ".aggregation.json");
  const std::vector<std::int64_t> segments = read_segments(segment_file);
  if (segments.size() != truth.mesh.vertices.size() || segments.empty())
    throw Error(concat("'", segment_file.string(), "' has ", segments.size(),
                       " vertices, but its mesh has ", truth.mesh.vertices.size(),
                       ": the two are not of the same scene"));
  ClassFinder finder(find_table(mesh), classes);
  annotate(segments, read_annotations(annotation_file), finder, truth);
  if (truth.instance_names.empty())
    throw Error(concat("no segment of '", annotation_file.string(), "' occurs in '",
                       segment_file.string(), "': the two are not of the same scene"));
  return truth;
}

}  // namespace ovimap
