// Tests that help text is filled to a width without losing a word.
#include "io/help/help_text.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <sstream>

#include "tests/any_of.h"

namespace svdag {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

Manual example() {
  Manual manual;
  manual.command = "svdag build";
  manual.text = "Bake scene files";
  manual.operands = {{{"SCENE"}, "", "Scene files", "", {}, {}, true, true}};
  manual.options = {
      {{"-q", "--quiet"}, "", "Print errors only", "", {}, {}},
      {{"--bounds"}, "x0,y0,z0,x1,y1,z1", "Bake only this box, in scene units", "", {}, {}},
      {{"--plain"}, "", "Compute every cube", "Measurements", {}, {}}};
  manual.notes = "Example:\n  svdag build a.ply\n";
  return manual;
}

TEST(HelpText, PutsTextsBesideNamesInAWideTerminal) {
  EXPECT_EQ(help_text(example(), 80),
            "Bake scene files\n"
            "Usage: svdag build [OPTIONS] SCENE...\n"
            "\n"
            "Arguments:\n"
            "  SCENE...                  Scene files\n"
            "\n"
            "Options:\n"
            "  -q, --quiet               Print errors only\n"
            "  --bounds x0,y0,z0,x1,y1,z1\n"
            "                            Bake only this box, in scene units\n"
            "\n"
            "Measurements:\n"
            "  --plain                   Compute every cube\n"
            "\n"
            "Example:\n"
            "  svdag build a.ply\n");
}

TEST(HelpText, PutsTextsBelowNamesInANarrowTerminal) {
  const std::string text = help_text(example(), 40);
  EXPECT_NE(text.find("  -q, --quiet\n      Print errors only\n"), text.npos) << text;
}

TEST(HelpText, ALongCommandIsContinuedWithABackslash) {
  EXPECT_EQ(fill_paragraphs("  svdag build city.glb -o city.svdag -r 64K\n", 30),
            "  svdag build city.glb \\\n"
            "    -o city.svdag -r 64K\n");
}

TEST(HelpText, ALongTableRowIsContinuedInItsSecondColumn) {
  EXPECT_EQ(fill_paragraphs("  4   the disk is full\n  70  a defect\n", 17),
            "  4   the disk is\n"
            "      full\n"
            "  70  a defect\n");
}

RC_GTEST_PROP(HelpText, NoLineIsLongerThanItsWidthAndNoWordIsLost, ()) {
  const size_t width = *any_of<size_t>(40, 101);
  std::string text;
  for (int i = *any_of(1, 60); i > 0; --i)
    text += *rc::gen::container<std::string>(*any_of(1, 12),
                                             rc::gen::elementOf(std::string("abc,;()"))) +
            " ";
  Manual manual = example();
  manual.options[0].text = text;
  const std::string shown = help_text(manual, width);
  for (const std::string& line : lines_of(shown)) RC_ASSERT(line.size() <= width);
  manual.options[0].text = "";
  RC_ASSERT(words_of(shown).size() ==
            words_of(help_text(manual, width)).size() + words_of(text).size());
}

}  // namespace
}  // namespace svdag
