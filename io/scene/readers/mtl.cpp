#include "io/scene/readers/mtl.h"

#include <filesystem>
#include <sstream>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kHead = size_t(1) << 16;
constexpr uint64_t kLargestMtl = uint64_t(64) << 20;

std::string text_of(const File& file, uint64_t most) {
  std::string text(size_t(std::min(file.size(), most)), '\0');
  text.resize(file.read_some_at(0, std::as_writable_bytes(std::span(text))));
  return text;
}

// The rest of a line after its first word, without spaces around it.
std::string rest_of(std::istringstream& line) {
  std::string rest;
  std::getline(line >> std::ws, rest);
  while (!rest.empty() && (rest.back() == '\r' || rest.back() == ' ' || rest.back() == '\t'))
    rest.pop_back();
  return rest;
}

// Calls visit(word, line) for each line, its first word read.
template <class Visit>
void for_each_line(const std::string& text, const Visit& visit) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (words >> word) visit(word, words);
  }
}

}  // namespace

std::vector<std::string> mtl_paths(const File& obj) {
  std::vector<std::string> paths;
  const std::filesystem::path folder = std::filesystem::path(obj.path()).parent_path();
  for_each_line(text_of(obj, kHead), [&](const std::string& word, std::istringstream& line) {
    if (word != "mtllib") return;
    const std::string path = (folder / rest_of(line)).string();
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) paths.push_back(path);
  });
  return paths;
}

std::map<std::string, Colour> read_mtl_colours(const File& obj) {
  std::map<std::string, Colour> colours;
  for (const std::string& path : mtl_paths(obj)) {
    std::string material;
    for_each_line(text_of(File::open_read(path), kLargestMtl),
                  [&](const std::string& word, std::istringstream& line) {
                    double r = 0, g = 0, b = 0;
                    if (word == "newmtl") material = rest_of(line);
                    if (word == "Kd" && line >> r >> g >> b)
                      colours[material] = {colour_code(r), colour_code(g), colour_code(b)};
                  });
  }
  return colours;
}

}  // namespace svdag
