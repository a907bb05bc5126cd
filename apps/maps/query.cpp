// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/command/command.h"
#include "apps/command/file_slug.h"
#include "apps/command/kept_memory.h"
#include "ovimap/base/parallel.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/json_values.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/io/mesh/map_mesh.h"
#include "ovimap/io/mesh/ply.h"
#include "ovimap/io/pictures/pictures.h"
#include "ovimap/pipeline/approach/approach_json.h"
#include "query_asking.h"

namespace ovimap::apps {

namespace {

/// Where to stand for each object of the answers that were found.
struct Approaches {
  StandingSpace space;
  std::map<InstanceId, Approach> of_object;
};

/// The settings of the query; those of --approach go into the options.
QueryConfig query_config(QueryOptions& options) {
  QueryConfig config;
  ConfigFields fields;
  fields.group("query", [&](ConfigFields& inner) { list_fields(config, inner); });
  fields.group("approach",
               [&](ConfigFields& inner) { list_fields(options.approach.config, inner); });
  apply_settings(options.settings, fields);
  if (options.top > 0) config.top_k = options.top;
  return config;
}

nlohmann::json point_json(const Eigen::Vector3f& point) {
  return {point.x(), point.y(), point.z()};
}

nlohmann::json part_json(const QueryMatch& match) {
  if (match.part == 0) return nullptr;
  return {{"number", match.part},
          {"box",
           {{"min", point_json(match.part_box.min())}, {"max", point_json(match.part_box.max())}}}};
}

nlohmann::json match_json(const QueryMatch& match, const SearchObject& object,
                          const std::string& title) {
  return {{"id", match.id},
          {"name", object.name},
          {"title", title},
          {"score", match.score},
          {"standard_score", match.standard_score},
          {"p_value", json_or_null(match.p_value)},
          {"probability", json_or_null(match.probability)},
          {"evidence", match.evidence},
          {"part", part_json(match)},
          {"box", {{"min", point_json(object.box.min())}, {"max", point_json(object.box.max())}}},
          {"centroid", point_json(object.centroid)}};
}

nlohmann::json answer_json(const Answered& answered, const Approaches& approaches) {
  const QueryAnswer& answer = answered.answer;
  nlohmann::json instances = nlohmann::json::array();
  for (const QueryMatch& match : answer.matches) {
    instances.push_back(match_json(match, answered.object(match), answered.title(match)));
    instances.back()["past"] = answered.is_past(match);
    if (const auto there = approaches.of_object.find(match.id); there != approaches.of_object.end())
      instances.back()["approach"] = approach_json(there->second, approaches.space.grid);
  }
  const auto count = answer.count ? nlohmann::json{{"expected", answer.count->expected},
                                                   {"deviation", answer.count->deviation},
                                                   {"found", answer.count->found}}
                                  : nlohmann::json();
  return {{"query", answer.query},
          {"count", count},
          {"verdict", verdict_name(answer.verdict)},
          {"reading", answer.reading},
          {"reason", answer.reason},
          {"instances", instances}};
}

/// A cosine; none where words were not compared with pictures.
std::string score_text(float score) {
  char text[16] = "-";
  if (score != 0.f) std::snprintf(text, sizeof text, "%.3f", double{score});
  return text;
}

/// What was asked and whether it is there.
std::string verdict_text(const QueryAnswer& answer) {
  if (answer.verdict == Verdict::kFound) return answer.query + ": found";
  if (answer.like_object) return concat("nothing else is like ", answer.query);
  return answer.query + ": not in the map";
}

void print_answer(const Answered& answered, const Approaches& approaches) {
  const QueryAnswer& answer = answered.answer;
  std::printf("%s", verdict_text(answer).c_str());
  if (answer.count)
    std::printf(", %d found, %.1f +- %.1f by their chances", answer.count->found,
                answer.count->expected, answer.count->deviation);
  if (!answer.reading.empty()) std::printf(", read as %s", answer.reading.c_str());
  if (!answer.reason.empty()) std::printf(" (%s)", answer.reason.c_str());
  const bool nearest = answer.verdict != Verdict::kFound && !answer.matches.empty();
  std::printf(nearest ? "; what comes nearest:\n" : "\n");
  for (const QueryMatch& match : answer.matches) {
    const SearchObject& object = answered.object(match);
    const Eigen::Vector3f place = match.part == 0 ? object.centroid : match.part_box.center();
    std::printf("  #%-5u %6s", match.id, score_text(match.score).c_str());
    if (match.probability) std::printf("  %3.0f %%", 100.0 * *match.probability);
    std::printf("  at %6.2f %6.2f %6.2f", double{place.x()}, double{place.y()}, double{place.z()});
    if (const std::string& title = answered.title(match); !title.empty())
      std::printf("  %s", title.c_str());
    if (!match.evidence.empty()) std::printf("  %s", match.evidence.c_str());
    std::printf("\n");
    if (const auto there = approaches.of_object.find(match.id); there != approaches.of_object.end())
      print_approach(there->second);
  }
}

/// OUT.png for one query; OUT-1-mug.png, OUT-2-chair.png ... for several.
std::filesystem::path heat_map_path(const std::filesystem::path& out, std::size_t number,
                                    std::size_t count, const std::string& query) {
  if (count == 1) return out;
  constexpr std::size_t kLongest = 40;
  const std::string slug = file_slug(query, kLongest);
  return out.parent_path() / concat(out.stem().string(), "-", number, "-",
                                    slug.empty() ? "query" : slug, out.extension().string());
}

void write_heat_maps(const QueryOptions& options, const Eigen::Vector3f& up,
                     const std::vector<Answered>& answers) {
  const MapDocument document = load_corrected_map(options.map);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const QueryAnswer& answer = answers[i].answer;
    const auto path = heat_map_path(options.heat_map, i + 1, answers.size(), answer.query);
    const MeshParts parts = visible_parts(document, options.map, [&](Mesh& part) {
      color_by_relevance(part, *answers[i].index, answer.relevance);
    });
    if (path.extension() == ".ply") {
      write_ply(path, parts);
      continue;
    }
    constexpr MeshColoring kOwn[] = {MeshColoring::kColors};
    write_file(path, encode_png(top_down(parts, up, kOwn).front()));
  }
}

Approaches find_approaches(const QueryOptions& options, const std::vector<Answered>& answers) {
  Approaches result;
  if (!options.approach.asked) return result;
  result.space = make_standing_space(load_corrected_map(options.map));
  for (const Answered& answered : answers)
    for (const QueryMatch& match : answered.answer.matches)
      if (answered.answer.verdict == Verdict::kFound && !answered.is_past(match) &&
          !result.of_object.contains(match.id))
        result.of_object[match.id] = find_approach(result.space, match.id, options.approach.config,
                                                   options.approach.start());
  return result;
}

void check_options(const QueryOptions& options) {
  check_approach_options(options.approach);
  const std::size_t queries = options.texts.size() + options.images.size() + options.like.size();
  const bool timed = !options.at.empty() || !options.since.empty();
  if (queries == 0 && !timed)
    throw Error("nothing is asked; give a TEXT, --image FILE or --like ID");
  if (timed && !(options.images.empty() && options.like.empty()))
    throw Error("--at and --since belong to a TEXT, or stand alone; leave --image and --like out");
  if (options.texts.empty() && !(options.negatives.empty() && options.near.empty()))
    throw Error("--not and --near belong to a TEXT; give one beside --image or --like");
  if (options.heat_map.empty()) return;
  const std::string kind = options.heat_map.extension().string();
  if (kind != ".ply" && kind != ".png")
    throw Error(concat("cannot draw a heat map into '", options.heat_map.string(),
                       "'; the name must end in .ply or .png"));
}

int query(QueryOptions& options) {
  keep_freed_memory();
  const ThreadLimit limit(options.threads);
  check_options(options);
  const QueryConfig config = query_config(options);
  const std::vector<AskedText> texts = asked_texts(options, config);  // before anything slow
  QueryAsker asker(options, config);
  const std::vector<Answered> answers = asker.ask(texts);
  if (!options.heat_map.empty()) write_heat_maps(options, asker.up(), answers);
  const Approaches approaches = find_approaches(options, answers);
  bool found = false;
  nlohmann::json results = nlohmann::json::array();
  for (const Answered& answered : answers) {
    found = found || answered.answer.verdict == Verdict::kFound;
    if (options.json)
      results.push_back(answer_json(answered, approaches));
    else
      print_answer(answered, approaches);
  }
  if (options.json) print_json({{"results", results}});
  return found ? kDone : kAnswerIsNo;
}

}  // namespace

Action add_query(CLI::App& command) {
  auto options = std::make_shared<QueryOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command.add_option("TEXT", options->texts,
                     "what to look for: \"mug\", \"red chair, armchair\", \"mug on the table\"");
  command.add_option("--top", options->top, "instances shown for each query")
      ->check(CLI::Range(1, 1000000));
  command.add_option("--not", options->negatives, "what it must not be; commas separate")
      ->type_size(1)
      ->allow_extra_args(false);
  auto* at =
      command.add_option("--at", options->at,
                         "ask the map as it was: \"visit 1\", 2026-03-14, Monday, \"2 hours ago\"");
  command
      .add_option("--since", options->since,
                  "only what came, moved or went since then; without TEXT all of it")
      ->excludes(at);
  command.add_option("--near", options->near, "only near this: as \"TEXT near THIS\"");
  command.add_option("--image", options->images, "what looks like this picture")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_option("--like", options->like, "what looks like the object with this id")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_option(
      "--heatmap", options->heat_map,
      "draw how well objects match: .ply (mesh) or .png (from above); one numbered file "
      "per query where there are several");
  command
      .add_option("--encoder", options->encoder,
                  "default, a model, or auto: the one that the map was made with")
      ->capture_default_str();
  add_model_dirs(command, options->model_dirs);
  add_teach_option(command, options->teach, "whether what people named in other maps speaks too");
  command
      .add_option("--set", options->settings,
                  "one setting, query.a=b or approach.a=b; may be repeated")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_option("--threads", options->threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024));
  add_approach_options(command, options->approach);
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return query(*options); };
}

}  // namespace ovimap::apps
