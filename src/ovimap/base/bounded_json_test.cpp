// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/bounded_json.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/base/error_fixture.h"

namespace ovimap {
namespace {

constexpr std::size_t kMost = 2'000'000;

/// The message of the Error for `text`; empty: none.
std::string json_fault(const std::string& text, std::size_t most_bytes = kMost) {
  return fault_of([&] { parse_json(text, "the body", most_bytes); });
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

TEST(BoundedJson, ReadsWhatOthersWrite) {
  const std::string text = R"({"a": [1, -2, 2.5e3, true, false, null, "\u00e4\n"],
                               "b": {"c": {}, "d": []}, "": 18446744073709551615})";
  EXPECT_EQ(parse_json(text, "x", kMost), nlohmann::json::parse(text));
  for (const char* value : {"1", "\"a\"", "null", "[]", "{}", " [1] \n", "\xEF\xBB\xBF[1]"})
    EXPECT_EQ(parse_json(value, "x", kMost), nlohmann::json::parse(value)) << value;
}

TEST(BoundedJson, EndsAtADepth) {
  const auto check = [](const std::string& opening, const std::string& closing) {
    const auto nested = [&](std::size_t levels) {
      return repeated(opening, levels) + "1" + repeated(closing, levels);
    };
    EXPECT_EQ(json_fault(nested(kDeepestDocument)), "");
    EXPECT_EQ(json_fault(nested(kDeepestDocument + 1)),
              "the body is nested more than 32 levels deep");
    EXPECT_NE(json_fault(repeated(opening, 300'000)), "") << "and never ends";
  };
  check("[", "]");
  check(R"({"a":)", "}");
}

TEST(BoundedJson, SaysWhereItGoesWrong) {
  EXPECT_EQ(json_fault("{\n  \"a\": nan}"), "the body is not JSON: line 2, column 9");
  EXPECT_EQ(json_fault("[1, 2"), "the body is not JSON: line 1, column 5, where it ends");
  EXPECT_EQ(json_fault(""), "the body is not JSON: line 1, column 1, where it ends");
  EXPECT_EQ(json_fault(R"({"a": 1, "b": 2, "a": 3})"),
            R"(the body has the key "a" twice in one object)");
  EXPECT_EQ(json_fault("[[1],[2],[3]]", 10),
            "the body is larger than 10 bytes, the most that is accepted");
  EXPECT_EQ(json_fault(std::string("[1]\0[2]", 7)), "the body is no text: byte 4 is NUL");
}

TEST(BoundedJson, RefusesWhatIsNoJson) {
  for (const char* text :
       {"NaN", "[Infinity]", "[1e999]", "[1,]", "{a: 1}", "'a'", "[1] 2", "/* */ 1", "[01]",
        "[\"\xff\"]", "[\"\xc0\xaf\"]", "[\"\xed\xa0\x80\"]", R"(["\ud800"])", "[\"\n\"]"})
    EXPECT_NE(json_fault(text).find("is not JSON"), std::string::npos) << text;
}

TEST(BoundedJson, FaultsAreOneShortLine) {
  const std::string key = "\\n" + repeated("x", 100'000);
  const std::string fault = json_fault("{\"" + key + "\": 1, \"" + key + "\": 2}");
  EXPECT_NE(fault.find("twice"), std::string::npos);
  EXPECT_LT(fault.size(), 200u);
  EXPECT_EQ(fault.find('\n'), std::string::npos);
}

/// nlohmann's parser callback would need minutes: it searches a list again after each entry.
TEST(BoundedJson, TakesTimeInProportionToTheText) {
  const std::string text = "[" + repeated("{},", 500'000) + "{}]";
  EXPECT_EQ(parse_json(text, "x", kMost).size(), 500'001u);
}

TEST(BoundedJson, ReadsNoMoreOfAFileThanItMay) {
  EXPECT_THROW(read_json("/dev/zero", 1 << 20), Error);
  EXPECT_THROW(read_json("/nowhere/a.json", 100), Error);
  EXPECT_THROW(read_json(std::filesystem::temp_directory_path(), 100), Error) << "a folder";
  const auto file = std::filesystem::path(testing::TempDir()) / "bounded.json";
  std::ofstream(file) << "[" << repeated("1,", 100'000) << "1]";
  EXPECT_EQ(read_json(file, 200'003).size(), 100'001u);
  EXPECT_THROW(read_json(file, 200'002), Error);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace ovimap
