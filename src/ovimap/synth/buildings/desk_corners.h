// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ovimap/synth/rooms/room.h"
#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {

/// A corner of a room with one piece that things lie on: a scene of desks-v1.
struct DeskCorner {
  RoomSpec spec;
  std::string main_class;  ///< of the piece that is filmed
};

std::vector<DeskCorner> desk_corners();

/// How somebody films the piece who stands before it: to and fro, nearer and farther, looking over
/// all its decks; a moment a second.
std::vector<SurveyMoment> survey_of(const SynthRoom& room, const std::string& main_class,
                                    bool upright);

}  // namespace ovimap
