// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/fusion/past_evidence.h"
#include "ovimap/pipeline/revise/map_diff.h"

namespace ovimap {

struct VisitHistoryConfig {
  MapDiffConfig diff;
  float least_shift_m = 0.08f;  ///< what moved less than that has not
  float least_filled = 0.125f;  ///< what has less surface, as a share of the largest side of its
                                ///< box along its own axes, is no thing: the tubes of a bicycle
                                ///< have a sixth, reckoned from their lengths
  float same_shape = 0.15f;   ///< mean distance of two surfaces laid over each other, as a share of
                              ///< their reach, that counts as much as no colour in common, ...
  float coarse_voxels = 1.f;  ///< ... but at least so much: surfaces are as rough
  float most_difference = 1.3f;  ///< of shapes and colours, both added, of what may be one thing
  float doubt = 0.25f;  ///< the likeliest pair is one thing when the next differs by so much more:
                        ///< two chairs of a kind differ by nearly as much
};

/// Gives a header, which may name one visit with its date, the history of the map that it goes on
/// with and its own visit after that: the next frames of the map are of it.
void begin_visit(const MapRecord& begun, MapHeader& header);
/// The same of a whole map, which mapping goes on with: between two visits anything may have come
/// and gone, so what earlier ones saw counts less, and no space is known to be free.
void begin_visit(MapDocument& begun, const PastEvidenceConfig& past, MapHeader& header);

/// Writes down what the last visit of `after` changed against `before`, the same map without that
/// visit: events of its history, with what each thing was that left its place. An object that is
/// gone from one place and found at another is the same when its looks (diff_maps), or else its
/// shape and colours, say so, and goes on under the id that it had. Where several could be it, each
/// found one is a new object that says which gone one it may be. An object at its old place that
/// the visit took for a new one gets its id back, and with it what people corrected of it meanwhile
/// (edits of `after` beyond those of `before`). What is left of things that left their places,
/// where the visit did not look, goes (forget_remains), and no object is what is gone.
///
/// `store`: where voxels may be meanwhile that the visit touched; null: in memory.
void tell_visit(const MapDocument& before, MapDocument& after,
                const VisitHistoryConfig& config = {}, std::shared_ptr<BlockStore> store = nullptr);

/// Two instances of a record trade their ids: in its list and surfaces, and in the registry's
/// state. Of ids that stand for one thing the oldest goes on standing for all. Names and
/// corrections stay with the ids.
void swap_instances(MapRecord& record, InstanceId a, InstanceId b);

/// What is found where `gone` was, and goes by its id, is `known`, which is elsewhere no more: they
/// trade their ids. Older ids than that of `known` which still name its super-points are those of
/// `gone`: they stay with that one, and the super-points get ids that nothing had.
void take_place(MapRecord& record, InstanceId known, InstanceId gone);

}  // namespace ovimap
