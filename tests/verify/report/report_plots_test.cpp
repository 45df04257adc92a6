#include "verify/report/report_plots.h"

#include <gtest/gtest.h>

#include <regex>

namespace svdag {
namespace {

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// The numbers that follow `attribute` in `text`, in order.
std::vector<double> numbers(const std::string& text, const std::string& attribute) {
  const std::regex pattern(attribute + "([-0-9.]+)");
  std::vector<double> found;
  for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i)
    found.push_back(std::stod((*i)[1]));
  return found;
}

TEST(ReportPlots, EveryDecadeHasTheSameHeight) {
  const std::string plot = plot_lines("nodes", {{"a", "one", {1, 10, 100, 1000}}});
  const auto heights = numbers(plot, "cy=\"");
  ASSERT_EQ(heights.size(), 4U);
  for (size_t k = 2; k < 4; ++k)
    EXPECT_NEAR(heights[k] - heights[k - 1], heights[1] - heights[0], 0.11);
  EXPECT_LT(heights[1], heights[0]);  // y points down
}

TEST(ReportPlots, ZeroInterruptsTheLine) {
  const std::string plot = plot_lines("nodes", {{"a", "one", {0, 5, 0, 7, 9}}});
  EXPECT_EQ(count(plot, "<circle"), 3U);
  const std::string path = plot.substr(plot.find(" d=\""), 60);
  EXPECT_EQ(count(path, "M"), 2U);
  EXPECT_EQ(count(path, "L"), 1U);
}

TEST(ReportPlots, WithoutLinesOrLevelsThePlotIsEmpty) {
  EXPECT_EQ(count(plot_lines("nodes", {}), "<circle"), 0U);
  EXPECT_EQ(count(plot_lines("nodes", {{"a", "one", {0, 0}}}), "<circle"), 0U);
  EXPECT_EQ(count(plot_columns("bytes", {}), "<rect"), 0U);
}

TEST(ReportPlots, ColumnsAreInProportion) {
  const std::string plot = plot_columns("bytes", {{1, "1"}, {2, "2"}, {4, "4"}});
  const auto heights = numbers(plot, " height=\"");
  ASSERT_EQ(heights.size(), 3U);
  EXPECT_NEAR(heights[2], 4 * heights[0], 0.3);
  EXPECT_NEAR(heights[2], 2 * heights[1], 0.3);
}

TEST(ReportPlots, BarsStayInsideAndNamesAreEscaped) {
  const std::string plot =
      plot_bars("seconds", {{"<b>", 3, "3 s"}, {"whole", 4, "4 s"}, {"more", 9, "9 s"}}, 4, "one");
  EXPECT_EQ(numbers(plot, "width:"), (std::vector<double>{75, 100, 100}));
  EXPECT_EQ(count(plot, "<b>"), 0U);
  EXPECT_EQ(numbers(plot_bars("nothing", {{"a", 1, ""}}, 0, "one"), "width:"),
            (std::vector<double>{0}));
}

}  // namespace
}  // namespace svdag
