// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/evaluation/map_evaluation.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ovimap/base/config.h"
#include "ovimap/base/listed.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/io/truth/truth.h"
#include "ovimap/pipeline/evaluation/truth_classes.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/pipeline/search/name_guesses.h"
#include "ovimap/semantics/query/query_engine.h"

namespace ovimap {

namespace {

/// A scene while it is being evaluated.
struct Draft {
  EvaluatedScene scene;
  MapAndTruth paths;
  TruthClasses classes;
  bool embedded = false;  ///< the map has embeddings
};

void require_one_frame(const MapAndTruth& paths, const Mesh& truth, const Mesh& map,
                       const FrameCheckConfig& config) {
  if (map.vertices.empty())
    throw Error(concat("map ", paths.map.string(), " has no surface to score; map the recording ",
                       "again and look at `ovimap info`"));
  if (truth.vertices.empty())
    throw Error(concat("the truth of ", paths.source.string(), " has no surface to score against"));
  const FrameCheck check = check_frames(truth.vertices, map.vertices, config);
  if (!check.fault.empty())
    throw Error(concat("map ", paths.map.string(), " and the truth of ", paths.source.string(),
                       " do not fit (", static_cast<int>(std::lround(100 * check.share)),
                       " % of the map lies on the truth): ", check.fault));
}

/// The surface of a map that `ovimap embed gt` made: its objects are the truth's own.
Mesh true_objects(const Truth& truth, const MapDocument& map, const MapAndTruth& paths) {
  Mesh mesh = truth.mesh;
  mesh.labels.clear();
  for (const std::int32_t id : truth.instances)
    mesh.labels.push_back(id > 0 ? static_cast<std::uint32_t>(id) : 0);
  for (const InstanceSummary& instance : map.instances)
    if (std::find(mesh.labels.begin(), mesh.labels.end(), instance.id) == mesh.labels.end())
      throw Error(concat("map ", paths.map.string(), " has no surface, and its object ",
                         instance.id, " is none of the truth of ", paths.source.string(),
                         "; score maps that `ovimap run` or `ovimap embed gt` made"));
  return mesh;
}

/// What is scored: its surface with the objects' labels, and what else a map holds.
struct Prediction {
  Mesh mesh;
  std::optional<MapDocument> map;  ///< absent: a PLY file, of whatever program
};

Prediction load_prediction(const Truth& truth, const MapAndTruth& paths) {
  if (paths.map.extension() == ".ply") {
    Prediction ply{read_ply(paths.map), std::nullopt};
    ply.mesh.labels.resize(ply.mesh.vertices.size(), 0);
    return ply;
  }
  MapDocument map = load_corrected_map(paths.map);
  Mesh mesh = map.map.block_count() > 0 ? extract_instance_mesh(map.map, map.instances)
                                        : true_objects(truth, map, paths);
  return {std::move(mesh), std::move(map)};
}

/// Of each object; none where nobody rated the masks: pieces of depth fit what is made of them.
/// What a person put together is surest.
std::map<InstanceId, float> confidences(const Prediction& predicted) {
  std::map<InstanceId, float> confidence;
  if (!predicted.map) return confidence;
  const std::vector<InstanceSummary>& instances = predicted.map->instances;
  if (std::none_of(instances.begin(), instances.end(),
                   [](const auto& one) { return one.confidence.has_value(); }))
    return confidence;
  for (const InstanceSummary& instance : instances)
    confidence[instance.id] = instance.confidence.value_or(1.f);
  return confidence;
}

void count_views(const MapDocument& map, int min_views, EvaluatedScene& scene) {
  InstanceRegistry registry(map.instance_config);  // knows objects too small for the list as well
  registry.restore(map.registry);
  std::set<InstanceId> embedded_ids;
  for (const auto& [label, look] : map.semantics.looks) {
    scene.embedding_queries += look.queries;
    if (look.queries > 0) embedded_ids.insert(registry.instance_of(label));
  }
  scene.embedded_instances += static_cast<int>(embedded_ids.size());
  for (const InstanceSummary& instance : map.instances) {
    const Appearance look = appearance_of(map.semantics.looks, instance.super_points);
    const auto embedded =
        std::count_if(look.views.begin(), look.views.end(),
                      [](const ObjectView* view) { return view->embedding.size() > 0; });
    if (embedded < min_views) scene.few_views.push_back(instance.id);
  }
}

/// Truth, map and sizes of things; walls, floors and ceilings are known by their names.
SizedScene sized_scene(const Truth& truth, std::vector<std::uint32_t> predicted) {
  SizedScene scene{truth.instances,
                   std::move(predicted),
                   measured_sizes(truth.mesh.vertices, truth.instances),
                   truth.unscored,
                   {}};
  for (const auto& [id, name] : truth.instance_names)
    if (name == "wall" || name == "floor" || name == "ceiling") scene.structure.insert(id);
  return scene;
}

std::map<std::uint32_t, Eigen::AlignedBox3f> boxes_of(std::span<const InstanceSummary> objects) {
  std::map<std::uint32_t, Eigen::AlignedBox3f> boxes;
  for (const InstanceSummary& object : objects) boxes[object.id] = object.box;
  return boxes;
}

/// The numbering of ScanNet's own truth that a set of classes needs: its 20 are some of NYU's 40.
ScanNetClasses numbering_for(const std::string& classes) {
  return classes == "scannet20" ? ScanNetClasses::kNyu40 : ScanNetClasses::kScanNet200;
}

Draft draft_scene(const MapAndTruth& paths, const std::string& classes,
                  const EvaluationConfig& config) {
  Truth truth = load_truth(paths.source, numbering_for(classes));
  const Prediction predicted = load_prediction(truth, paths);
  const Mesh& mesh = predicted.mesh;
  require_one_frame(paths, truth.mesh, mesh, config.frames);
  Draft draft;
  draft.paths = paths;
  draft.scene.name = paths.map.string();
  draft.scene.geometry = geometry_scores(truth.mesh, mesh, config.geometry);
  std::vector<std::uint32_t> labels =
      transfer_labels(truth.mesh.vertices, mesh.vertices, mesh.labels, config.transfer);
  draft.scene.sized = sized_scene(truth, labels);
  for (std::int32_t& id : truth.instances)
    if (truth.unscored.count(id) > 0) id = 0;
  draft.scene.labels.instances = {std::move(truth.instances), std::move(labels),
                                  confidences(predicted)};
  if (predicted.map)
    draft.scene.boxes = box_scores(truth.mesh.vertices, draft.scene.labels.instances,
                                   boxes_of(predicted.map->instances));
  draft.classes = {paths.source, std::move(truth.classes), std::move(truth.class_names)};
  draft.embedded = predicted.map && has_embeddings(*predicted.map);
  if (draft.embedded) count_views(*predicted.map, config.min_embedded_views, draft.scene);
  return draft;
}

/// Why there are no semantic figures; empty when there can be.
std::string lacking(const std::vector<Draft>& drafts, const EvaluationOptions& options) {
  for (const Draft& draft : drafts) {
    const std::string map = draft.paths.map.string(), source = draft.paths.source.string();
    if (draft.classes.ids.empty()) {
      if (options.classes != "auto")
        throw Error(concat("the truth of '", source, "' has no classes to score against ",
                           options.classes, "; its semantic labels are missing (Replica layout: ",
                           "semantic_labels_SCENE.txt beside the scene's folder)"));
      return concat("no semantic figures: the truth of ", source, " has no classes");
    }
    if (options.classes == "auto" && draft.classes.names.empty())
      return concat("no semantic figures: the truth of ", source, " does not name its classes; ",
                    "choose the set they are from with --classes");
    if (options.encoder == "none") return "no semantic figures: --encoder none";
    if (draft.paths.map.extension() == ".ply")
      return concat("no semantic figures: ", map, " is a surface without embeddings");
    if (!draft.embedded)
      return concat("no semantic figures: map ", map, " has no embeddings; make them with ",
                    "`ovimap reembed`");
  }
  return {};
}

std::map<std::uint32_t, std::int32_t> numbers_of_guesses(
    const SearchIndex& index, const std::vector<std::vector<ClassGuess>>& guesses) {
  std::map<std::uint32_t, std::int32_t> numbers;
  for (std::size_t i = 0; i < guesses.size(); ++i)
    if (!guesses[i].empty())
      numbers[index.object(i).id] = static_cast<std::int32_t>(guesses[i].front().label) + 1;
  return numbers;
}

/// The classes of truth and map in the set's numbers.
void add_classes(Draft& draft, const LabelSet& set, ImageTextEncoder& encoder,
                 std::vector<std::string>& notices) {
  constexpr std::size_t kBestOnly = 1;
  NumberedClasses numbered = number_classes(draft.classes, set);
  if (!numbered.unknown.empty())
    notices.push_back(concat("not scored, because ", set.name,
                             " has no class for it: ", listed(numbered.unknown), " (",
                             static_cast<int>(std::lround(100 * numbered.unknown_share)),
                             " % of the truth of ", draft.paths.source.string(), ")"));
  draft.scene.labels.truth_classes = std::move(numbered.numbers);
  const MapSearch search = open_map_search(draft.paths.map);
  const QueryEngine engine(search.index, &encoder, {}, {}, search.scene);
  draft.scene.labels.predicted_classes = numbers_of_guesses(
      search.index, project_classes(search.index, *engine.matcher(), set, kBestOnly));
  draft.scene.picture_classes =
      numbers_of_guesses(search.index, project_classes(search.index, encoder, set, kBestOnly));
}

LabelSet chosen_set(const std::vector<Draft>& drafts, const std::string& classes) {
  if (classes != "auto" && classes != "truth") return read_label_set(classes);
  std::vector<TruthClasses> truths;
  for (const Draft& draft : drafts) truths.push_back({draft.paths.source, {}, draft.classes.names});
  return label_set_of(truths);
}

/// The paper's released code scores instances of all of ScanNet's classes; its benchmark and
/// Replica's leave out what is stuff.
SemanticClasses numbers_of(const LabelSet& set, Protocol protocol) {
  SemanticClasses classes{static_cast<int>(set.labels.size()), {}};
  const bool scannet = set.built_in && set.name.starts_with("scannet");
  if (protocol == Protocol::kReference && scannet) return classes;
  for (const std::size_t label : stuff_labels(set))
    classes.stuff.push_back(static_cast<std::int32_t>(label) + 1);
  return classes;
}

}  // namespace

void list_fields(EvaluationConfig& config, ConfigFields& fields) {
  fields.group("transfer", [&](ConfigFields& inner) { list_fields(config.transfer, inner); });
  fields.group("frames", [&](ConfigFields& inner) { list_fields(config.frames, inner); });
  fields.group("geometry", [&](ConfigFields& inner) { list_fields(config.geometry, inner); });
  fields.group("reference", [&](ConfigFields& inner) {
    list_fields(config.reference, inner);
    inner.group("semantic",
                [&](ConfigFields& semantic) { list_fields(config.semantic_reference, semantic); });
  });
  fields.group("sizes", [&](ConfigFields& inner) { list_fields(config.sizes, inner); });
  fields.add("min_embedded_views", config.min_embedded_views, 0, 1000,
             "the reference protocol drops objects with fewer embedded views");
}

Evaluation evaluate_maps(std::span<const MapAndTruth> pairs, const EvaluationOptions& options,
                         const EvaluationConfig& config) {
  const bool named = options.classes != "auto" && options.classes != "truth";
  if (named) read_label_set(options.classes);  // a wrong name shows before anything slow
  std::vector<Draft> drafts;
  for (const MapAndTruth& paths : pairs)
    drafts.push_back(draft_scene(paths, options.classes, config));
  Evaluation evaluation;
  if (const std::string reason = lacking(drafts, options); !reason.empty()) {
    evaluation.notices.push_back(reason);
  } else {
    evaluation.classes = chosen_set(drafts, options.classes);
    EncoderIdentity identity;
    std::unique_ptr<ImageTextEncoder> encoder;  // maps mostly share one
    for (Draft& draft : drafts) {
      const EncoderIdentity of_map = read_map_info(draft.paths.map).encoder;
      if (!encoder || !(identity == of_map))
        encoder =
            needed_encoder_of_map(of_map, options.encoder, options.runtime, options.model_dirs);
      identity = of_map;
      add_classes(draft, *evaluation.classes, *encoder, evaluation.notices);
    }
  }
  for (Draft& draft : drafts) evaluation.scenes.push_back(std::move(draft.scene));
  return evaluation;
}

SemanticReport semantic_report(const Evaluation& evaluation, std::size_t first, std::size_t count,
                               Protocol protocol, const EvaluationConfig& config) {
  OVIMAP_ASSERT(evaluation.classes.has_value());
  std::vector<SemanticScene> scenes;
  double queries = 0, instances = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    const EvaluatedScene& scene = evaluation.scenes[i];
    scenes.push_back(scene.labels);
    if (protocol == Protocol::kReference) scenes.back().predicted_classes = scene.picture_classes;
    scenes.back().instances = labelled_scene(scene, protocol);
    queries += scene.embedding_queries, instances += scene.embedded_instances;
  }
  const SemanticClasses classes = numbers_of(*evaluation.classes, protocol);
  SemanticReport report;
  report.classes = protocol == Protocol::kStandard
                       ? standard_class_scores(scenes, classes)
                       : reference_class_scores(scenes, classes, config.semantic_reference);
  report.all = mean_scores(report.classes);
  for (const LabelGroup& group : label_groups(*evaluation.classes)) {
    std::vector<std::int32_t> numbers;
    for (const std::size_t label : group.labels)
      numbers.push_back(static_cast<std::int32_t>(label) + 1);
    report.groups.emplace_back(group.name, mean_scores(report.classes, numbers));
  }
  report.queries_per_instance = instances > 0 ? queries / instances : 0;
  return report;
}

LabelledScene labelled_scene(const EvaluatedScene& scene, Protocol protocol) {
  return protocol == Protocol::kStandard
             ? scene.labels.instances
             : without_instances(scene.labels.instances, scene.few_views);
}

}  // namespace ovimap
