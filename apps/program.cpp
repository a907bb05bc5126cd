// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

#include "apps/command/usage_fault.h"
#include "apps/mapping/calibrate.h"
#include "ovimap/base/version.h"

namespace ovimap::apps {

namespace {

struct CommandEntry {
  const char *name, *help;
  const char* example;  ///< arguments that work where `ovimap demo` was run
  Action (*add)(CLI::App&);
};

constexpr CommandEntry kCommands[] = {
    {"run", "map a recording: SOURCE in, MAP out", "run demo/tiny/room -o room.ovimap", add_run},
    {"check", "look for what commonly is wrong with a recording", "check demo/tiny/room",
     add_check},
    {"calibrate", "find where the colour camera is, from edges of depth and colour",
     "calibrate demo/tiny/room -o calibration.yaml", add_calibrate},
    {"info", "what a map holds", "info demo/tiny.ovimap", add_info},
    {"query", "find objects in words: MAP \"mug on the table\"",
     "query demo/tiny.ovimap \"sofa\" \"lamp on the table\" --top 3", add_query},
    {"export", "write a map as mesh, scene, table, grid, picture or folder of objects",
     "export demo/tiny.ovimap tiny.glb", add_export},
    {"edit", "correct a map: names, objects that are one, objects that are several",
     "edit demo/tiny.ovimap rename 3 \"tea table\"", add_edit},
    {"diff", "what changed from one map of a place to another",
     "diff monday.ovimap friday.ovimap -o changes.png", add_diff},
    {"merge", "make one map of two of the same place",
     "merge upstairs.ovimap downstairs.ovimap --align -o house.ovimap", add_merge},
    {"correct", "fuse a map's frames again, from corrected poses",
     "correct room.ovimap --poses better.txt", add_correct},
    {"eval", "score maps against the truth", "eval demo/tiny.ovimap --gt demo/tiny/room", add_eval},
    {"eval-changes", "score what a map of several visits says of what changed",
     "eval-changes home.ovimap rooms", add_eval_changes},
    {"eval-poses", "score the poses of a camera against true ones",
     "eval-poses tracked.txt demo/tiny/room", add_eval_poses},
    {"ablate", "vary one choice and score the maps, beside published figures",
     "ablate fusion demo/tiny/room --masks gt --frames ::8 -o tables", add_ablate},
    {"reproduce", "make the paper's tables from your own copy of its data", nullptr, add_reproduce},
    {"bench", "what this machine can do; with SOURCE, speed and memory on a recording", "bench",
     add_bench},
#ifdef OVIMAP_SYNTH
    {"demo", "show what ovimap does: render a small room, map it, find things in it", "demo",
     add_demo},
    {"synth", "render a furnished room with exact truth", "synth demo/tiny --room tiny", add_synth},
#endif
    {"reembed", "give a map's objects the embeddings of another encoder",
     "reembed demo/tiny.ovimap --encoder default", add_reembed},
    {"read", "read what is written on a map's objects, for query 'text:\"exit\"'",
     "read demo/tiny.ovimap", add_read},
    {"embed", "embeddings for a finished mesh with instance ids",
     "embed gt demo/tiny/room -o truth.ovimap", add_embed},
    {"report", "write a map as one HTML page: pictures, objects, timings",
     "report demo/tiny.ovimap report.html", add_report},
    {"masks", "write the 2D entities of frames, or score them against the truth",
     "masks demo/tiny/room --frames ::20 --score", add_masks},
    {"serve", "show a map in a browser, and to programs over HTTP", "serve demo/tiny.ovimap",
     add_serve},
    {"models", "list, fetch, verify and find networks", "models list", add_models},
    {"manual", "write man pages and completions for shells", "manual ~/.local/share", add_manual},
    {"config", "list every setting with its default", "config", add_config},
};

int complain(const char* message, int code) {
  warn(message);
  return code;
}

}  // namespace

Program::Program()
    : app_("ovimap: turns posed RGB-D frames into a 3D map of separate objects", "ovimap") {
  app_.set_version_flag("--version", concat("ovimap ", version(), " (", commit(), ")"));
  app_.require_subcommand(1);
  for (const CommandEntry& entry : kCommands) {
    CLI::App* command = app_.add_subcommand(entry.name, entry.help);
    actions_[command] = entry.add(*command);
    if (command->get_footer().empty())
      command->footer(concat("Example:\n  ovimap ", entry.example));
  }
}

int Program::run(std::vector<std::string> arguments) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told as a full disk is
  try {
    app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    const int code = actions_.at(app_.get_subcommands().front())();
    std::cout.flush();
    if (std::fflush(stdout) != 0 || !std::cout)
      return complain("cannot write to standard output; is the disk full?", kUserCanMend);
    return code;
  } catch (const CLI::Success& success) {
    return app_.exit(success);  // --help and --version
  } catch (const CLI::ParseError& error) {
    return complain(usage_fault(app_, error, arguments).c_str(), kUserCanMend);
  } catch (const Error& error) {
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

}  // namespace ovimap::apps
