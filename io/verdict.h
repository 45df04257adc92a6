// A verdict: the figures that a command reports, in order. Text for people and JSON for programs
// are printed from this one list, so that no figure can be in only one of them.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace svdag {

// The value of a figure: what JSON stores, and what text shows. Text shows 1234567 as "1,234,567",
// and a list as "1, 2, 3"; shown() gives a value another text.
class FigureValue {
 public:
  using List = std::vector<FigureValue>;

  FigureValue(std::nullptr_t) {}
  FigureValue(std::string value);
  FigureValue(const char* value) : FigureValue(std::string(value)) {}
  FigureValue(double value);
  FigureValue(List value);
  template <std::integral Number>
  FigureValue(Number value) : FigureValue(of_integer(value)) {}
  template <class T>
  FigureValue(const std::vector<T>& values) : FigureValue(List(values.begin(), values.end())) {}
  template <class T, size_t N>
  FigureValue(const std::array<T, N>& values) : FigureValue(List(values.begin(), values.end())) {}

  friend FigureValue shown(FigureValue value, std::string text) {
    value.text_ = std::move(text);
    return value;
  }

 private:
  friend class Verdict;
  using Stored = std::variant<std::nullptr_t, bool, int64_t, uint64_t, double, std::string, List>;

  FigureValue(Stored stored, std::string text)
      : stored_(std::move(stored)), text_(std::move(text)) {}
  template <class Number>
  static FigureValue of_integer(Number value) {
    if constexpr (std::is_same_v<Number, bool>)
      return of_bool(value);
    else if constexpr (std::is_signed_v<Number>)
      return of_signed(value);
    else
      return of_unsigned(value);
  }
  static FigureValue of_bool(bool value);
  static FigureValue of_signed(int64_t value);
  static FigureValue of_unsigned(uint64_t value);

  Stored stored_ = nullptr;
  std::string text_;
};

FigureValue shown(FigureValue value, std::string text);
// `value` in a printf format: "%.1f".
std::string formatted(const char* format, double value);
// A value with that text.
FigureValue rounded(double value, const char* format);

// A key may name a member of a nested object or of a list: "layers/0/name".
class Verdict {
 public:
  // A figure on a line of its own: "label  value unit". A list of texts gets a line for each.
  void add(const std::string& key, std::string label, FigureValue value, std::string unit = {});
  // A figure on the line of the one before: ", value unit".
  void also(const std::string& key, FigureValue value, const std::string& unit = {});
  // What only programs need: names, hashes, and the parts of a value that text shows as a whole.
  void for_programs(const std::string& key, FigureValue value);
  // A line without a figure; an empty label starts at the first column.
  void for_people(std::string label, std::string line);
  // While hidden, figures are only for programs: those that do not apply to this file.
  void hide(bool hidden) { hidden_ = hidden; }

  // Labels are padded to the widest one.
  std::string text() const;
  // One line, or indented by `indent` columns a level. Invalid UTF-8 becomes U+FFFD.
  std::string json(int indent = -1) const;

 private:
  struct TextLine {
    std::string label, text;
  };
  std::vector<std::pair<std::string, FigureValue>> figures_;
  std::vector<TextLine> lines_;
  bool hidden_ = false;
};

}  // namespace svdag
