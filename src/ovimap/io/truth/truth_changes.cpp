// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/truth_changes.h"

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr std::size_t kMostBytes = 64 << 20;

Eigen::Vector3f point_from(const nlohmann::json& numbers) {
  return {numbers.at(0).get<float>(), numbers.at(1).get<float>(), numbers.at(2).get<float>()};
}

Eigen::AlignedBox3f box_from(const nlohmann::json& box) {
  if (box.is_null()) return {};
  return {point_from(box.at("min")), point_from(box.at("max"))};
}

TrueChange change_from(const nlohmann::json& entry, std::size_t visits) {
  TrueChange change;
  change.visit = entry.at("visit").get<int>();
  change.object = entry.at("object").get<std::int32_t>();
  change.kind = entry.at("kind").get<std::string>();
  change.from = box_from(entry.at("from"));
  change.to = box_from(entry.at("to"));
  const bool known = change.kind == "moved" || change.kind == "removed" || change.kind == "added";
  if (!known) throw Error(concat("has a change of kind '", change.kind, "'"));
  if (change.visit < 2 || static_cast<std::size_t>(change.visit) > visits)
    throw Error(concat("has a change of visit ", change.visit, ", and there are ", visits));
  if (change.from.isEmpty() != (change.kind == "added") ||
      change.to.isEmpty() != (change.kind == "removed"))
    throw Error(concat("has a thing ", change.object, " that is ", change.kind,
                       " without the places that say so"));
  return change;
}

TrueMover mover_from(const nlohmann::json& entry, std::size_t visits) {
  const TrueMover mover{entry.at("visit").get<int>(), entry.at("object").get<std::int32_t>()};
  if (mover.visit < 1 || static_cast<std::size_t>(mover.visit) > visits)
    throw Error(
        concat("has something that moves in visit ", mover.visit, ", and there are ", visits));
  return mover;
}

}  // namespace

TrueChanges load_true_changes(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "changes.json";
  if (!std::filesystem::exists(file))
    throw Error(concat(folder.string(),
                       " has no changes.json; give a folder that `ovimap synth --visits` wrote"));
  const nlohmann::json document = read_json(file, kMostBytes);
  TrueChanges truth;
  try {
    for (const auto& visit : document.at("visits"))
      truth.visits.push_back(folder / visit.get<std::string>());
    for (const auto& change : document.at("changes"))
      truth.changes.push_back(change_from(change, truth.visits.size()));
    if (const auto moving = document.find("moving"); moving != document.end())
      for (const auto& mover : *moving)
        truth.moving.push_back(mover_from(mover, truth.visits.size()));
  } catch (const nlohmann::json::exception& fault) {
    throw Error(
        concat(file.string(), ": is not what `ovimap synth --visits` writes (", fault.what(), ")"));
  } catch (const Error& fault) {
    throw Error(concat(file.string(), ": ", fault.what()));
  }
  return truth;
}

}  // namespace ovimap
