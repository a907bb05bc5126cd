// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/taught_file.h"

#include <thread>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

class TaughtFileTest : public ::testing::Test {
 protected:
  static TaughtThing thing(const std::string& name, const std::string& map, InstanceId object) {
    constexpr int kNumbers = 384;
    Eigen::VectorXf look =
        Eigen::VectorXf::LinSpaced(kNumbers, -1.f, static_cast<float>(object)).normalized();
    return {name, map, object, {"some encoder", kNumbers, "abc"}, look};
  }
  void write(const std::string& text) const { folder_.write("deep/taught.json", text); }

  const fixture::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "deep" / "taught.json";
};

TEST_F(TaughtFileTest, ComesBackAsItWasKept) {
  EXPECT_TRUE(read_taught_file(file_).empty());
  const TaughtThing kept = thing("Anna's \"mug\", blue", "/maps/a.ovimap", 7);
  replace_taught_things(file_, kept.map, {kept});
  const std::vector<TaughtThing> read = read_taught_file(file_);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].name, kept.name);
  EXPECT_EQ(read[0].map, kept.map);
  EXPECT_EQ(read[0].object, 7u);
  EXPECT_EQ(read[0].encoder, kept.encoder);
  EXPECT_NEAR(read[0].look.norm(), 1.f, 1e-5f);
  EXPECT_GT(read[0].look.dot(kept.look), 0.9995f);
}

TEST_F(TaughtFileTest, IsSmall) {
  replace_taught_things(file_, "/maps/a.ovimap", {thing("mug", "/maps/a.ovimap", 7)});
  EXPECT_LT(fs::file_size(file_), 2000u);
}

TEST_F(TaughtFileTest, AMapReplacesWhatItTaughtAndNothingElse) {
  replace_taught_things(file_, "/a", {thing("mug", "/a", 1), thing("bed", "/a", 2)});
  replace_taught_things(file_, "/b", {thing("sofa", "/b", 1)});
  replace_taught_things(file_, "/a", {thing("cup", "/a", 1)});
  std::vector<std::string> names;
  for (const TaughtThing& known : read_taught_file(file_)) names.push_back(known.name);
  EXPECT_EQ(names, (std::vector<std::string>{"sofa", "cup"}));
  replace_taught_things(file_, "/a", {});
  EXPECT_EQ(read_taught_file(file_).size(), 1u);
}

TEST_F(TaughtFileTest, ProgramsThatTeachAtOnceLoseNothing) {
  constexpr int kPrograms = 4, kTimes = 10;
  std::vector<std::thread> programs;
  for (int p = 0; p < kPrograms; ++p)
    programs.emplace_back([this, p] {
      const std::string map = concat("/map", p);
      for (int i = 1; i <= kTimes; ++i)
        replace_taught_things(file_, map, {thing(concat("thing ", i), map, 1)});
    });
  for (std::thread& program : programs) program.join();
  const std::vector<TaughtThing> read = read_taught_file(file_);
  ASSERT_EQ(read.size(), static_cast<std::size_t>(kPrograms));
  for (const TaughtThing& known : read) EXPECT_EQ(known.name, concat("thing ", kTimes));
}

TEST_F(TaughtFileTest, RefusesWhatIsNoSuchFile) {
  const std::string good =
      R"({"name":"mug","map":"/a","object":1,"encoder":{"name":"e","digest":"d"},"look":[1,2]})";
  write(R"({"format":1,"things":[)" + good + "]}");
  EXPECT_EQ(read_taught_file(file_).size(), 1u);
  for (
      const std::string& text :
      {std::string("no json"), std::string(R"({"format":2,"things":[]})"),
       std::string(R"({"things":[]})"), std::string(R"({"format":1,"things":[{"name":"mug"}]})"),
       std::string(
           R"({"format":1,"things":[{"name":"","map":"/a","object":1,"encoder":{"name":"e","digest":"d"},"look":[1]}]})"),
       std::string(
           R"({"format":1,"things":[{"name":"m","map":"/a","object":1,"encoder":{"name":"e","digest":"d"},"look":[0,0]}]})"),
       std::string(
           R"({"format":1,"things":[{"name":"m","map":"/a","object":1,"encoder":{"name":"e","digest":"d"},"look":[]}]})")}) {
    write(text);
    EXPECT_THROW(read_taught_file(file_), Error) << text;
    EXPECT_THROW(replace_taught_things(file_, "/b", {}), Error) << text;
  }
}

TEST_F(TaughtFileTest, SaysWhatToDoWhereItCannotBeWritten) {
  folder_.write("file", "x");
  const std::string fault =
      error_of([&] { replace_taught_things(folder_.path() / "file" / "taught.json", "/a", {}); });
  EXPECT_NE(fault.find("--teach FILE"), std::string::npos) << fault;
}

}  // namespace
}  // namespace ovimap
