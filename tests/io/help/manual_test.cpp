// Tests that a manual is the same after it was written as a table and read back.
#include "io/help/manual.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/any_of.h"
#include "tests/expect_error.h"

namespace svdag {
namespace {

using Kind = Paragraph::Kind;

// A word of an option or a text; line() is a line of words.
rc::Gen<std::string> word() {
  return rc::gen::nonEmpty(
      rc::gen::container<std::string>(rc::gen::elementOf(std::string("abxyz09-,.;:'\"\\$%"))));
}

rc::Gen<std::string> line() {
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(word()),
                      [](const std::vector<std::string>& words) {
                        std::string text;
                        for (const std::string& each : words)
                          text += (text.empty() ? "" : " ") + each;
                        return text;
                      });
}

ManualOption any_option() {
  ManualOption option;
  option.names = *rc::gen::nonEmpty(rc::gen::container<std::vector<std::string>>(word()));
  option.value = *line();
  option.text = *line();
  option.group = *line();
  option.choices = *rc::gen::container<std::vector<std::string>>(word());
  option.endings = *rc::gen::container<std::vector<std::string>>(word());
  option.required = *rc::gen::arbitrary<bool>();
  option.repeated = *rc::gen::arbitrary<bool>();
  return option;
}

Manual any_manual() {
  Manual manual;
  manual.command = *word();
  manual.text = *line();
  for (int i = *any_of(0, 4); i > 0; --i) manual.options.push_back(any_option());
  for (int i = *any_of(0, 3); i > 0; --i) manual.operands.push_back(any_option());
  const int notes = *any_of(0, 4);
  for (int i = 0; i < notes; ++i) manual.notes += (i == 0 ? "note " : "\n") + *line();
  return manual;
}

RC_GTEST_PROP(Manual, ReadsBackFromItsTable, ()) {
  Manual program = any_manual();
  for (int i = *any_of(0, 3); i > 0; --i) program.commands.push_back(any_manual());
  const std::string table = to_table(program);
  const std::vector<Manual> read = from_table(table + table);
  RC_ASSERT(read.size() == 2U);
  RC_ASSERT(to_table(read[1]) == table);
  RC_ASSERT(read[1].options.size() == program.options.size());
  RC_ASSERT(read[1].notes == program.notes);
  if (!program.options.empty()) {
    RC_ASSERT(read[1].options[0].names == program.options[0].names);
    RC_ASSERT(read[1].options[0].endings == program.options[0].endings);
    RC_ASSERT(read[1].options[0].text == program.options[0].text);
  }
}

TEST(Manual, AnInvalidTableIsRejected) {
  EXPECT_SVDAG_ERROR(from_table("option\t-x\n"), ExitCode::kUsage, "begin with a program");
  EXPECT_SVDAG_ERROR(from_table("program\tp\tdoes\noption\t-x\n"), ExitCode::kUsage,
                     "not an option");
  EXPECT_SVDAG_ERROR(from_table("program\tp\tdoes\npicture\tx\n"), ExitCode::kUsage, "picture");
}

TEST(Manual, UsageNamesRequiredOptionsAndOperands) {
  Manual manual;
  manual.operands = {{{"SCENE"}, "", "", "", {}, {}, true, true}, {{"MORE"}, "", "", "", {}, {}}};
  manual.options = {{{"-o", "--output"}, "OUT", "", "", {}, {}, true},
                    {{"-q"}, "", "", "", {}, {}}};
  EXPECT_EQ(usage_of(manual), "-o OUT [OPTIONS] SCENE... [MORE]");
  EXPECT_EQ(page_of("svdag-verify mesh"), "svdag-verify-mesh");
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
