// Words and numbers of a text file, through the small window of a ByteStream.
//
// Lines end with "\n", "\r\n" or "\r"; blanks are spaces and tabs. Decimal numbers become the
// nearest double (or float), whatever the locale (io/values/decimal.h), with a leading "+"
// allowed. A zero byte is an error anywhere, in skipped text too: holes left by a crash or an
// incomplete copy are zeros, and would hide the lines that they cover. Invariant: after
// skip_blanks() a whole word is visible, or the word is too long to be one. Rejected: iostreams (20
// times slower), strtod (locale), reading line by line (every byte twice).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/values/decimal.h"
#include "streaming/file/byte_stream.h"

namespace svdag {

// Some editors put this before UTF-8 text.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

class TextScanner {
 public:
  struct Syntax {
    char comment = '\n';        // at the start of a word: the rest of the line is a comment; a line
                                // end (which ends the line anyway): no comments
    bool continuation = false;  // a backslash before the line's end joins the next line
  };
  static constexpr size_t kLongestWord = 4096;

  // Scans from the position of `stream`, which is in line number `line`.
  TextScanner(ByteStream* stream, Syntax syntax, uint64_t line = 1)
      : stream_(stream), syntax_(syntax), line_(line) {
    refill();
    if (line == 1 && (visible().starts_with("\xFF\xFE") || visible().starts_with("\xFE\xFF")))
      fail("is UTF-16 text: convert it to UTF-8");
    if (line == 1 && visible().starts_with(kByteOrderMark)) here_ += kByteOrderMark.size();
  }

  uint64_t line() const { return line_; }
  uint64_t offset() const { return stream_->offset() + size_t(here_ - begin_); }
  uint64_t remaining() const { return stream_->remaining() - size_t(here_ - begin_); }

  // Whether only blanks and a comment are left in this line.
  bool at_line_end() {
    skip_blanks();
    return here_ == end_ || is_line_end(*here_) || *here_ == syntax_.comment;
  }
  void next_line() {
    if (here_ != end_ && *here_ == '\n') {
      ++here_;
      ++line_;
    } else {
      skip_rest_of_line();
    }
  }
  // Moves over blanks, line ends and comments; true at the end of the file.
  bool at_end() {
    while (at_line_end()) {
      if (here_ == end_) return true;
      next_line();
    }
    return false;
  }

  // Whether the word just scanned ends here (an integer may end at its `stop`).
  bool at_word_end() const { return ends_word(here_); }
  // The first character of the next word, '\0' at the line's end.
  char next_letter() { return at_line_end() ? '\0' : *here_; }

  // The next word of this line, "" at its end; valid until the next call.
  std::string_view word() {
    if (at_line_end()) return {};
    const char* start = here_;
    const char* p = start;
    while (p != end_ && !ends_word(p)) ++p;
    here_ = p;
    if (size_t(p - start) > kLongestWord) fail("has a word that is too long");
    if (std::find(start, p, '\0') != p) fail("has a byte of 0");
    return {start, size_t(p - start)};
  }
  // What is left of this line, blanks at its ends and comments included; valid until the next call.
  std::string_view rest_of_line();

  // The next word of this line as a number; anything else fails.
  double number() { return decimal<double>(); }
  float number32() { return decimal<float>(); }
  // As many numbers as follow in this line, at most those that `out` has room for.
  size_t numbers(std::span<double> out) {
    size_t n = 0;
    while (n < out.size() && !at_line_end() &&
           std::string_view("+-.0123456789").find(*here_) != std::string_view::npos)
      out[n++] = number();
    return n;
  }
  // As number(), for integers; `stop` may end the word too and is not consumed.
  int64_t integer(char stop = '\0') {
    skip_blanks();
    const char* p = here_;
    const bool negative = p != end_ && *p == '-';
    if (p != end_ && (*p == '-' || *p == '+')) ++p;
    const char* first = p;
    int64_t value = 0;
    while (p != end_ && *p >= '0' && *p <= '9' && p - first < kMaxDigits)
      value = 10 * value + (*p++ - '0');
    if (p == first || !(ends_word(p) || (p != end_ && *p == stop && stop != '\0')))
      fail_word("an integer");
    here_ = p;
    return negative ? -value : value;
  }
  // Moves on within a word, over the characters that `belongs` accepts.
  template <class Belongs>
  void skip_while(Belongs belongs) {
    const char* p = here_;
    while (p != end_ && belongs(*p)) ++p;
    here_ = p;
  }

  // For readers with a fast path for plain lines: the bytes in the window from here on, and a
  // position in them, on this line, at which to continue.
  std::string_view visible() const { return {here_, size_t(end_ - here_)}; }
  void skip_to(const char* place) { here_ = place; }

  // Throws the Error about a damaged file, with the number of this line.
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  static constexpr size_t kLookAhead = kLongestWord + 2;
  static constexpr int kMaxDigits = 18;  // of an int64, without overflow

  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

  void skip_blanks() {
    const char* p = here_;
    while (p < plenty_ && is_blank(*p)) ++p;
    here_ = p;
    if (p >= plenty_ || *p == '\\') skip_blanks_with_care();
  }
  void skip_blanks_with_care();
  bool at_continuation(const char* p) const {
    return syntax_.continuation && *p == '\\' && p + 1 != end_ && is_line_end(p[1]);
  }
  bool ends_word(const char* p) const {
    if (p == end_) return last_;
    if (*p > ' ' && *p != '\\') return false;
    return is_blank(*p) || is_line_end(*p) || at_continuation(p);
  }
  // from_chars accepts no "+", and must not get the "-1" of "+-1".
  const char* behind_plus() const {
    const bool plus = end_ - here_ > 1 && here_[0] == '+' && here_[1] != '-';
    return here_ + (plus ? 1 : 0);
  }
  template <class T>
  T decimal() {
    skip_blanks();
    T value = 0;
    const auto [end, error] = parse_decimal(behind_plus(), end_, value);
    if (error == std::errc::result_out_of_range) {
      value = beyond_range<T>(end);
    } else if (error != std::errc{}) {
      fail_word("a number");
    }
    if (!ends_word(end)) fail_word("a number");
    here_ = end;
    return value;
  }
  template <class T>
  T beyond_range(const char* end) const;
  const char* find_line_end() const;
  void skip_rest_of_line();
  void take_line_end();
  void refill();
  [[noreturn]] void fail_word(const char* wanted);

  ByteStream* stream_;
  Syntax syntax_;
  uint64_t line_;
  // The visible bytes, the next one to scan, and whether the file ends with them.
  const char* begin_ = nullptr;
  const char* here_ = nullptr;
  const char* end_ = nullptr;
  bool last_ = false;
  const char* plenty_ = nullptr;  // before this a whole word is visible
};

// The words of a line, which blanks and tabs separate.
std::vector<std::string> words_of(std::string_view line);

}  // namespace svdag
