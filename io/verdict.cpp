#include "io/verdict.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/json.h"
#include "io/units.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

std::string with_unit(const std::string& value, const std::string& unit) {
  return value + (value.empty() || unit.empty() ? "" : " ") + unit;
}

}  // namespace

FigureValue::FigureValue(std::string value) : FigureValue(Stored(value), printable(value)) {}

FigureValue::FigureValue(double value) : FigureValue(Stored(value), format_double(value)) {}

FigureValue::FigureValue(List value) {
  for (const FigureValue& item : value) text_ += (text_.empty() ? "" : ", ") + item.text_;
  stored_ = std::move(value);
}

FigureValue FigureValue::of_bool(bool value) {
  return {Stored(value), value ? "yes" : "no"};
}

FigureValue FigureValue::of_signed(int64_t value) {
  const uint64_t size = value < 0 ? uint64_t(0) - uint64_t(value) : uint64_t(value);
  return {Stored(value), (value < 0 ? "-" : "") + format_count(size)};
}

FigureValue FigureValue::of_unsigned(uint64_t value) {
  return {Stored(value), format_count(value)};
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

FigureValue rounded(double value, const char* format) {
  return shown(FigureValue(value), formatted(format, value));
}

void Verdict::add(const std::string& key, std::string label, FigureValue value, std::string unit) {
  if (hidden_) return for_programs(key, std::move(value));
  const auto* list = std::get_if<FigureValue::List>(&value.stored_);
  const auto is_text = [](const FigureValue& item) {
    return std::holds_alternative<std::string>(item.stored_);
  };
  if (list != nullptr && std::ranges::all_of(*list, is_text)) {
    for (const FigureValue& item : *list) lines_.push_back({label, with_unit(item.text_, unit)});
  } else {
    lines_.push_back({std::move(label), with_unit(value.text_, unit)});
  }
  for_programs(key, std::move(value));
}

void Verdict::also(const std::string& key, FigureValue value, const std::string& unit) {
  if (!hidden_) lines_.back().text += ", " + with_unit(value.text_, unit);
  for_programs(key, std::move(value));
}

void Verdict::for_programs(const std::string& key, FigureValue value) {
  figures_.emplace_back(key, std::move(value));
}

void Verdict::for_people(std::string label, std::string line) {
  if (hidden_) return;
  lines_.push_back({std::move(label), std::move(line)});
}

std::string Verdict::text() const {
  size_t width = 0;
  for (const TextLine& line : lines_) width = std::max(width, line.label.size());
  std::string text;
  for (const TextLine& line : lines_) {
    if (!line.label.empty()) text += line.label + std::string(width + 2 - line.label.size(), ' ');
    text += line.text + "\n";
  }
  return text;
}

std::string Verdict::json(int indent) const {
  using Json = nlohmann::ordered_json;
  const auto to_json = [](const auto& self, const FigureValue& value) -> Json {
    if (const auto* list = std::get_if<FigureValue::List>(&value.stored_)) {
      Json json = Json::array();
      for (const FigureValue& item : *list) json.push_back(self(self, item));
      return json;
    }
    return std::visit(
        [](const auto& stored) -> Json {
          if constexpr (std::is_same_v<std::decay_t<decltype(stored)>, FigureValue::List>)
            return nullptr;
          else
            return stored;
        },
        value.stored_);
  };
  Json json = Json::object();
  for (const auto& [key, value] : figures_)
    json[Json::json_pointer("/" + key)] = to_json(to_json, value);
  return json_text(json, indent);
}

}  // namespace svdag
