// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "ovimap/base/error.h"
#include "ovimap/semantics/classes/name_search.h"
#include "saved_map.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

using Relevance = nb::ndarray<nb::numpy, const float, nb::ndim<1>>;

QueryAnswer query(SavedMap& map, const std::string& text, const std::vector<std::string>& negatives,
                  bool relevance, const std::string& at, const std::string& since) {
  const auto past = map.past_of(text, at, since);
  if (past) return map.ask_past(*past, {text, negatives, relevance});
  if (map.index().embedded() == 0) {
    QueryAnswer named = find_by_name(map.index(), {text, negatives, relevance});
    if (named.verdict == Verdict::kFound) return named;
  }
  return map.engine(true).find({text, negatives, relevance});
}

nb::object row_of(const QueryMatch& match) {
  return match.position == SavedMap::kGone ? nb::none() : nb::cast(match.position);
}

QueryAnswer query_like(SavedMap& map, const nb::object& what, bool relevance) {
  if (const auto number = read_integer(what)) {
    if (*number < 0 || *number > ~InstanceId{0})
      throw Error(
          concat("the map has no object ", *number, "; Map.instances.ids has those it has"));
    const auto id = static_cast<InstanceId>(*number);
    const WithoutGil release;
    return map.engine(false).find_like(id, relevance);
  }
  const RgbImage image = read_color(what, "picture");
  const WithoutGil release;
  return map.engine(true).find_like(image, "picture", relevance);
}

void bind_answers(nb::module_& module) {
  nb::class_<QueryMatch>(module, "QueryMatch", "An object that matches, more or less.")
      .def_ro("id", &QueryMatch::id, "of the object")
      .def_prop_ro("row", &row_of, nb::sig("def row(self) -> int | None"),
                   "its row in Map.instances and Map.embeddings; None: it is gone")
      .def_ro("score", &QueryMatch::score, "cosine")
      .def_ro("standard_score", &QueryMatch::standard_score,
              "standard deviations above unrelated things")
      .def_ro("p_value", &QueryMatch::p_value,
              "chance that an absent thing's best object scores as high")
      .def_ro("probability", &QueryMatch::probability, "that it is what was asked for")
      .def_ro("evidence", &QueryMatch::evidence, "why a relation holds")
      .def_ro("part", &QueryMatch::part,
              "number of the object's part, where one was asked for; 0: all of it")
      .def("__repr__", [](const QueryMatch& match) {
        return concat("QueryMatch(id=", match.id, ", score=", match.score, ")");
      });
  nb::class_<QueryAnswer>(module, "QueryAnswer", "What a map says to a question.")
      .def_ro("query", &QueryAnswer::query)
      .def_prop_ro(
          "found", [](const QueryAnswer& answer) { return answer.verdict == Verdict::kFound; },
          "False: it is not in the map; matches are then what comes nearest")
      .def_ro("matches", &QueryAnswer::matches, "best first")
      .def_ro("reading", &QueryAnswer::reading, "how a phrase was understood: \"[mug] on [table]\"")
      .def_ro("reason", &QueryAnswer::reason, "why a phrase was not found")
      .def_prop_ro(
          "count",
          [](const QueryAnswer& answer) {
            return answer.count ? std::optional(answer.count->found) : std::nullopt;
          },
          "of \"how many\" and \"two ...\": of how many objects it is true; None otherwise")
      .def_prop_ro(
          "expected_count",
          [](const QueryAnswer& answer) {
            return answer.count
                       ? std::optional(std::pair(answer.count->expected, answer.count->deviation))
                       : std::nullopt;
          },
          "likewise: the sum of all objects' chances and its standard deviation")
      .def_prop_ro(
          "relevance",
          [](const QueryAnswer& answer) {
            return view<Relevance>(answer.relevance.data(),
                                   {static_cast<std::size_t>(answer.relevance.size())},
                                   nb::find(answer));
          },
          "float32 [objects] in [0, 1]; empty unless asked for")
      .def("__repr__", [](const QueryAnswer& answer) {
        return concat("QueryAnswer('", answer.query, "', ",
                      answer.verdict == Verdict::kFound ? "found" : "not in the map", ", ",
                      answer.matches.size(), " matches)");
      });
}

}  // namespace

void bind_query(nb::module_& module, nb::class_<SavedMap>& map) {
  bind_answers(module);
  map.def("query", &query, nb::arg("text"), nb::kw_only(),
          nb::arg("negatives") = std::vector<std::string>(), nb::arg("relevance") = false,
          nb::arg("at") = "", nb::arg("since") = "", nb::call_guard<WithoutGil>(),
          "Asks in words: \"mug\", \"red chair, armchair\", \"mug on the table\" (docs/query.md). "
          "negatives: what it must not be. relevance: rate every object. at, since: the map as it "
          "was, "
          "and only what changed: \"visit 1\", \"2026-03-14\", \"yesterday\". The first question "
          "opens "
          "the encoder. Raises Error for an empty text or a map without embeddings.")
      .def("query_like", &query_like, nb::arg("what"), nb::kw_only(), nb::arg("relevance") = false,
           nb::sig("def query_like(self, what: typing.Any, *, relevance: bool = False) -> "
                   "QueryAnswer"),
           "Objects that look like the object with that id, or like a picture, uint8 [height, "
           "width, 3].");
}

}  // namespace ovimap::python
