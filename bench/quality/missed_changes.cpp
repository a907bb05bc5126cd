// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
//
// Why a map did not tell a change: for each true change of a visit, the objects of the map before and
// after at its places, what comparing the maps says of them, and how alike they are.
//   ovimap_missed_changes BEFORE AFTER VISITS VISIT
// BEFORE, AFTER: maps without and with that visit; VISITS: the folder of `ovimap synth --visits`.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "ovimap/geometry/box_overlap.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/truth/truth_changes.h"
#include "ovimap/pipeline/revise/map_diff.h"
#include "ovimap/pipeline/revise/thing_fit.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace {

using namespace ovimap;

constexpr float kNear = 0.05f;  // overlap of boxes from which an object is listed
constexpr float kGone = 0.25f;  // share seen through from which it may have left

void print_change(const char* place, const ObjectChange& change, float iou, std::size_t points) {
  std::printf("    %-6s iou %.2f  #%u -> #%u %-7s through %.2f there %.2f overlap %.2f shift %.2f  "
              "%zu points\n",
              place, double{iou}, change.before, change.after, change_name(change.kind),
              double{change.seen_through}, double{change.surface_there}, double{change.overlap},
              static_cast<double>(change.shift_m.norm()), points);
}

class Explainer {
 public:
  Explainer(const MapDocument& before, const MapDocument& after)
      : before_(before),
        after_(after),
        changes_(diff_maps(before, after, Pose::Identity())),
        space_before_(before.map, before.depth_camera, poses_of(before.frames)),
        space_after_(after.map, after.depth_camera, poses_of(after.frames)) {}

  void explain(const TrueChange& change) const {
    const Eigen::Vector3f size = (change.from.isEmpty() ? change.to : change.from).sizes();
    std::printf("%s %d, %.2f x %.2f x %.2f m\n", change.kind.c_str(), change.object,
                double{size.x()}, double{size.y()}, double{size.z()});
    for (const ObjectChange& found : changes_) {
      list("from", before_, found.before, change.from, found);
      list("to", after_, found.after, change.to, found);
    }
  }

  /// What left its place, and what came to one, by twos.
  void compare_all() const {
    for (const ObjectChange& gone : changes_)
      for (const ObjectChange& come : changes_)
        if (gone.before != 0 && gone.seen_through > kGone && come.before == 0 && come.after != 0)
          compare(gone.before, come.after);
  }

 private:
  static float iou(const MapRecord& map, InstanceId id, const Eigen::AlignedBox3f& box) {
    for (const InstanceSummary& instance : map.instances)
      if (instance.id == id && !box.isEmpty()) return overlap(instance.box, box);
    return 0;
  }
  static void list(const char* place, const MapRecord& map, InstanceId id,
                   const Eigen::AlignedBox3f& box, const ObjectChange& found) {
    if (const float shared = iou(map, id, box); shared > kNear)
      print_change(place, found, shared, map.surfaces.contains(id) ? map.surfaces.at(id).size() : 0);
  }
  void compare(InstanceId gone, InstanceId come) const {
    const ThingLook a = thing_look(before_, gone, before_.up), b = thing_look(after_, come, after_.up);
    const ThingFit fit =
        fit_things(a, space_before_, b, space_after_, before_.map.config().voxel_size_m);
    std::printf("    #%u and #%u: agreed %.2f, contradicted %.2f, reach %.2f %.2f\n", gone, come,
                double{fit.agreed}, double{fit.contradicted}, double{a.reach_m}, double{b.reach_m});
  }

  const MapDocument &before_, &after_;
  std::vector<ObjectChange> changes_;
  ObservedSpace space_before_, space_after_;
};

/// Only the visit's own frames bear witness.
MapDocument of_last_visit(MapDocument map) {
  map.frames.erase(map.frames.begin(), map.frames.begin() + map.history.visits.back().first_frame);
  return map;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: ovimap_missed_changes BEFORE AFTER VISITS VISIT\n");
    return 2;
  }
  try {
    const MapDocument before = load_map(arguments[1]), after = of_last_visit(load_map(arguments[2]));
    const Explainer explainer(before, after);
    for (const TrueChange& change : load_true_changes(arguments[3]).changes)
      if (change.visit == std::atoi(arguments[4])) explainer.explain(change);
    explainer.compare_all();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
