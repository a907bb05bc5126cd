// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "same_settings.h"

#include <algorithm>
#include <sstream>

#include "ovimap/base/config.h"

namespace ovimap::apps {

namespace {

/// The lines of a configuration that decide what the map becomes: which frames it is made from, and
/// when and where it is kept, may differ. The encoder may have changed since
/// (require_same_encoder).
std::vector<std::string> deciding_lines(const std::string& config) {
  std::vector<std::string> lines;
  std::istringstream stream(config);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("# preset")) line.resize(std::min(line.size(), line.find(", encoder ")));
    const auto names = [&](const char* start) { return line.starts_with(start); };
    if (!names("checkpoint.") && !names("memory.") && !names("visit.") && !names("# live"))
      lines.push_back(line);
  }
  return lines;
}

/// "kind:last/part" of a source: the same recording may be named from elsewhere.
std::string short_source(const std::string& source) {
  const std::size_t kind = source.find(':');
  const std::filesystem::path place = source.substr(kind == std::string::npos ? 0 : kind + 1);
  const std::filesystem::path last = place.has_filename() ? place : place.parent_path();
  return source.substr(0, kind) + ":" + last.filename().string();
}

}  // namespace

void require_same_source(const MapDocument& begun, const std::string& source) {
  const auto& visits = begun.history.visits;
  const std::string& before = visits.empty() ? begun.source : visits.back().source;
  if (before.empty() || short_source(before) == short_source(source)) return;
  throw Error(concat("the run to go on with maps '", before, "', and this recording is '", source,
                     "'; --resume goes on with the same one, --continue with the same place"));
}

void require_same_settings(const std::string& begun, const std::string& now, const char* option) {
  const std::vector<std::string> before = deciding_lines(begun), after = deciding_lines(now);
  const auto [old_line, new_line] =
      std::mismatch(before.begin(), before.end(), after.begin(), after.end());
  if (old_line == before.end() && new_line == after.end()) return;
  throw Error(concat("the run to go on with had '", old_line == before.end() ? "" : *old_line,
                     "', this one has '", new_line == after.end() ? "" : *new_line,
                     "'; give the same options, or map anew without ", option));
}

void require_same_encoder(const EncoderIdentity& begun,
                          const std::shared_ptr<ImageTextEncoder>& encoder) {
  const std::string now = encoder ? encoder->identity().name : "";
  if (begun.name == now) return;
  if (begun.name.empty())
    throw Error(concat("the map's objects have no embeddings, and this run has the encoder '", now,
                       "'; give --encoder none, or embed the map first with `ovimap reembed`"));
  throw Error(
      concat("the map's objects are embedded by '", begun.name, "', and this run has ",
             now.empty() ? "no encoder" : concat("'", now, "'"),
             "; give that model to --encoder (`ovimap models list` names what is here; the "
             "built-in one is `--encoder default`), or embed the map anew with `ovimap reembed`"));
}

void require_same_map(const MapDocument& begun, const VoxelMapConfig& map,
                      const std::shared_ptr<ImageTextEncoder>& encoder) {
  const auto lines = [](VoxelMapConfig config) {
    ConfigFields fields;
    fields.group("map", [&](ConfigFields& group) { list_fields(config, group); });
    return fields.dump();
  };
  require_same_settings(lines(begun.map.config()), lines(map), "--continue");
  if (!begun.semantics.encoder.name.empty()) require_same_encoder(begun.semantics.encoder, encoder);
}

}  // namespace ovimap::apps
