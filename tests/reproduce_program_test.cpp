// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// `ovimap reproduce` on tiny recordings laid out as the paper's data sets are.
#include "ovimap/frames/readers/scannet_fixture.h"
#include "truth_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// Replica's wall, sofa and vase, by ids of their own; ScanNet's numbers of similar names.
constexpr int kReplicaClasses[] = {93, 76, 91};
constexpr const char* kScanNetNames[] = {"wall", "couch", "odd thing"};

/// Two scenes of Replica - one with the labels published for the pack, one with Replica's own
/// annotation - and one of ScanNet. The truth is the surface of a map of the room that all show.
class ReproduceProgramTest : public TruthfulProgramTest {
 protected:
  ReproduceProgramTest() {
    make_map("none");
    mesh_ = read_ply(path("truth.ply"));
    fs::create_directories(path("Replica"));
    fs::copy_file(path("replica/cam_params.json"), path("Replica/cam_params.json"));
    for (const char* scene : {"office0", "room0"}) {
      fs::copy(path("replica/scene"), path("Replica") / scene, fs::copy_options::recursive);
      write_masks(path("masks") / scene, sequence_, "frame", 6);
    }
    label_pack("office0");
    annotate_replica(path("Replica/room_0/habitat"));
    write_scannet_scene(path("ScanNet/scans/scene0011_00"));
  }

  static void write_masks(const fs::path& folder, const fixture::Sequence& sequence,
                          const std::string& stem, int digits) {
    fs::create_directories(folder);
    for (int i = 0; i < sequence.frames; ++i)
      write_file(folder / (stem + fixture::padded(i, digits) + ".png"),
                 encode_png(sequence.ids(i)));
  }

  void label_pack(const std::string& scene) const {
    write_ply(path("Replica") / (scene + "_mesh.ply"), mesh_);
    std::string instances, classes;
    for (const std::uint32_t label : mesh_.labels) {
      instances += concat(label, "\n");
      classes += concat(label == 0 ? -1 : kReplicaClasses[label % 3], "\n");
    }
    const auto write = [&](const std::string& folder, const std::string& name,
                           const std::string& labels) {
      fs::create_directories(path("Replica/" + folder));
      write_text(path("Replica/" + folder) / (name + scene + ".txt"), labels);
    };
    write("replica_gt_instances", "instance_labels_", instances);
    write("replica_gt_semantics", "semantic_labels_", classes);
  }

  void annotate_replica(const fs::path& folder) const {
    std::string text =
        concat("ply\nformat ascii 1.0\nelement vertex ", mesh_.vertices.size(),
               "\nproperty float x\nproperty float y\nproperty float z\n", "element face ",
               mesh_.triangles.size(), "\nproperty list uchar int vertex_indices\n",
               "property int object_id\nend_header\n");
    for (const auto& v : mesh_.vertices) text += concat(v.x(), " ", v.y(), " ", v.z(), "\n");
    for (const auto& t : mesh_.triangles)
      text += concat("3 ", t[0], " ", t[1], " ", t[2], " ", mesh_.labels[t[0]], "\n");
    nlohmann::json objects = nlohmann::json::array();
    for (const std::uint32_t id : std::set(mesh_.labels.begin(), mesh_.labels.end()))
      objects.push_back({{"id", id},
                         {"class_id", id == 0 ? -1 : kReplicaClasses[id % 3]},
                         {"class_name", "thing"}});
    const nlohmann::json classes = {{{"id", 93}, {"name", "wall"}},
                                    {{"id", 76}, {"name", "sofa"}},
                                    {{"id", 91}, {"name", "vase"}}};
    fs::create_directories(folder);
    write_text(folder / "mesh_semantic.ply", text);
    write_text(folder / "info_semantic.json",
               nlohmann::json{{"classes", classes}, {"objects", objects}}.dump());
  }

  void write_scannet_scene(const fs::path& folder) const {
    const fixture::Sequence sequence = fixture::two_camera_sequence(sequence_.frames);
    fixture::write_scannet(folder, sequence);
    write_masks(path("masks/scene0011_00"), sequence, "", 1);
    const std::string stem = (folder / "scene0011_00").string();
    write_ply(stem + "_vh_clean_2.labels.ply", mesh_);
    write_text(stem + "_vh_clean_2.0.010000.segs.json",
               nlohmann::json{{"segIndices", mesh_.labels}}.dump());
    nlohmann::json groups = nlohmann::json::array();
    for (const std::uint32_t id : std::set(mesh_.labels.begin(), mesh_.labels.end()))
      if (id > 0)
        groups.push_back({{"objectId", id - 1},
                          {"label", kScanNetNames[id % 3]},
                          {"segments", nlohmann::json::array({id})}});
    write_text(stem + ".aggregation.json", nlohmann::json{{"segGroups", groups}}.dump());
    write_text(path("ScanNet/scannetv2-labels.combined.tsv"),
               "id\traw_category\tnyu40id\tnyu40class\n1\twall\t1\twall\n"
               "6\tcouch\t6\tsofa\n1299\todd thing\t40\totherprop\n");
  }

  std::string command(const std::string& data) const {
    return "reproduce " + data + " -o out --masks masks --encoder " + golden_model("minilm") +
           " --model-dir " + kGoldenModels + kSmallPictures;
  }

  Mesh mesh_;
};

TEST_F(ReproduceProgramTest, MakesBothTablesBesideThePublishedOnes) {
  const ProgramResult result =
      run(command("--replica Replica --scannet ScanNet --preset reference --preset default"));
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string table = slurp(path("out/replica.md"));
  EXPECT_EQ(result.out, table + "\n" + slurp(path("out/scannet.md")) + "\n");
  const auto json = nlohmann::json::parse(slurp(path("out/reproduce.json")));
  for (const char* dataset : {"Replica", "ScanNet"}) {
    const auto& made = json[dataset];
    EXPECT_EQ(made["published"].size(), 10u);
    ASSERT_EQ(made["measured"].size(), 2u);
    EXPECT_EQ(made["measured"][0]["method"], "ovimap, reference settings");
    for (const char* protocol : {"standard", "reference"})
      for (const char* figure : {"inst mIoU", "inst AP75", "mIoU", "mAcc", "AP25", "AP"})
        EXPECT_TRUE(made["measured"][1][protocol][figure].is_number()) << dataset << figure;
  }
  // The truth is what our own settings make of the room.
  EXPECT_GT(json["Replica"]["measured"][1]["standard"]["inst AP50"].get<double>(), 90);
  EXPECT_GT(json["ScanNet"]["measured"][1]["standard"]["inst AP50"].get<double>(), 50);
  for (const char* part :
       {"| OVI-MAP | *published, Replica* | *36.3*", "scenes: 2 of the paper's 8", "CropFormer",
        "siglip-large-patch16-384", "- office3: there is no folder"})
    EXPECT_NE(table.find(part), std::string::npos) << part << " is not in\n" << table;
  EXPECT_NE(slurp(path("out/scannet.csv")).find("OVO-SLAM,reference,\"published, ScanNet\",39.8"),
            std::string::npos);
}

TEST_F(ReproduceProgramTest, GoesOnWhereItStopped) {
  const std::string same = command("--replica Replica");
  ASSERT_EQ(run(same).code, 0);
  const fs::path office = path("out/maps/reference/office0.ovimap"),
                 room = path("out/maps/reference/room0.ovimap");
  const auto written = fs::last_write_time(office);
  const std::string table = slurp(path("out/replica.md"));
  fs::remove(room);
  ASSERT_EQ(run(same).code, 0);
  EXPECT_TRUE(fs::exists(room));
  EXPECT_EQ(fs::last_write_time(office), written);
  EXPECT_EQ(slurp(path("out/replica.md")), table);
  const ProgramResult other = run(same + " --views vis");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("settings.txt"), std::string::npos) << other.err;
}

TEST_F(ReproduceProgramTest, SaysWhatEachSceneLacks) {
  fs::copy(path("Replica/office0"), path("Replica/office1"), fs::copy_options::recursive);
  write_ply(path("Replica/office1_mesh.ply"), mesh_);  // as the pack is, without labels
  fs::copy(path("Replica/office0"), path("Replica/office2"), fs::copy_options::recursive);
  label_pack("office2");  // but no masks
  const ProgramResult result = run(command("--replica Replica"));
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* line : {"Replica office1: the truth of ", "instance_labels_office1.txt",
                           "Replica office2: there is no folder of masks masks/office2",
                           "Replica office4: there is no folder Replica/office4"})
    EXPECT_NE(result.err.find(line), std::string::npos) << line << " is not in\n" << result.err;
}

TEST_F(ReproduceProgramTest, DepthAloneNeedsNoNetworks) {
  const auto json = run_json("reproduce --scannet ScanNet/scans -o out --masks none --json");
  EXPECT_FALSE(json.contains("Replica"));
  const auto& figures = json["ScanNet"]["measured"][0]["standard"];
  EXPECT_TRUE(figures["inst mIoU"].is_number());
  EXPECT_TRUE(figures["mIoU"].is_null());
  EXPECT_NE(json["ScanNet"]["notes"].dump().find("encoder: none"), std::string::npos);
}

TEST_F(ReproduceProgramTest, SaysWhatIsWrong) {
  expect_complaint("reproduce -o out", {"--replica", "--scannet"});
  expect_complaint("reproduce --replica nowhere -o out", {"nowhere", "office0"});
  const ProgramResult result = run("reproduce --replica recording -o out --masks none");
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 8 + 1) << result.err;
  EXPECT_NE(result.err.find("none of the paper's scenes"), std::string::npos) << result.err;
  const ProgramResult late =
      run("reproduce --replica Replica -o late --masks nosuch --encoder none");
  EXPECT_EQ(late.code, 2);
  EXPECT_NE(late.err.find("nosuch"), std::string::npos) << late.err;
  EXPECT_FALSE(fs::exists(path("late"))) << "said before anything slow";
}

}  // namespace
}  // namespace ovimap
