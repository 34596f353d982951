#include "lang/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "expr/rational.h"

namespace rondo::lang {
namespace {

using diag::Kind;
using diag::Span;

// Longest first.
constexpr std::array<std::string_view, 38> kPunctuation = {
    "<=>", "..", "==", "!=", "<=", ">=", "&&", "||", "<<", "->", "++", "+=", "=>",
    "(",   ")",  "[",  "]",  "{",  "}",  ":",  ";",  ",",  ".",  "+",  "-",  "*",
    "/",   "%",  "=",  "<",  ">",  "!",  "&",  "|",  "?",  "@",  "'",  "\\"};

struct Spelling {
  std::string_view sign;
  std::string_view canonical;
  bool word;
};
constexpr std::array<Spelling, 6> kSigns = {{{"\xE2\x89\xA4", "<=", false},
                                             {"\xE2\x89\xA5", ">=", false},
                                             {"\xE2\x89\xA0", "!=", false},
                                             {"\xE2\x88\xA7", "and", true},
                                             {"\xE2\x88\xA8", "or", true},
                                             {"\xC2\xAC", "not", true}}};

// A line that starts in the first column with one of these ends any bracket that is still open.
constexpr std::array<std::string_view, 11> kSectionWords = {"using",   "def",       "allread",   "allwrite",
                                                            "local",   "init",      "param",     "assume",
                                                            "summary", "invariant", "SafetyProp"};

bool IsNameStart(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool IsNamePart(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

class Lexer {
 public:
  Lexer(const diag::SourceSet& sources, diag::FileId file, const LexerOptions& options,
        diag::Diagnostics& diagnostics)
      : file_(file), text_(sources.text(file)), options_(options), diagnostics_(diagnostics) {}

  TokenStream Run() {
    while (at_ < text_.size()) {
      if (line_start_) StartLine();
      if (at_ < text_.size() && !line_start_) Next();
    }
    CloseBrackets("the end of the file");
    EndLine();
    while (indents_.size() > 1) {
      indents_.pop_back();
      Emit(TokenKind::kDedent, at_, at_);
    }
    Emit(TokenKind::kEnd, at_, at_);
    return std::move(stream_);
  }

 private:
  struct Bracket {
    char open;
    Span span;
  };

  Span Range(size_t begin, size_t end) const {
    return {file_, static_cast<uint32_t>(begin), static_cast<uint32_t>(end)};
  }
  char Peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool AtLineEnd() const {
    return at_ >= text_.size() || Peek() == '\n' || (Peek() == '\r' && Peek(1) == '\n');
  }

  void Emit(TokenKind kind, size_t begin, size_t end) {
    Emit(kind, begin, end, text_.substr(begin, end - begin));
  }
  void Emit(TokenKind kind, size_t begin, size_t end, std::string_view text) {
    stream_.tokens.push_back({kind, Range(begin, end), text});
    if (kind != TokenKind::kIndent && kind != TokenKind::kDedent) blank_ = kind == TokenKind::kNewline;
  }

  void SkipLineEnd() {
    if (Peek() == '\r') ++at_;
    if (Peek() == '\n') ++at_;
    ++line_;
    line_start_ = true;
  }

  // Measures the indentation of a line that has content; blank and comment lines pass without a trace.
  void StartLine() {
    const size_t begin = at_;
    size_t width = 0;
    for (; Peek() == ' ' || Peek() == '\t' || Peek() == '\f'; ++at_) {
      if (Peek() == '\t' && !tab_reported_ && options_.indentation) {
        tab_reported_ = true;
        diagnostics_.Report(Kind::kSyntaxTab, Range(at_, at_ + 1), "a tab in the indentation")
            .Under("counts up to the next multiple of 8 columns")
            .Help("`rondo fmt` indents with spaces");
      }
      width = Peek() == '\t' ? (width / 8 + 1) * 8 : width + 1;
    }
    if (AtLineEnd()) {
      if (at_ < text_.size()) SkipLineEnd();
      return;
    }
    line_start_ = false;
    if (IsComment()) {
      ReadComment(true);
      if (at_ < text_.size()) SkipLineEnd();
      return;
    }
    if (options_.indentation && !brackets_.empty() && width == 0 && StartsSection())
      CloseBrackets("the next section");
    if (!options_.indentation || !brackets_.empty() || joined_) {
      joined_ = false;
      return;
    }
    if (width > indents_.back()) {
      indents_.push_back(width);
      Emit(TokenKind::kIndent, begin, at_);
      return;
    }
    while (width < indents_.back()) {
      const size_t outer = indents_[indents_.size() - 2];
      if (width > outer) {
        diagnostics_
            .Report(Kind::kSyntaxIndentation, Range(begin, at_),
                    "this line is indented like no line above it")
            .Under(fmt::format("{} columns", width))
            .Help(fmt::format("indent by {} or {} columns", outer, indents_.back()));
        return;  // go on as if it stood in the inner block
      }
      indents_.pop_back();
      Emit(TokenKind::kDedent, at_, at_);
    }
  }

  bool StartsSection() const {
    size_t end = at_;
    while (end < text_.size() && IsNamePart(text_[end])) ++end;
    const std::string_view word = text_.substr(at_, end - at_);
    if (word.empty()) return false;
    return std::find(kSectionWords.begin(), kSectionWords.end(), word) != kSectionWords.end() ||
           (end < text_.size() && text_[end] == ':');
  }

  void CloseBrackets(std::string_view before) {
    if (brackets_.empty()) return;
    diagnostics_
        .Report(Kind::kSyntaxUnexpected, brackets_.back().span,
                fmt::format("`{}` is never closed", brackets_.back().open))
        .Under(fmt::format("no matching bracket before {}", before));
    brackets_.clear();
    EndLine();
  }

  void EndLine() {
    if (options_.indentation && !blank_) Emit(TokenKind::kNewline, at_, at_);
  }

  bool IsComment() const { return Peek() == '#' || (Peek() == '/' && Peek(1) == '/'); }

  void ReadComment(bool alone) {
    const size_t begin = at_;
    while (!AtLineEnd()) ++at_;
    std::string_view body = text_.substr(begin, at_ - begin);
    body.remove_prefix(body[0] == '#' ? 1 : 2);
    while (!body.empty() && std::isspace(static_cast<unsigned char>(body.front()))) body.remove_prefix(1);
    while (!body.empty() && std::isspace(static_cast<unsigned char>(body.back()))) body.remove_suffix(1);
    stream_.comments.push_back({Range(begin, at_), line_, alone, std::string(body)});
  }

  void Next() {
    const size_t begin = at_;
    const char c = Peek();
    if (AtLineEnd()) {
      if (brackets_.empty()) EndLine();
      SkipLineEnd();
      return;
    }
    if (c == ' ' || c == '\t' || c == '\f' || c == '\r') {
      ++at_;
      return;
    }
    if (IsComment()) return ReadComment(false);
    if (c == '\\') {
      size_t ahead = 1;
      while (Peek(ahead) == ' ' || Peek(ahead) == '\t' || Peek(ahead) == '\r') ++ahead;
      if (Peek(ahead) == '\n' || at_ + ahead >= text_.size()) {
        at_ += ahead;
        if (at_ < text_.size()) SkipLineEnd();
        joined_ = true;
        return;
      }
    }
    if (IsNameStart(c)) {
      while (IsNamePart(Peek())) ++at_;
      return Emit(TokenKind::kName, begin, at_);
    }
    if (IsDigit(c) || (c == '.' && IsDigit(Peek(1)))) return ReadNumber();
    if (c == '"' || (c == '\'' && !options_.prime)) return ReadString(c);
    for (const Spelling& spelling : kSigns) {
      if (!text_.substr(at_).starts_with(spelling.sign)) continue;
      at_ += spelling.sign.size();
      return Emit(spelling.word ? TokenKind::kName : TokenKind::kPunctuation, begin, at_, spelling.canonical);
    }
    for (const std::string_view sign : kPunctuation) {
      if (!text_.substr(at_).starts_with(sign)) continue;
      if (sign == "?" || (sign == "@" && !options_.at) || sign == "\\" || sign == "&" ||
          (sign == "|" && !options_.bar))
        break;
      at_ += sign.size();
      return ReadPunctuation(begin, sign);
    }
    ++at_;
    while (at_ < text_.size() && (static_cast<unsigned char>(Peek()) & 0xC0u) == 0x80u) ++at_;
    auto& report = diagnostics_.Report(Kind::kSyntaxUnknownCharacter, Range(begin, at_),
                                       "a character that means nothing here");
    if (c == '&') report.Help("write `and`");
    if (c == '|') report.Help("write `or`");
  }

  void ReadPunctuation(size_t begin, std::string_view sign) {
    const char c = sign[0];
    if (sign.size() == 1 && (c == '(' || c == '[' || c == '{')) brackets_.push_back({c, Range(begin, at_)});
    if (sign.size() == 1 && (c == ')' || c == ']' || c == '}')) {
      const char open = c == ')' ? '(' : c == ']' ? '[' : '{';
      // One that closes nothing is a matter of the parser, which knows what should stand there instead.
      const bool half_open =
          options_.half_open && c == ')' && !brackets_.empty() && brackets_.back().open == '[';
      if (half_open || (!brackets_.empty() && brackets_.back().open == open)) brackets_.pop_back();
    }
    Emit(TokenKind::kPunctuation, begin, at_, sign);
  }

  // 12, 1.5, .5, 5., 1e-3, 2.5e6; `0..5` is not a number followed by `.5`.
  void ReadNumber() {
    const size_t begin = at_;
    bool is_float = false;
    while (IsDigit(Peek())) ++at_;
    if (Peek() == '.' && Peek(1) != '.' && !IsNameStart(Peek(1))) {
      is_float = true;
      ++at_;
      while (IsDigit(Peek())) ++at_;
    }
    if ((Peek() == 'e' || Peek() == 'E') &&
        (IsDigit(Peek(1)) || ((Peek(1) == '+' || Peek(1) == '-') && IsDigit(Peek(2))))) {
      is_float = true;
      at_ += 2;
      while (IsDigit(Peek())) ++at_;
    }
    if (IsNamePart(Peek())) {
      while (IsNamePart(Peek())) ++at_;
      diagnostics_.Report(Kind::kSyntaxNumber, Range(begin, at_),
                          "not a number, and a name cannot start with a digit");
      return Emit(TokenKind::kInt, begin, at_, "0");
    }
    if (options_.doubles && is_float && !IsExact(text_.substr(begin, at_ - begin))) {
      diagnostics_
          .Report(Kind::kSyntaxNumber, Range(begin, at_), "this number is too large or too small to be read")
          .Help("zero, and sizes from 2.3e-308 to 1.7e308, can be read");
      return Emit(TokenKind::kFloat, begin, at_, "0.0");
    }
    Emit(is_float ? TokenKind::kFloat : TokenKind::kInt, begin, at_);
  }

  // Proofs have the number itself and robots a double near it: one that is neither zero nor infinite.
  static bool IsExact(std::string_view text) {
    const auto number = expr::Rational::Parse(text);
    return number && (number->IsZero() || std::isnormal(number->ToDouble()));
  }

  void ReadString(char quote) {
    const size_t begin = at_++;
    while (at_ < text_.size() && Peek() != quote && Peek() != '\n')
      at_ += Peek() == '\\' && at_ + 1 < text_.size() && Peek(1) != '\n' ? 2 : 1;
    if (Peek() == quote) {
      ++at_;
    } else {
      diagnostics_.Report(Kind::kSyntaxUnterminatedString, Range(begin, at_), "a string without an end")
          .Under("the line ends before the closing quote");
    }
    Emit(TokenKind::kString, begin, at_);
  }

  diag::FileId file_;
  std::string_view text_;
  LexerOptions options_;
  diag::Diagnostics& diagnostics_;
  TokenStream stream_;
  std::vector<size_t> indents_{0};
  std::vector<Bracket> brackets_;
  size_t at_ = 0;
  uint32_t line_ = 1;
  bool line_start_ = true;
  bool joined_ = false;
  bool blank_ = true;  // no token since the last line end
  bool tab_reported_ = false;
};

}  // namespace

TokenStream Lex(const diag::SourceSet& sources, diag::FileId file, const LexerOptions& options,
                diag::Diagnostics& diagnostics) {
  return Lexer(sources, file, options, diagnostics).Run();
}

std::string Describe(const Token& token) {
  switch (token.kind) {
    case TokenKind::kEnd:
      return "the end of the file";
    case TokenKind::kNewline:
      return "the end of the line";
    case TokenKind::kIndent:
      return "a deeper line";
    case TokenKind::kDedent:
      return "the end of the block";
    case TokenKind::kString:
      return "a string";
    case TokenKind::kName:
    case TokenKind::kInt:
    case TokenKind::kFloat:
    case TokenKind::kPunctuation:
      break;
  }
  return fmt::format("`{}`", token.text);
}

}  // namespace rondo::lang
