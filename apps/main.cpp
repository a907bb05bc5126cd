// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>

#include "calibrate.h"
#include "command.h"
#include "ovimap/base/version.h"
#include "usage_fault.h"

namespace {

using namespace ovimap::apps;

struct Entry {
  const char* name;
  const char* help;
  Action (*add)(CLI::App&);
};

constexpr Entry kCommands[] = {
    {"run", "map a recording: SOURCE in, MAP out", add_run},
    {"check", "look for what commonly is wrong with a recording", add_check},
    {"calibrate", "find where the colour camera is, from edges of depth and colour", add_calibrate},
    {"info", "what a map holds", add_info},
    {"query", "find objects in words: MAP \"mug on the table\"", add_query},
    {"export", "write a map as mesh, scene, table, grid, picture or folder of objects", add_export},
    {"edit", "correct a map: names, objects that are one, objects that are several", add_edit},
    {"diff", "what changed from one map of a place to another", add_diff},
    {"merge", "make one map of two of the same place", add_merge},
    {"correct", "fuse a map's frames again, from corrected poses", add_correct},
    {"eval", "score maps against the truth", add_eval},
    {"eval-poses", "score the poses of a camera against true ones", add_eval_poses},
    {"ablate", "vary one choice and score the maps, beside published figures", add_ablate},
    {"reproduce", "make the paper's tables from your own copy of its data", add_reproduce},
    {"bench", "measure speed and memory on a recording", add_bench},
#ifdef OVIMAP_SYNTH
    {"synth", "render a furnished room with exact truth", add_synth},
#endif
    {"reembed", "give a map's objects the embeddings of another encoder", add_reembed},
    {"embed", "embeddings for a finished mesh with instance ids", add_embed},
    {"report", "write a map as one HTML page: pictures, objects, timings", add_report},
    {"masks", "write the 2D entities of frames, or score them against the truth", add_masks},
    {"serve", "show a map in a browser, and to programs over HTTP", add_serve},
    {"models", "list, verify and find networks", add_models},
    {"config", "list every setting with its default", add_config},
};

int complain(const char* message, int code) {
  std::fprintf(stderr, "ovimap: %s\n", message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"ovimap: turns posed RGB-D frames into a 3D map of separate objects", "ovimap"};
  app.set_version_flag("--version",
                       std::string("ovimap ") + ovimap::version() + " (" + ovimap::commit() + ")");
  app.require_subcommand(1);
  std::map<const CLI::App*, Action> actions;
  for (const Entry& entry : kCommands) {
    CLI::App* command = app.add_subcommand(entry.name, entry.help);
    actions[command] = entry.add(*command);
  }
  try {
    app.parse(argc, argv);
    const int code = actions.at(app.get_subcommands().front())();
    std::cout.flush();
    if (std::fflush(stdout) != 0 || !std::cout)
      return complain("cannot write to standard output; is the disk full?", kUserCanMend);
    return code;
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help and --version
  } catch (const CLI::ParseError& error) {
    return complain(usage_fault(app, error, {argv + 1, argv + argc}).c_str(), kUserCanMend);
  } catch (const ovimap::Error& error) {
    return complain(error.what(), kUserCanMend);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(error.what(), kUserCanMend);
  } catch (const std::bad_alloc&) {
    return complain(
        "out of memory; use larger voxels (--set map.voxel_size_m=0.02) or fewer frames",
        kUserCanMend);
  } catch (const std::exception& error) {
    return complain((std::string("internal defect: ") + error.what()).c_str(), kDefect);
  }
}
