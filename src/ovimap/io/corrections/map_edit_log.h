// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "ovimap/instance/instance_aliases.h"
#include "ovimap/io/map_tables/map_edit.h"

namespace SQLite {
class Database;
}

namespace ovimap {

/// "rename", "merge", "split", "lock", "delete", "hide", "undo".
const char* edit_action_name(EditAction action);

/// What an edit speaks of as a JSON object: {"instances", "name", ...}, keys that say nothing left
/// out.
std::string edit_arguments_json(const MapEdit& edit);

/// Which edits have an effect, undone ones and undos left out, oldest first.
MapEdits effective_edits(const MapEdits& log);

/// What effective edits speak of, by the ids that stand for them.
std::set<InstanceId> corrected_instances(const MapEdits& log, const InstanceAliases& aliases);

/// Sets undone_by throughout.
void mark_undone(MapEdits& log);

/// The table `edits`. Reading an older map gives an empty log. Throws Error with a phrase when the
/// table is not what was written.
void write_edits(SQLite::Database& database, const MapEdits& log);
MapEdits read_edits(SQLite::Database& database);

}  // namespace ovimap
