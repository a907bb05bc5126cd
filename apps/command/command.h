// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/inference/mask_source_factory.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/live/live_mapper.h"
#include "ovimap/pipeline/mapping/checkpointer.h"
#include "ovimap/pipeline/people/people_config.h"
#include "ovimap/pipeline/sequence/visit_fit.h"
#include "ovimap/track/graph/loop_closure.h"

namespace ovimap {
class PeopleFilter;
}

namespace ovimap::apps {

enum ExitCode { kDone = 0, kAnswerIsNo = 1, kUserCanMend = 2, kDefect = 3 };

/// What a subcommand does once its options are read; returns an exit code.
using Action = std::function<int()>;

// Each adds its options to its subcommand and returns what to do.
Action add_run(CLI::App& command);
Action add_check(CLI::App& command);
Action add_info(CLI::App& command);
Action add_query(CLI::App& command);
Action add_edit(CLI::App& command);
Action add_diff(CLI::App& command);
Action add_merge(CLI::App& command);
Action add_export(CLI::App& command);
Action add_correct(CLI::App& command);
Action add_eval(CLI::App& command);
Action add_eval_changes(CLI::App& command);
Action add_eval_poses(CLI::App& command);
Action add_bench(CLI::App& command);
Action add_synth(CLI::App& command);
Action add_report(CLI::App& command);
Action add_masks(CLI::App& command);
Action add_models(CLI::App& command);
Action add_reembed(CLI::App& command);
Action add_read(CLI::App& command);
Action add_embed(CLI::App& command);
Action add_ablate(CLI::App& command);
Action add_reproduce(CLI::App& command);
Action add_serve(CLI::App& command);
Action add_config(CLI::App& command);
Action add_demo(CLI::App& command);
Action add_manual(CLI::App& command);

/// Options that several commands share.
struct MappingOptions {
  std::string source;
  std::string masks = "none";
  std::string encoder = "auto";
  std::string recognizer = "auto";
  std::string preset = "default";
  std::string views;  ///< view_preset; empty: as the preset has them
  std::filesystem::path config_file;
  std::vector<std::string> settings;  ///< "a.b=c"
  std::vector<std::filesystem::path> model_dirs;
  std::string frames = ":";          ///< "A:B:STEP"
  std::string poses = "given";       ///< given, track, refine, or auto: given where there are any
  std::string max_memory;            ///< "300M"; empty: as the settings say
  std::optional<double> recorded_s;  ///< when the recording was made, seconds since 1970 (UTC)
  int threads = 0;
};
void add_mapping_options(CLI::App& command, MappingOptions& options);
/// The same without the recording.
void add_mapping_settings(CLI::App& command, MappingOptions& options);

/// --poses, with "auto" where it is not given.
void add_poses(CLI::App& command, MappingOptions& options);

/// --max-memory, which is memory.max_mb in units of its own.
void add_max_memory(CLI::App& command, MappingOptions& options);

/// Everything that --preset, --config and --set can set.
struct ProgramConfig {
  MapperConfig mapper;
  FrameSourceConfig source;
  TrackConfig track;
  LoopConfig loops;
  VisitFitConfig visit;
  PeopleConfig people;
  MaskSourceConfig masks;
  RuntimeConfig encoder;
  LiveConfig live;
  CheckpointConfig checkpoint;
  MemoryConfig memory;
};
void list_fields(ProgramConfig& config, ConfigFields& fields);

/// Sets what --set named, "a.b=c" each. Throws Error for what is unknown.
void apply_settings(const std::vector<std::string>& settings, ConfigFields& fields);

/// Preset, then file, then settings. Throws Error for what is unknown.
ProgramConfig read_program_config(const MappingOptions& options);

/// The encoder that --encoder names; "auto" is the best installed one where there are 2D masks.
/// Null: none.
std::shared_ptr<ImageTextEncoder> make_encoder(const MappingOptions& options,
                                               const ProgramConfig& config);

/// What --recognizer names; "auto" is every installed one where there is an encoder. Null: none.
std::shared_ptr<const ThingRecognizer> make_recognizer(const MappingOptions& options,
                                                       const ProgramConfig& config, bool encoder);

/// What takes people out of frames; null: nothing does. Throws Error when no detector is there that
/// knows people.
std::shared_ptr<const PeopleFilter> make_people_filter(const MappingOptions& options,
                                                       const ProgramConfig& config);

/// Threads of a network run: what the config says, else what --threads says.
int network_threads(const ProgramConfig& config, const MappingOptions& options);

/// --frames, for parse_frame_range.
void add_frame_range(CLI::App& command, std::string& frames);

/// Options of which each takes one value, so that what follows is not swallowed.
CLI::Option* one_value(CLI::Option* option);
void add_model_dirs(CLI::App& command, std::vector<std::filesystem::path>& model_dirs);

/// Views that an encoder was asked about; 0 without one.
int embedding_queries(const SemanticRecord& semantics);

/// One line on stderr, rewritten as work goes on; silent when stderr is no terminal.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  void show(std::size_t done, std::size_t total, const std::string& detail = {});

 private:
  std::string what_;
  bool terminal_;
  bool shown_ = false;
};

/// Tells the user one thing on stderr. Texts of files and cameras may be in it: a terminal obeys
/// none of it, and what is very long is cut off.
void warn(std::string_view text);

/// As text; what is not UTF-8 in it becomes the replacement character.
std::string json_text(const nlohmann::json& value);
/// Prints the one JSON object of a --json run.
void print_json(const nlohmann::json& value);
nlohmann::json stages_json(const StageTimers& timers);
/// Tiles that a bound on memory made leave it, and that came back, while frames were mapped.
struct TileTraffic {
  std::size_t evicted = 0, loaded = 0;
};
TileTraffic tile_traffic(const std::map<std::string, StageSummary>& stages);
/// Of all threads, in the program and in the system.
double cpu_seconds();
double peak_rss_mb();

/// Takes Ctrl-C, so many times, and SIGTERM, which counts as often; one more ends the program.
void watch_for_interrupt(int taken = 1);
/// True once the user pressed Ctrl-C.
bool interrupted();
/// ... and once more.
bool interrupted_again();

}  // namespace ovimap::apps
