#include "io/values/text_scan.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "streaming/error.h"

namespace svdag {

void TextScanner::refill() {
  if (here_ != begin_) stream_->skip(size_t(here_ - begin_));
  const auto bytes = stream_->peek(kLookAhead);
  begin_ = here_ = reinterpret_cast<const char*>(bytes.data());
  end_ = begin_ + bytes.size();
  last_ = bytes.size() == stream_->remaining();
  plenty_ = last_ ? end_ : end_ - kLookAhead + 1;
}

// At the end of the window, and where lines are joined.
void TextScanner::skip_blanks_with_care() {
  for (;;) {
    while (here_ != end_ && is_blank(*here_)) ++here_;
    if (here_ >= plenty_ && !last_) {
      refill();
    } else if (here_ == end_ || !at_continuation(here_)) {
      return;
    } else {
      ++here_;
      take_line_end();
    }
  }
}

void TextScanner::take_line_end() {
  const bool pair = end_ - here_ > 1 && here_[0] == '\r' && here_[1] == '\n';
  here_ += pair ? 2 : 1;
  ++line_;
}

// The next '\n', '\r' or '\0', or the end of the window; eight bytes at a time while all are above
// 15.
const char* TextScanner::find_line_end() const {
  const auto ends = [](char c) { return is_line_end(c) || c == '\0'; };
  const char* p = here_;
  while (end_ - p >= 8) {
    uint64_t word;
    std::memcpy(&word, p, sizeof word);
    const uint64_t small = (word - 0x1010101010101010) & ~word & 0x8080808080808080;
    if (small == 0) {
      p += 8;
      continue;
    }
    p += std::countr_zero(small) / 8;  // the lowest flag is right
    if (ends(*p)) return p;
    ++p;
  }
  return std::find_if(p, end_, ends);
}

void TextScanner::skip_rest_of_line() {
  // A comment that ends with a backslash (a path, say) does not swallow the next line.
  const bool comment = at_line_end() && here_ != end_ && *here_ == syntax_.comment;
  for (bool joins = false;;) {
    const char* stop = find_line_end();
    if (stop != here_) joins = stop[-1] == '\\';
    here_ = stop;
    if (here_ != end_ && *here_ == '\0') fail("has a byte of 0");
    if (end_ - here_ < 2 && !last_) {
      refill();
    } else if (here_ == end_) {
      return;
    } else {
      take_line_end();
      if (!joins || comment || !syntax_.continuation) return;
      joins = false;
    }
  }
}

std::string_view TextScanner::rest_of_line() {
  skip_blanks();
  const char* start = here_;
  while (here_ != end_ && !is_line_end(*here_)) {
    if (*here_ == '\0') fail("has a byte of 0");
    if (size_t(here_ - start) >= kLongestWord) fail("has a line that is too long");
    ++here_;
  }
  const char* last = here_;
  while (last != start && is_blank(last[-1])) --last;
  return {start, size_t(last - start)};
}

// from_chars gives no value beyond the range of T; the nearest one is infinity, a subnormal or 0.
template <class T>
T TextScanner::beyond_range(const char* end) const {
  const std::string digits(here_, end);
  if constexpr (sizeof(T) == sizeof(float)) {
    return std::strtof(digits.c_str(), nullptr);
  } else {
    return std::strtod(digits.c_str(), nullptr);
  }
}
template float TextScanner::beyond_range<float>(const char*) const;
template double TextScanner::beyond_range<double>(const char*) const;

void TextScanner::fail_word(const char* wanted) {
  if (at_line_end())
    fail(std::string(here_ == end_ ? "ends" : "has a line that ends") + " where " + wanted +
         " should be");
  std::string found(word().substr(0, 40));
  for (char& c : found) {
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  fail("has \"" + found + "\" where " + wanted + " should be");
}

void TextScanner::fail(const std::string& sentence) const {
  fail_input(stream_->file().path(), sentence + " (line " + std::to_string(line_) + ")");
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (size_t at = 0;;) {
    const size_t begin = line.find_first_not_of(" \t", at);
    if (begin == std::string_view::npos) return words;
    at = std::min(line.find_first_of(" \t", begin), line.size());
    words.emplace_back(line.substr(begin, at - begin));
  }
}

}  // namespace svdag
