// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/history_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

constexpr double kMonday_s = 1'773'648'000, kDay_s = 86400;  // in March 2026
const std::vector<std::string> kThings{"table", "chair", "mug",  "sofa", "lamp",   "television",
                                       "plate", "book",  "vase", "bowl", "basket", "clock"};

Eigen::AlignedBox3f box_at(float x) {
  return {Eigen::Vector3f(x, 0, 0), Eigen::Vector3f(x + 0.2f, 0.2f, 0.2f)};
}

/// Three visits, one a day: the mug (3) was moved on the second and again on the third, the vase
/// (9) went on the third, the clock (12) came on the second.
class HistorySearchTest : public MapFolder {
 protected:
  HistorySearchTest() {
    for (InstanceId id = 1; id <= kThings.size(); ++id) add(id);
    std::erase_if(record_.instances, [](const auto& instance) { return instance.id == 9; });
    for (int visit = 0; visit < 3; ++visit) {
      record_.history.visits.push_back({"/a", visit * 2, visit * 2});
      for (int frame = 0; frame < 2; ++frame)
        record_.frames.push_back(
            {visit * 2 + frame, kMonday_s + visit * kDay_s + frame, "", {}, true});
    }
    record_.history.events = {
        {3, ObjectEventKind::kMoved, 2, 2, box_at(20), box_at(30), 0, was(3, 20)},
        {12, ObjectEventKind::kAppeared, 2, 3, {}, box_at(12), 0},
        {3, ObjectEventKind::kMoved, 3, 4, box_at(30), box_at(3), 0, was(3, 30)},
        {9, ObjectEventKind::kGone, 3, 5, box_at(9), {}, 0, was(9, 9)}};
    record_.semantics.encoder = encoder_.identity();
  }

  void add(InstanceId id) {
    InstanceSummary instance;
    instance.id = id;
    instance.box = box_at(static_cast<float>(id));
    instance.centroid = instance.box.center();
    instance.points = 100;
    instance.views = 4;
    instance.super_points = {id};
    record_.instances.push_back(instance);
    std::sort(record_.instances.begin(), record_.instances.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    ObjectView view;
    view.frame = 1;
    view.visible_px = 100;
    view.super_point = id;
    view.embedding = WordEncoder::direction_of(kThings[id - 1]);
    record_.semantics.looks[id].views.push_back(view);
  }

  static std::shared_ptr<const PastObject> was(InstanceId id, float x) {
    return std::make_shared<const PastObject>(PastObject{box_at(x).center(),
                                                         90,
                                                         3,
                                                         {id},
                                                         {box_at(x).min(), box_at(x).max()},
                                                         {{1, 2, 3}, {4, 5, 6}}});
  }

  HistorySearch search(const std::string& text, const std::string& at = "",
                       const std::string& since = "") const {
    const auto phrase = history_of_question(text, at, since, kMonday_s + 2.5 * kDay_s);
    EXPECT_TRUE(phrase) << text;
    return search_history(record_, {}, phrase.value_or(HistoryPhrase{}));
  }

  QueryAnswer ask(const std::string& text, const std::string& at = "",
                  const std::string& since = "") {
    const HistorySearch past = search(text, at, since);
    const QueryEngine engine(past.search.index, &encoder_, {}, {}, past.search.scene);
    return ask_history(past, &engine, {});
  }

  std::vector<InstanceId> ids(const QueryAnswer& answer) const {
    std::vector<InstanceId> list;
    for (const QueryMatch& match : answer.matches) list.push_back(match.id);
    return list;
  }

  /// Where the best match of a question is, along x.
  float place(const std::string& text, const std::string& at = "") {
    const HistorySearch past = search(text, at);
    const QueryEngine engine(past.search.index, &encoder_, {}, {}, past.search.scene);
    const QueryAnswer answer = ask_history(past, &engine, {});
    if (answer.verdict != Verdict::kFound) return -1;
    return past.search.index.object(answer.matches.front().position).box.min().x();
  }

  WordEncoder encoder_;
  MapRecord record_;
};

TEST_F(HistorySearchTest, FramesHaveAVisitAndATime) {
  const HistoryDates dates(record_.history, record_.frames);
  const auto seen = dates.sighting(3);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->visit, 2);
  EXPECT_EQ(seen->time_s, kMonday_s + kDay_s + 1);
  EXPECT_FALSE(dates.sighting(6)) << "the map has no such frame";
  EXPECT_FALSE(dates.sighting(-1));
  record_.frames[3].timestamp_s = 3;  // since some machine was started
  EXPECT_FALSE(HistoryDates(record_.history, record_.frames).sighting(3)->time_s);
}

TEST_F(HistorySearchTest, TheMapAsItWas) {
  EXPECT_EQ(place("mug", "visit 1"), 20);
  EXPECT_EQ(place("mug", "visit 2"), 30);
  EXPECT_EQ(place("mug", "last visit"), 3);
  EXPECT_EQ(place("vase", "visit 2"), 9) << "it was still there";
  EXPECT_EQ(place("vase", "visit 3"), -1);
  EXPECT_EQ(place("clock", "visit 1"), -1) << "it was not there yet";
  EXPECT_EQ(place("clock", "visit 2"), 12);
  EXPECT_EQ(place("mug before visit 2"), 20);
  EXPECT_EQ(place("mug", date_text(kMonday_s + kDay_s - 60)), 20);
  EXPECT_EQ(place("mug at " + date_text(kMonday_s + kDay_s + 600)), 30);
  const QueryAnswer answer = ask("mug", "visit 1");
  EXPECT_EQ(answer.reading, "[mug] at visit 1");
  EXPECT_NE(answer.matches[0].evidence.find("moved from here as visit 2"), std::string::npos)
      << answer.matches[0].evidence;
  EXPECT_EQ(search("mug", "visit 1").events[2], 1u);
  EXPECT_EQ(search("mug", "visit 2").events[2], 3u);
  EXPECT_EQ(search("mug", "visit 3").events[2], 0u);
}

TEST_F(HistorySearchTest, WhereThingsWereBefore) {
  EXPECT_EQ(place("where was the mug?"), 30) << "before it came to where it is";
  EXPECT_EQ(place("where was the vase"), 9);
  EXPECT_EQ(place("where was the sofa"), 4);
  EXPECT_EQ(ask("where was the sofa").matches[0].evidence, "still there");
}

TEST_F(HistorySearchTest, WhatChanged) {
  EXPECT_EQ(ids(ask("what changed")), (std::vector<InstanceId>{3, 9, 12}));
  EXPECT_EQ(ids(ask("what moved")), (std::vector<InstanceId>{3}));
  EXPECT_EQ(ids(ask("what is gone")), (std::vector<InstanceId>{9}));
  EXPECT_EQ(ids(ask("what is new")), (std::vector<InstanceId>{12}));
  EXPECT_EQ(ids(ask("what changed since visit 2")), (std::vector<InstanceId>{3, 9}));
  EXPECT_EQ(ids(ask("what changed in visit 2")), (std::vector<InstanceId>{3, 12}));
  EXPECT_EQ(ids(ask("", "", "visit 2")), (std::vector<InstanceId>{3, 9}));
  EXPECT_EQ(ids(ask("what changed yesterday")), (std::vector<InstanceId>{3, 12}));
  const QueryAnswer moved = ask("what moved since visit 1");
  EXPECT_EQ(moved.reading, "[anything] that moved since visit 1");
  EXPECT_EQ(moved.matches[0].evidence.find(
                "moved from (20.10, 0.10, 0.10) to (3.10, 0.10, 0.10), visit 3"),
            0u)
      << moved.matches[0].evidence;
  EXPECT_EQ(ids(ask("which vases are gone")), (std::vector<InstanceId>{9}));
  EXPECT_EQ(ask("mug", "", "visit 2").verdict, Verdict::kFound);
  EXPECT_EQ(ask("sofa", "", "visit 1").verdict, Verdict::kNotInMap) << "it never changed";
  const QueryAnswer none = ask("what changed since visit 3");
  EXPECT_EQ(none.verdict, Verdict::kNotInMap);
  EXPECT_EQ(none.reason, "nothing changed since visit 3");
  EXPECT_EQ(ask("chairs that moved since visit 3").reason, "nothing moved since visit 3");
}

TEST_F(HistorySearchTest, WhatItMustNotBe) {
  const HistorySearch past = search("what changed");
  const QueryEngine engine(past.search.index, &encoder_, {}, {}, past.search.scene);
  const auto without = [&](const std::vector<std::string>& not_texts) {
    return ids(ask_history(past, &engine, {"", not_texts}));
  };
  EXPECT_EQ(without({"mug, vase"}), (std::vector<InstanceId>{12}));
  EXPECT_EQ(without({"sofa", ","}), (std::vector<InstanceId>{3, 9, 12}));
  EXPECT_NE(fault_of([&] { without({" "}); }), "");
}

TEST_F(HistorySearchTest, WhatCameAndWentIsNoChange) {
  record_.history.events.push_back(
      {12, ObjectEventKind::kGone, 3, 5, box_at(12), {}, 0, was(12, 12)});
  std::erase_if(record_.instances, [](const auto& instance) { return instance.id == 12; });
  EXPECT_EQ(ids(ask("what changed since visit 1")), (std::vector<InstanceId>{3, 9}));
  EXPECT_EQ(ids(ask("what is gone since visit 2")), (std::vector<InstanceId>{9, 12}));
  EXPECT_EQ(place("clock", "visit 2"), 12);
}

TEST_F(HistorySearchTest, WhatIsLeftOfAThingIsNotIt) {
  add(9);  // sides of the vase that nobody looked through
  EXPECT_EQ(place("vase", "visit 3"), -1);
  EXPECT_EQ(search("what is gone").events[8], 4u) << "as it was";
  EXPECT_EQ(ids(ask("what is gone")), (std::vector<InstanceId>{9}));
}

TEST_F(HistorySearchTest, MapsThatKeptNothingStillHaveBoxes) {
  for (ObjectEvent& event : record_.history.events) event.was = nullptr;
  EXPECT_EQ(place("mug", "visit 1"), 20) << "it looks as it does now";
  EXPECT_EQ(ids(ask("what is gone")), (std::vector<InstanceId>{9}));
}

TEST_F(HistorySearchTest, WhatPeopleHidStaysHidden) {
  InstanceSummary mug = record_.instances[2];
  record_.hidden.push_back(mug);
  std::erase_if(record_.instances, [](const auto& instance) { return instance.id == 3; });
  EXPECT_EQ(ids(ask("what changed")), (std::vector<InstanceId>{9, 12}));
}

TEST_F(HistorySearchTest, SaysWhatItDoesNotKnow) {
  EXPECT_NE(fault_of([&] { search("mug", "visit 4"); }).find("it has 3"), std::string::npos);
  EXPECT_NE(fault_of([&] { search("mug", "2020-01-01"); }).find("the map begins on"),
            std::string::npos);
  EXPECT_NE(fault_of([&] { search("mug before visit 1"); }).find("first visit"), std::string::npos);
  EXPECT_NE(fault_of([&] { search("mug", "some day"); }).find("is no time"), std::string::npos);
  EXPECT_NE(fault_of([&] { search("mug on Monday", "visit 1"); }).find("says when already"),
            std::string::npos);
  for (FrameLogEntry& frame : record_.frames) frame.timestamp_s -= kMonday_s;
  EXPECT_NE(fault_of([&] { search("mug", "yesterday"); }).find("--recorded"), std::string::npos);
  EXPECT_EQ(place("mug", "visit 1"), 20);
  for (int visit = 0; visit < 3; ++visit)
    record_.history.visits[static_cast<std::size_t>(visit)].recorded_s = kMonday_s + visit * kDay_s;
  EXPECT_EQ(ids(ask("what changed yesterday")), (std::vector<InstanceId>{3, 12}));
}

TEST_F(HistorySearchTest, AMapOfOneVisitHasAPast) {
  record_.history = {};
  record_.instances.erase(record_.instances.begin() + 9, record_.instances.end());
  EXPECT_EQ(place("mug", "visit 1"), 3);
  EXPECT_TRUE(ids(ask("what changed")).empty());
}

}  // namespace
}  // namespace ovimap
