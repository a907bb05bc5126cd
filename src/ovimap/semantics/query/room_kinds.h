// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ovimap/semantics/query/search_index.h"
#include "ovimap/semantics/words/text_evidence.h"

namespace ovimap {

/// A kind of room (data/room_kinds.txt).
struct RoomKind {
  std::vector<std::string> names;   ///< "living room", "lounge"; the first is shown
  std::vector<std::string> things;  ///< that one knows it by
};
const std::vector<RoomKind>& room_kinds();

/// The room that each object of a map is in, found when it is first asked for. Thread-safe.
class ObjectRooms {
 public:
  /// `find`: 1, 2, ... by the object's position, 0 where it is in none; called once.
  explicit ObjectRooms(std::function<std::vector<int>()> find) : find_(std::move(find)) {}

  const std::vector<int>& of_objects() const;

 private:
  std::function<std::vector<int>()> find_;
  mutable std::once_flag once_;
  mutable std::vector<int> rooms_;
};

/// How well a room's objects fit each kind of room.
struct RoomFit {
  std::vector<float> chances;  ///< by kind, adding up to less than 1: it may be none of them
  std::vector<std::vector<std::size_t>> known_by;  ///< by kind: positions of the things that say so

  /// The kind with at least half of the chance; nothing where it is not clear.
  std::optional<std::size_t> kind() const;
};

/// Of each room, 1, 2, ...: every thing that speaks for a kind counts as much as it is likely to be
/// in the room (of several sofas the likeliest counts), and all kinds share the chance, with half a
/// thing's worth for none of them. `room_of`: by object. `evidence` may be null: then names that
/// people gave count alone.
std::vector<RoomFit> fit_rooms(std::span<const int> room_of,
                               const std::vector<SearchObject>& objects,
                               const TextEvidence* evidence);

/// A room as a query calls it: by its kind or by its number.
struct WantedRoom {
  std::optional<std::size_t> kind;
  int number = 0;
};

/// "kitchen", "Living room", "room 3"; nothing where the text is no room.
std::optional<WantedRoom> wanted_room(std::string_view text);

/// That the room with this number is the wanted one.
float chance_of(const WantedRoom& wanted, int room, const RoomFit& fit);

/// "room 2, a kitchen by #12 #31", or "room 2" where its kind is not clear.
std::string describe_room(int room, const RoomFit& fit, const std::vector<SearchObject>& objects);

}  // namespace ovimap
