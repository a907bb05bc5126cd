// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/instance_csv.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

TEST(InstanceCsv, QuotesWhatNeedsIt) {
  InstanceSummary cup, nothing;
  cup.id = 7;
  cup.box = {Eigen::Vector3f(0.1f, -2, 0), Eigen::Vector3f(0.2f, -1.5f, 1e-3f)};
  cup.centroid = {0.15f, -1.75f, 0};
  cup.points = 5000000000;
  cup.views = 3;
  cup.confidence = 0.75f;
  nothing.id = 8;
  const std::string csv = instances_csv(
      std::vector{cup, nothing}, {{{7, "cup, \"old\"\nblue"}, {9, "elsewhere"}}, {{8, "chair"}}});
  EXPECT_EQ(csv.substr(0, 9), "id,name,m");
  EXPECT_NE(csv.find("7,\"cup, \"\"old\"\"\nblue\",0.1,-2,0,0.2,-1.5,0.001,0.15,-1.75,0,5000000000,"
                     "3,0.75,\r\n"),
            std::string::npos)
      << csv;
  EXPECT_NE(csv.find("\r\n8,,"), std::string::npos);
  EXPECT_TRUE(csv.ends_with(",0,,chair\r\n")) << csv;  // nobody said how sure
}

TEST(InstanceCsv, NamesAreNoFormulas) {
  InstanceSummary thing;
  thing.id = 1;
  for (const char* name : {"=1+1", "+1", "-1+1|cmd", "@SUM(1)"})
    EXPECT_NE(
        instances_csv(std::vector{thing}, {{{1, name}}, {}}).find(concat("\r\n1,'", name, ",")),
        std::string::npos)
        << name;
  EXPECT_NE(instances_csv(std::vector{thing}, {{{1, "=\"a\""}}, {}}).find("1,\"'=\"\"a\"\"\","),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
