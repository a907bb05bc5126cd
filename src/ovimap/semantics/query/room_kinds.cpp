// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/room_kinds.h"

#include <algorithm>
#include <numeric>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/query/query_words.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {

namespace {

constexpr float kNoKind = 0.5f;  // of a thing: what speaks for a room of no kind that we know
constexpr float kClear = 0.5f;

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

bool any_below(const std::vector<Concepts::Kind>& kinds, const std::vector<Concepts::Kind>& thing) {
  return std::any_of(kinds.begin(), kinds.end(), [&](Concepts::Kind kind) {
    return std::any_of(thing.begin(), thing.end(),
                       [&](Concepts::Kind of) { return builtin_concepts().is_kind_of(kind, of); });
  });
}

/// [objects] that each is such a thing; what is not clear enough to be its name counts as nothing.
Eigen::VectorXf shares_of(const std::vector<Concepts::Kind>& thing,
                          const std::vector<SearchObject>& objects, const TextEvidence* evidence) {
  Eigen::VectorXf shares = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(objects.size()));
  if (evidence != nullptr) {
    const auto& words = builtin_concepts().household();
    Eigen::VectorXf below(static_cast<Eigen::Index>(words.size()));
    for (std::size_t word = 0; word < words.size(); ++word)
      below[static_cast<Eigen::Index>(word)] = any_below({words[word].kind}, thing) ? 1.f : 0.f;
    const Eigen::MatrixXf& weights = evidence->household_weights();
    shares = (weights * below).array() / weights.rowwise().sum().array().max(1e-20f);
    const float least = evidence->config().name_share;
    shares = (shares.array() >= least).select(shares.cwiseMin(1.f), 0.f);
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (!objects[i].name.empty())
      shares[static_cast<Eigen::Index>(i)] =
          any_below(builtin_concepts().kinds_of(objects[i].name), thing) ? 1.f : 0.f;
  return shares;
}

}  // namespace

const std::vector<RoomKind>& room_kinds() {
  static const std::vector<RoomKind> kinds = [] {
    std::vector<RoomKind> read;
    for (const std::string& line : list_entries(builtin_word_list("room_kinds"))) {
      const auto parts = split(line, ';');
      RoomKind& kind = read.emplace_back();
      kind.names = split(parts.at(0), '|');
      kind.things = split(parts.at(1), '|');
    }
    return read;
  }();
  return kinds;
}

const std::vector<int>& ObjectRooms::of_objects() const {
  std::call_once(once_, [this] { rooms_ = find_(); });
  return rooms_;
}

std::optional<std::size_t> RoomFit::kind() const {
  const auto best = std::max_element(chances.begin(), chances.end());
  if (best == chances.end() || *best < kClear) return std::nullopt;
  return static_cast<std::size_t>(best - chances.begin());
}

std::vector<RoomFit> fit_rooms(std::span<const int> room_of,
                               const std::vector<SearchObject>& objects,
                               const TextEvidence* evidence) {
  OVIMAP_ASSERT(room_of.size() == objects.size());
  const int rooms = room_of.empty() ? 0 : *std::max_element(room_of.begin(), room_of.end());
  std::vector<RoomFit> fits(static_cast<std::size_t>(rooms));
  for (RoomFit& fit : fits) {
    fit.chances.assign(room_kinds().size(), 0.f);
    fit.known_by.resize(room_kinds().size());
  }
  for (std::size_t k = 0; k < room_kinds().size(); ++k)
    for (const std::string& name : room_kinds()[k].things) {
      const Eigen::VectorXf shares =
          shares_of(builtin_concepts().kinds_of(name), objects, evidence);
      std::vector<std::pair<float, std::size_t>> best(fits.size());  // share and object, by room
      for (std::size_t i = 0; i < objects.size(); ++i) {
        const float share = shares[static_cast<Eigen::Index>(i)];
        if (room_of[i] == 0) continue;
        auto& most = best[static_cast<std::size_t>(room_of[i] - 1)];
        if (share > most.first) most = {share, i};
      }
      for (std::size_t r = 0; r < fits.size(); ++r) {
        if (best[r].first == 0.f) continue;
        fits[r].chances[k] += best[r].first;
        fits[r].known_by[k].push_back(best[r].second);
      }
    }
  for (RoomFit& fit : fits) {
    const float all = std::accumulate(fit.chances.begin(), fit.chances.end(), kNoKind);
    for (float& chance : fit.chances) chance /= all;
  }
  return fits;
}

std::optional<WantedRoom> wanted_room(std::string_view text) {
  const std::vector<std::string> words = words_of(text);
  const std::string wanted = lower_case(joined(without_articles(words)));
  for (std::size_t k = 0; k < room_kinds().size(); ++k)
    for (const std::string& name : room_kinds()[k].names)
      if (wanted == name) return WantedRoom{k, 0};
  constexpr std::string_view kRoom = "room ";
  const std::string number = wanted.starts_with(kRoom) ? wanted.substr(kRoom.size()) : "";
  const bool whole = !number.empty() && number.size() <= 4 &&
                     number.find_first_not_of("0123456789") == std::string::npos;
  if (whole) return WantedRoom{std::nullopt, std::stoi(number)};
  return std::nullopt;
}

float chance_of(const WantedRoom& wanted, int room, const RoomFit& fit) {
  if (wanted.kind) return fit.chances[*wanted.kind];
  return room == wanted.number ? 1.f : 0.f;
}

std::string describe_room(int room, const RoomFit& fit, const std::vector<SearchObject>& objects) {
  std::string text = concat("room ", room);
  const auto kind = fit.kind();
  if (!kind) return text;
  text += concat(", a ", room_kinds()[*kind].names[0], " by");
  std::vector<std::size_t> things = fit.known_by[*kind];  // one may stand for several
  std::sort(things.begin(), things.end());
  things.erase(std::unique(things.begin(), things.end()), things.end());
  for (const std::size_t thing : things) text += concat(" #", objects[thing].id);
  return text;
}

}  // namespace ovimap
