// Tests that a manual is complete as JSON, and divided into paragraphs.
#include "io/help/manual.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace svdag {
namespace {

using Kind = Paragraph::Kind;

TEST(Manual, IsPrintedAsJson) {
  Manual manual, command;
  manual.command = "p";
  manual.text = "prints \"\\n\"";
  manual.notes = "a\nb";
  manual.options = {{{"-o", "--output"}, "OUT", "", "", {}, {".ply"}, true}};
  command.command = "p c";
  command.operands = {{{"FILE"}, "", "", "", {}, {}, true}};
  manual.commands = {command};
  const nlohmann::json json = nlohmann::json::parse(manual_json(manual));
  EXPECT_EQ(json["text"], "prints \"\\n\"");
  EXPECT_EQ(json["notes"], "a\nb");
  EXPECT_EQ(json["usage"], "COMMAND [OPTIONS]");
  EXPECT_EQ(json["options"][0], nlohmann::json::parse(R"({"names": ["-o", "--output"],
      "value": "OUT", "text": "", "group": "", "choices": [], "endings": [".ply"],
      "required": true, "repeated": false})"));
  EXPECT_EQ(json["commands"][0]["command"], "p c");
  EXPECT_EQ(json["commands"][0]["usage"], "[OPTIONS] FILE");
}

TEST(Manual, UsageNamesRequiredOptionsAndOperands) {
  Manual manual;
  manual.operands = {{{"SCENE"}, "", "", "", {}, {}, true, true}, {{"MORE"}, "", "", "", {}, {}}};
  manual.options = {{{"-o", "--output"}, "OUT", "", "", {}, {}, true},
                    {{"-q"}, "", "", "", {}, {}}};
  EXPECT_EQ(usage_of(manual), "-o OUT [OPTIONS] SCENE... [MORE]");
}

TEST(Paragraphs, AreTextHeadingsAndPreformattedLines) {
  const std::vector<Paragraph> found = paragraphs_of(
      "One text\nof two lines\n\n    svdag info a\n    svdag info b\n\nExamples:\n  c\n");
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].kind, Kind::kText);
  EXPECT_EQ(found[0].lines[0], "One text of two lines");
  EXPECT_EQ(found[1].kind, Kind::kLines);
  EXPECT_EQ(found[1].lines.size(), 2U);
  EXPECT_EQ(found[2].kind, Kind::kHeading);
  EXPECT_EQ(found[2].lines[0], "Examples");
  EXPECT_EQ(found[3].lines[0], "  c");
}

TEST(Paragraphs, ATextLineThatEndsWithAColonIsNotAHeading) {
  const std::vector<Paragraph> found =
      paragraphs_of("It is cut in two, and one merges\nthe runs:\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, Kind::kText);
}

}  // namespace
}  // namespace svdag
