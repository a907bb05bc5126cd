// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The program as a user meets it: what it writes, prints and returns.
#include "program_fixture.h"

namespace ovimap {
namespace {

TEST_F(ProgramTest, MapsARecordingAndTellsWhatIsInIt) {
  const auto run_report = run_json("run recording -o room.ovimap --json");
  EXPECT_EQ(run_report["frames"], sequence_.frames);
  EXPECT_EQ(run_report["frames_skipped"], 0);
  EXPECT_GT(run_report["instances"], 0);
  EXPECT_GT(run_report["stages"]["integrate"]["p50_ms"], 0.0);
  EXPECT_GT(run_report["peak_rss_mb"], 0.0);

  const auto info = run_json("info room.ovimap --json");
  EXPECT_EQ(info["frames"], sequence_.frames);
  EXPECT_EQ(info["instances"].size(), run_report["instances"]);
  EXPECT_NEAR(info["voxel_size_m"].get<double>(), 0.01, 1e-9);
  for (const auto& instance : info["instances"]) {
    EXPECT_GT(instance["points"], 0);
    EXPECT_LE(instance["box"]["min"][0], instance["box"]["max"][0]);
  }
}

TEST_F(ProgramTest, SameMapForEveryRunAndThreadCount) {
  std::set<std::string> hashes, objects;
  for (const char* options : {"--threads 1", "--threads 2", "--threads 2"}) {
    run(std::string("run replica/scene --masks gt -o room.ovimap ") + options);
    const auto info = run_json("info room.ovimap --json");
    hashes.insert(info["content_hash"].get<std::string>());
    objects.insert(info["instances"].dump());
  }
  EXPECT_EQ(hashes.size(), 1u);
  EXPECT_EQ(objects.size(), 1u);
}

TEST_F(ProgramTest, MapsAtACamerasPace) {
  const auto report =
      run_json("run replica/scene --masks gt --live --fps 60 -o live.ovimap --json");
  const auto& live = report["live"];
  EXPECT_EQ(live["camera_fps"], 60);
  EXPECT_EQ(live["frames_fused"].get<int>() + live["frames_dropped"].get<int>(), sequence_.frames);
  EXPECT_GT(live["geometry_lag"]["p50_ms"], 0.0);
  EXPECT_EQ(report["frames"], live["frames_fused"]);
  EXPECT_GE(report["mask_frames"], 1);
  EXPECT_EQ(run_json("info live.ovimap --json")["frames"], live["frames_fused"]);

  const std::string again = "run replica/scene --masks gt --repeat live.ovimap -o again.ovimap ";
  const ProgramResult same = run(again);
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_NE(same.out.find("the same map as live.ovimap"), std::string::npos) << same.out;
  expect_complaint(again + "--set map.voxel_size_m=0.03", {"voxel_size_m", "--repeat"});
  ASSERT_EQ(run("run replica/scene --masks gt -o plain.ovimap").code, 0);
  expect_complaint("run replica/scene --masks gt --repeat plain.ovimap -o again.ovimap",
                   {"cannot be made again", "live run"});
}

TEST_F(ProgramTest, TruthMasksGiveTheTrueObjects) {
  ASSERT_EQ(
      run("run replica/scene --masks gt -o room.ovimap --set summary.min_instance_views=1").code,
      0);
  EXPECT_GE(run_json("info room.ovimap --json")["instances"].size(), 3u);
}

TEST_F(ProgramTest, WritesAndScoresEntities) {
  const nlohmann::json truth = run_json("masks replica/scene --masks gt -o truth --score --json");
  EXPECT_EQ(truth["standard"]["miou"], 1.0);
  EXPECT_EQ(truth["standard"]["ap"], 1.0);
  EXPECT_GT(truth["standard"]["truth_entities"], truth["frames"]);
  // What was written serves as masks, and is neither better nor worse.
  const nlohmann::json kept = run_json("masks replica/scene --masks truth --score --json");
  EXPECT_EQ(kept["standard"], truth["standard"]);
  EXPECT_EQ(
      run_json("run replica/scene --masks truth --encoder none -o a.ovimap --json")["instances"],
      run_json("run replica/scene --masks gt --encoder none -o b.ovimap --json")["instances"]);
  expect_complaint("masks replica/scene", {"-o FOLDER", "--score"});
  expect_complaint("masks replica/scene --score --masks none", {"--masks none", "sam"});
  expect_complaint("masks recording --score --masks truth", {"instance images"});
}

TEST_F(ProgramTest, ATerminalObeysNothingThatAFileSays) {
  std::filesystem::create_directory(path("tum"));
  const auto complaint_of = [&](const std::string& line) {
    std::ofstream(path("tum/depth.txt")) << line << "\n";
    std::ofstream(path("tum/rgb.txt")) << line << "\n";
    const ProgramResult result = run("run tum -o tum.ovimap");
    EXPECT_EQ(result.code, 2);
    return result.err;
  };
  const std::string title = complaint_of("abc\x1b]0;title\x07");
  EXPECT_EQ(title.find_first_of("\x1b\x07"), std::string::npos) << title;
  EXPECT_NE(title.find("abc\xEF\xBF\xBD]0;title\xEF\xBF\xBD'"), std::string::npos) << title;
  EXPECT_LT(complaint_of(std::string(1 << 20, 'x')).size(), 5000u);
}

TEST_F(ProgramTest, SaysHowManyFramesHadMasks) {
  ASSERT_EQ(run("masks replica/scene --masks gt -o some").code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(path("some")))
    if (entry.path().filename() != "0.png") std::filesystem::remove(entry.path());
  const ProgramResult one = run("run replica/scene --masks some --encoder none -o room.ovimap");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_NE(one.out.find("(1 with masks)"), std::string::npos) << one.out;
  EXPECT_EQ(one.err.find("had masks"), std::string::npos) << one.err;
  const ProgramResult none =
      run("run replica/scene --masks some --encoder none --frames 1: -o none.ovimap");
  EXPECT_EQ(none.code, 0) << none.err;
  EXPECT_NE(none.err.find(concat("none of the ", sequence_.frames - 1, " frames had masks")),
            std::string::npos)
      << none.err;
  const nlohmann::json found = run_json("masks replica/scene --masks some --score --json");
  EXPECT_EQ(found["frames"], 1);
  EXPECT_EQ(found["frames_without_masks"], sequence_.frames - 1);
  EXPECT_EQ(found["standard"]["miou"], 1.0) << "frames without masks have no score";
  expect_complaint("masks replica/scene --masks some --frames 1: --score",
                   {"none of the", "frames has masks", "--masks"});
  std::filesystem::rename(path("some/0.png"), path("some/77777.png"));
  expect_complaint("run replica/scene --masks some -o other.ovimap", {"no file for any of the"});
}

TEST_F(ProgramTest, ReferencePresetChoosesItsOwnViews) {
  const auto expect_views = [&](const std::string& options, const std::string& strategy) {
    EXPECT_EQ(run("run replica/scene --preset reference -o room.ovimap " + options).code, 0);
    const std::string config = run_json("info room.ovimap --json")["config"];
    EXPECT_NE(config.find("views.strategy: " + strategy + "\n"), std::string::npos) << config;
    EXPECT_NE(config.find("mask_motion: 0\n"), std::string::npos) << config;
  };
  expect_views("", "combine");
  expect_views("--views viewcov", "coverage");
  expect_views("--set views.strategy=all", "all");
}

TEST_F(ProgramTest, ExportsMeshObjectsAndPicture) {
  ASSERT_EQ(run("run recording -o room.ovimap --pictures pictures").code, 0);
  for (const char* file : {"a.ply", "a.json", "a.png"}) {
    EXPECT_EQ(run(std::string("export room.ovimap ") + file + " --what instances").code, 0);
    EXPECT_GT(std::filesystem::file_size(path(file)), 100u) << file;
  }
  EXPECT_EQ(slurp(path("a.ply")).substr(0, 3), "ply");
  for (const char* file : {"top_view.png", "contact_sheet.png"})
    EXPECT_TRUE(std::filesystem::exists(path("pictures") / file));
}

TEST_F(ProgramTest, ReportsOnAMap) {
  ASSERT_EQ(run("run replica/scene --masks gt --encoder none -o room.ovimap "
                "--set summary.min_instance_views=1")
                .code,
            0);
  const auto report = run_json("report room.ovimap room.html --title 'My <room>' --json");
  EXPECT_EQ(report["named"], 0);
  const std::string html = slurp(path("room.html"));
  EXPECT_EQ(report["bytes"], html.size());
  const auto objects = run_json("info room.ovimap --json")["instances"];
  for (const auto& instance : objects)
    EXPECT_NE(html.find("id=\"object-" + instance["id"].dump() + "\""), std::string::npos);
  for (const char* text : {"My &lt;room&gt;", "data:image/png", "this map has no embeddings",
                           "<th scope=\"row\">integrate</th>", "map.voxel_size_m: 0.01"})
    EXPECT_NE(html.find(text), std::string::npos) << text;

  expect_complaint("report room.ovimap room.pdf", {"room.pdf", ".html"});
  expect_complaint("report missing.ovimap a.html", {"missing.ovimap"});
  expect_complaint("report room.ovimap nowhere/a.html", {"nowhere/a.html"});
  expect_complaint("report room.ovimap a.html --classes birds", {"birds", "scannet200"});
  EXPECT_FALSE(std::filesystem::exists(path("a.html")));
}

TEST_F(ProgramTest, TheReferencePresetMapsToo) {
  EXPECT_GT(run_json("run recording -o room.ovimap --preset reference --json")["instances"], 0);
}

TEST_F(ProgramTest, SkipsAndCountsBadFrames) {
  write_file(path("recording/frame-000002.depth.png"), Bytes{1, 2, 3});
  write_text(path("recording/frame-000003.pose.txt"), "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  const ProgramResult result = run("run recording -o room.ovimap --json");
  EXPECT_EQ(nlohmann::json::parse(result.out)["frames_skipped"], 2);
  EXPECT_NE(result.err.find("frame-000002"), std::string::npos);
}

TEST_F(ProgramTest, ChecksRecordings) {
  EXPECT_EQ(run("check recording").code, 0);
  EXPECT_EQ(run_json("check recording --frames 1:5:2 --json")["frames"], 2);
  expect_complaint("check recording --frames 500:", {"the chosen range holds none"});
  sequence_.stored_pose = [](const Pose& pose) { return pose.inverse().matrix(); };
  sequence_.frames = 40;
  std::filesystem::create_directories(path("inverted"));
  fixture::write_seven_scenes(path("inverted"), sequence_);
  const ProgramResult result = run("check inverted");
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.out.find("verdict: fault"), std::string::npos);
}

TEST_F(ProgramTest, CalibratesOnlyWhatTells) {
  expect_complaint("calibrate recording", {"calibration.yaml exists", "--force", "-o"});
  const std::string before = slurp(path("recording/calibration.yaml"));
  const ProgramResult result = run("calibrate recording --force --json");
  EXPECT_EQ(result.code, 1) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["verdict"], "refused");
  EXPECT_NE(report["message"].get<std::string>().find("are needed"), std::string::npos);
  EXPECT_TRUE(report["written"].is_null());
  EXPECT_EQ(slurp(path("recording/calibration.yaml")), before);
  expect_complaint("calibrate recording -o nowhere/a.yaml", {"nowhere"});
  expect_complaint("calibrate missing", {"missing", "does not exist"});
}

TEST_F(ProgramTest, SaysWhatIsWrongWithTheCommandLine) {
  expect_complaint("", {"say what to do", "run, check", "--help"});
  expect_complaint("qurey room.ovimap mug", {"qurey", "'query'"});
  expect_complaint("run recording --mask sam -o a.ovimap", {"'--mask'", "'--masks'"});
  expect_complaint("fly", {"there is no command 'fly'; `ovimap --help`"});
  expect_complaint("run recording --jsno -o a.ovimap", {"'--jsno'", "did you mean '--json'"});
  expect_complaint("run recording --max-mem 1G -o a.ovimap", {"did you mean '--max-memory'"});
  expect_complaint("check recording --weather fine",
                   {"'--weather' is no option of check; `ovimap check --help` lists them"});
  expect_complaint("run recording a.ovimap",
                   {"'a.ovimap' is one argument too many", "-o a.ovimap"});
  expect_complaint("edit room.ovimap rename 1 tea pot",
                   {"'pot' is one argument too many", "quotes"});
  expect_complaint("query room.ovimap --like foo", {"--like = foo is no number"});
  expect_complaint("rnu recording", {"did you mean 'run'?"});
  expect_complaint("edit room.ovimap renam 1 cup", {"'renam'", "edit", "did you mean 'rename'"});
  expect_complaint("models verfy x", {"'verfy'", "did you mean 'verify'"});
  expect_complaint("models", {"say what models is to do: list, fetch, try, hub, verify, path;"});
  expect_complaint("edit room.ovimap", {"say what edit is to do: rename, merge"});
  expect_complaint("--versoin", {"did you mean '--version'"});
  expect_complaint("run recording", {"-o", "--continue"});
  expect_complaint("run recording -o a.ovimap --set map.voxel=1", {"map.voxel_size_m"});
  expect_complaint("run recording -o a.ovimap --set map.voxel_size_m=-1", {"0.001 to 1"});
  expect_complaint("run recording -o a.ovimap --config .", {"is a folder"});
  expect_complaint("run recording -o a.ovimap --preset best", {"default or reference"});
  expect_complaint("run recording -o a.ovimap --masks nothing_such", {"nothing_such"});
  expect_complaint("run recording -o a.ovimap --masks gt", {"gt"});
  expect_complaint("run recording -o a.ovimap --frames a:b", {"a:b"});
  expect_complaint("run recording -o a.ovimap --fps 20", {"--fps", "--live"});
  expect_complaint("bench --frames 200:", {"--frames", "none of the 90"});
  EXPECT_EQ(run("--help").code, 0);
}

TEST_F(ProgramTest, SaysWhatTheMachineCanDo) {
  std::filesystem::create_directories(path("tmp"));
  ::setenv("TMPDIR", path("tmp").c_str(), 1);
  const auto machine =
      run_json("bench --frames :9 --masks gt --encoder " + golden_model("minilm") + " --json");
  const ProgramResult told = run("bench --frames :4 --masks gt --encoder none");
  ::unsetenv("TMPDIR");
  EXPECT_EQ(machine["frames"], 9);
  ASSERT_EQ(machine["paces"].size(), 3u);
  EXPECT_EQ(machine["paces"][1]["voxel_size_m"], 0.02f);
  EXPECT_EQ(machine["paces"][2]["poses"], "track");
  for (const auto& pace : machine["paces"]) {
    EXPECT_GT(pace["fps"], 0);
    EXPECT_GT(pace["cores_busy"], 0.1);
  }
  EXPECT_EQ(machine["masks"]["model"], "gt");
  EXPECT_GT(machine["words"]["seconds"], 0);
  EXPECT_EQ(told.code, 0) << told.err;
  for (const char* words : {"depth alone, 1 cm", "masks     gt takes", "limit     ", "next      "})
    EXPECT_TRUE(told.out.find(words) != std::string::npos) << words << " in\n" << told.out;
  for (const auto& left : std::filesystem::directory_iterator(path("tmp")))
    EXPECT_FALSE(left.is_directory()) << "what was rendered is left: " << left.path();
}

TEST_F(ProgramTest, MeasuresWhatATenthOfACorridorCosts) {
  const auto walk = run_json("bench --corridor 40 --masks gt --json");
  ASSERT_EQ(walk["parts"].size(), 10u);
  EXPECT_EQ(walk["parts"][9]["frames"], 40);
  EXPECT_GT(walk["parts"][9]["objects"], walk["parts"][0]["objects"]);
  EXPECT_GT(walk["parts"][9]["blocks_touched"], 0);
  EXPECT_GT(walk["parts"][9]["stages"]["registry"]["total_ms"], 0);
  EXPECT_EQ(walk["parts"][9]["frames_lost"], 0);
  EXPECT_EQ(walk["old"]["frames"], walk["young"]["frames"]);
  EXPECT_GT(walk["old"]["map_mb"], walk["young"]["map_mb"]);
  EXPECT_GT(walk["growth"], 0);
  const auto twice = run_json("bench --corridor 20 --masks gt --again --json");
  ASSERT_EQ(twice["again"]["parts"].size(), 10u);
  const double before = twice["parts"][9]["surface_m2"],
               after = twice["again"]["parts"][9]["surface_m2"];
  EXPECT_NEAR(after, before, 0.05 * before) << "nothing is new the second time";
  expect_complaint("bench recording --again", {"--again", "--corridor"});
  EXPECT_EQ(run_json("bench --corridor 20 --track --max-memory 16M --json")["parts"].size(), 10u);
}

TEST_F(ProgramTest, SaysWhatIsWrongWithTheRecording) {
  std::filesystem::create_directories(path("empty"));
  expect_complaint("run nowhere -o a.ovimap", {"nowhere"});
  expect_complaint("run empty -o a.ovimap", {"empty"});
  expect_complaint("run replica -o a.ovimap", {"'replica/scene' in it is a recording; give that"});
  for (int i = 0; i < sequence_.frames; ++i)
    write_file(path("recording/frame-" + fixture::padded(i, 6) + ".depth.png"),
               encode_png(Image<std::uint16_t>(80, 60)));
  expect_complaint("run recording -o a.ovimap", {"none of the", "depth"});
  EXPECT_FALSE(std::filesystem::exists(path("a.ovimap")));
}

TEST_F(ProgramTest, RefusesPosesThatNeverChangeUnlessTold) {
  for (int i = 0; i < sequence_.frames; ++i)
    write_text(path("recording/frame-" + fixture::padded(i, 6) + ".pose.txt"),
               "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  expect_complaint("run recording -o a.ovimap", {"same pose", "allow_still_camera"});
  EXPECT_EQ(run("run recording -o a.ovimap --set allow_still_camera=true").code, 0);
}

TEST_F(ProgramTest, SaysWhatIsWrongWithTheMap) {
  write_text(path("text.ovimap"), "not a database at all");
  expect_complaint("info text.ovimap", {"text.ovimap"});
  expect_complaint("info missing.ovimap", {"missing.ovimap"});
  expect_complaint("info recording", {"recording"});
  expect_complaint("export text.ovimap a.ply", {"text.ovimap"});
  ASSERT_EQ(run("run recording -o room.ovimap").code, 0);
  expect_complaint("export room.ovimap a.xyz", {".ply"});
  expect_complaint("eval room.ovimap --gt replica/scene", {"scene_mesh.ply"});
}

TEST_F(ProgramTest, AFailedRunLeavesTheOldMapAndNothingElse) {
  ASSERT_EQ(run("run recording -o room.ovimap").code, 0);
  const std::string before = slurp(path("room.ovimap"));
  const std::size_t files = file_count();
  expect_complaint("run recording -o room.ovimap --frames 500:600", {"frame"});
  expect_complaint("run recording -o nowhere/room.ovimap", {"nowhere"});
  EXPECT_EQ(slurp(path("room.ovimap")), before);
  EXPECT_EQ(file_count(), files);
}

TEST_F(ProgramTest, AFullDiskLeavesTheOldMap) {
  ASSERT_EQ(run("run recording -o room.ovimap").code, 0);
  const std::string before = slurp(path("room.ovimap"));
  // A limit on file size stands in for the full disk: writes fail the same way, part of the way
  // through.
  const ProgramResult result =
      run("run recording -o other.ovimap; (ulimit -f 40; trap '' XFSZ; '" OVIMAP_PROGRAM
          "' run recording -o room.ovimap)");
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_EQ(slurp(path("room.ovimap")), before);
}

TEST_F(ProgramTest, KeepsStdoutForTheJsonObject) {
  for (const char* command : {"run recording -o room.ovimap --json", "info room.ovimap --json",
                              "check recording --json", "models list --json"}) {
    const ProgramResult result = run(command);
    EXPECT_TRUE(nlohmann::json::parse(result.out, nullptr, false).is_object()) << command << "\n"
                                                                               << result.out;
  }
}

}  // namespace
}  // namespace ovimap
