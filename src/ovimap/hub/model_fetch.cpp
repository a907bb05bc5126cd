// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/model_fetch.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "ovimap/base/error.h"
#include "ovimap/base/installation/installed_data.h"
#include "ovimap/hub/transfer/folder_lock.h"
#include "ovimap/inference/models/model_folder.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPartial = ".partial";
constexpr double kBytesPerMb = 1e6;

// What says how a model is used, and on what terms.
const std::vector<std::string>& needed_files(const std::string& kind) {
  static const std::vector<std::string> encoder = {"config.json", "preprocessor_config.json",
                                                   "tokenizer.json", "tokenizer_config.json"};
  static const std::vector<std::string> sam = {"config.json", "preprocessor_config.json"};
  return kind == "sam" ? sam : encoder;
}

bool is_optional(const std::string& path) {
  static const std::set<std::string> optional = {"spiece.model", "LICENSE", "LICENSE.md",
                                                 "LICENSE.txt", "NOTICE"};
  return optional.contains(path);
}

std::string network_path(const std::string& stem, const std::string& ending) {
  return stem + ending + ".onnx";
}

bool has_variant(const HubListing& listing, const CatalogueEntry& entry,
                 const std::string& ending) {
  return std::all_of(entry.files.begin(), entry.files.end(), [&](const auto& file) {
    return listing.find(network_path(file.second, ending));
  });
}

std::string ending_of(const FetchTarget& target) {
  std::string there, all;
  std::optional<std::string> ending;
  for (const ModelVariant& variant : model_variants()) {
    all += (all.empty() ? "" : ", ") + variant.name;
    if (has_variant(target.listing, target.entry, variant.ending))
      there += (there.empty() ? "" : ", ") + variant.name;
    if (variant.name == target.variant) ending = variant.ending;
  }
  if (!ending) throw Error(concat("--variant is '", target.variant, "'; accepted is ", all));
  if (!has_variant(target.listing, target.entry, *ending))
    throw Error(concat("repository ", target.listing.repository, " has no variant '",
                       target.variant, "'; it has ", there.empty() ? "none that fits" : there));
  return *ending;
}

/// A network's file, and the weights that ONNX keeps beside it.
bool belongs_to(const HubFile& file, const std::string& network) {
  return file.path == network || file.path.starts_with(network + "_data") ||
         file.path.starts_with(network + ".data");
}

std::uint64_t bytes_there(const FetchTarget& target, const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const HubFile& file : target.wanted) {
    std::error_code absent;
    const std::uintmax_t there = fs::file_size(folder / file.path, absent);
    if (!absent) bytes += std::min<std::uint64_t>(there, file.bytes);
  }
  return bytes;
}

void check_room(const FetchTarget& target, const fs::path& folder) {
  const std::uint64_t missing = bytes_of(target) - bytes_there(target, folder);
  const std::uint64_t room = fs::space(folder).available;
  if (missing > room)
    throw Error(concat("no room for ", target.entry.name, " in ",
                       folder.parent_path().parent_path().string(), ": it needs ",
                       std::llround(static_cast<double>(missing) / kBytesPerMb), " MB more, ",
                       std::llround(static_cast<double>(room) / kBytesPerMb),
                       " MB are free; make room, name another folder with --model-dir, or take "
                       "--variant quantized"));
}

/// Whether that very fetch lies there, unharmed. Throws Error when something lies there that was
/// not fetched.
bool is_there(const FetchTarget& target, const fs::path& folder) {
  if (!fs::exists(folder)) return false;
  ModelFolder model;
  try {
    model = read_model_folder(folder);
  } catch (const Error& error) {
    throw Error(concat(error.what(), "; remove the folder, or name another with --as"));
  }
  if (model.extra("catalogue").empty())
    throw Error(concat("model folder ", folder.string(),
                       " exists and was not fetched; name another with --as"));
  if (model.extra("catalogue") != target.entry.name ||
      model.extra("revision") != target.listing.commit || model.extra("variant") != target.variant)
    return false;
  try {
    verify_model_files(model);
  } catch (const Error&) {
    return false;  // harmed: fetched again
  }
  return true;
}

void download(const Hub& hub, const FetchTarget& target, const fs::path& folder,
              const TotalProgress& progress) {
  std::uint64_t before = 0;
  for (const HubFile& file : target.wanted) {
    hub.fetch(target.listing, file, folder / file.path,
              [&](const HubFile& now, std::uint64_t bytes) {
                return progress(before + bytes, now.path);
              });
    before += file.bytes;
  }
}

/// Describes and tries what was downloaded. A folder that fails has no model.yaml.
SelfTest make_usable(const fs::path& folder, const FetchTarget& target) {
  try {
    const ModelDescription description = describe_model(folder, target);
    write_model_yaml(folder, target, description, {});
    SelfTest test = self_test(folder);
    std::vector<std::pair<std::string, std::string>> remarks = {
        {"self_test", test.passed() ? "passed" : "doubtful"}};
    if (!test.batch_agrees) remarks.emplace_back("items_at_once", "1");
    write_model_yaml(folder, target, description, remarks);
    return test;
  } catch (...) {
    fs::remove(folder / "model.yaml");
    throw;
  }
}

/// Puts `made` where `folder` is; what was there goes.
void put_in_place(const fs::path& made, const fs::path& folder) {
  const fs::path old = made.string() + ".old";
  fs::remove_all(old);
  if (fs::exists(folder)) fs::rename(folder, old);
  fs::rename(made, folder);
  fs::remove_all(old);
}

}  // namespace

std::uint64_t bytes_of(const FetchTarget& target) {
  std::uint64_t bytes = 0;
  for (const HubFile& file : target.wanted) bytes += file.bytes;
  return bytes;
}

FetchTarget find_target(const Hub& hub, const CatalogueEntry& entry, const std::string& variant) {
  FetchTarget target{entry, variant, hub.list(entry.repository, entry.revision), {}, {}};
  const std::string ending = ending_of(target);
  for (const auto& [network, stem] : entry.files)
    target.files[network] = network_path(stem, ending);
  for (const std::string& name : needed_files(entry.kind))
    if (!target.listing.find(name))
      throw Error(concat("repository ", entry.repository, " has no ", name,
                         ", which says how the model is used"));
  const std::vector<std::string>& needed = needed_files(entry.kind);
  for (const HubFile& file : target.listing.files) {
    const bool network =
        std::any_of(target.files.begin(), target.files.end(),
                    [&](const auto& part) { return belongs_to(file, part.second); });
    if (network || is_optional(file.path) ||
        std::find(needed.begin(), needed.end(), file.path) != needed.end())
      target.wanted.push_back(file);
  }
  return target;
}

fs::path fetch_place(const std::vector<fs::path>& model_dirs) {
  if (!model_dirs.empty()) return model_dirs.front();
  const char* listed = std::getenv("OVIMAP_MODELS");
  if (const std::string first = std::string(listed ? listed : ""); !first.empty())
    return first.substr(0, first.find(':'));
  const std::optional<fs::path> brought = installed_data("models");  // not to be written to
  for (const fs::path& searched : model_search_path())
    if (searched != brought) return searched;
  if (const std::optional<fs::path> data = user_model_folder()) return *data;
  throw Error("there is no folder for models; name one with --model-dir");
}

FetchedModel fetch_model(const Hub& hub, const FetchTarget& target, const fs::path& place,
                         const std::string& name, const TotalProgress& progress) {
  const fs::path folder = place / name;
  fs::create_directories(place / kPartial);
  const FolderLock lock(place / kPartial / (name + ".lock"), concat("a fetch of ", name));
  if (is_there(target, folder)) return {folder, true, {}};
  const fs::path made =
      place / kPartial / concat(name, ".", target.variant, ".", target.listing.commit);
  fs::create_directories(made);
  check_room(target, made);
  download(hub, target, made, progress);
  const SelfTest test = make_usable(made, target);
  put_in_place(made, folder);
  return {folder, false, test};
}

}  // namespace ovimap
