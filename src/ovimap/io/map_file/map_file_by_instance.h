// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_file_record.h"

namespace ovimap {

/// Reads what maps before schema 5 tell of records and looks. They tell it by instance: all of it
/// goes to the super-point that gave the instance its id. An object without super-points, as
/// `ovimap embed` made them, gets one with a new label of `forest`. Call when the rest of the
/// registry, instances and frames are read. Throws Error with a phrase when the file does not hold
/// what was written.
void read_by_instance(SQLite::Database& database, int schema, LabelForest& forest,
                      MapRecord& record);

}  // namespace ovimap
