#include "choreo/syntax/format.h"

#include <algorithm>
#include <array>

#include "choreo/syntax/parser.h"
#include "diag/diagnostic.h"

namespace rondo::choreo {
namespace {

using lang::Token;
using lang::TokenKind;

template <size_t N>
bool OneOf(std::string_view text, const std::array<std::string_view, N>& list) {
  return std::ranges::find(list, text) != list.end();
}

// What an expression goes on with, or goes on behind.
constexpr std::array<std::string_view, 20> kOperators = {"and", "or", "implies", "not", "==", "!=", "<",
                                                         "<=",  ">",  ">=",      "+",   "-",  "*",  "/",
                                                         "%",   "=",  "->",      "=>",  "|",  "in"};
// Words behind which a bracket is not that of a call.
constexpr std::array<std::string_view, 22> kBeforeBracket = {
    "and",    "or",        "implies",   "not", "in",        "at",    "when", "while",
    "region", "assume",    "guarantee", "pre", "during",    "post",  "body", "hull",
    "from",   "initially", "choose",    "if",  "footprint", "forall"};
constexpr std::array<std::string_view, 3> kFacts = {"region", "assume", "guarantee"};
constexpr std::array<std::string_view, 2> kKinds = {"interruptible", "noninterruptible"};

class Formatter {
 public:
  Formatter(const diag::SourceSet& sources, diag::FileId file, const lang::TokenStream& stream)
      : text_(sources.text(file)), stream_(stream) {}

  std::string Run() {
    for (index_ = 0; index_ < stream_.tokens.size(); ++index_) {
      const Token& token = stream_.tokens[index_];
      Comments(token.span.begin);
      if (token.kind == TokenKind::kEnd) break;
      Put(token);
    }
    Comments(text_.size());
    if (!out_.empty() && out_.back() != '\n') out_ += '\n';
    return std::move(out_);
  }

 private:
  // How many lines end between two places.
  size_t LinesBetween(size_t from, size_t to) const {
    return static_cast<size_t>(std::count(text_.begin() + static_cast<ptrdiff_t>(from),
                                          text_.begin() + static_cast<ptrdiff_t>(std::max(from, to)), '\n'));
  }

  void Comments(size_t before) {
    for (; comment_ < stream_.comments.size(); ++comment_) {
      const lang::Comment& c = stream_.comments[comment_];
      if (c.span.begin >= before) return;
      const size_t lines = LinesBetween(end_, c.span.begin);
      if (lines > 0 || out_.empty()) {
        Break(lines, false);
        out_ += std::string(2 * depth_ + (brackets_ > 0 ? 4 : 0), ' ');
      } else {
        out_ += "  ";
      }
      out_ += c.text.empty() ? "#" : "# " + c.text;
      end_ = c.span.end;
      commented_ = true;
    }
  }

  void Break(size_t lines, bool closes) {
    if (out_.empty()) return;
    out_ += '\n';
    if (lines > 1 && !closes && !(opened_ && !commented_)) out_ += '\n';
  }

  void Put(const Token& token) {
    const std::string_view t = token.text;
    const size_t lines = LinesBetween(end_, token.span.begin);
    const bool closes = t == "}";
    if (closes && depth_ > 0) --depth_;
    if (out_.empty()) {
      // the beginning
    } else if (lines > 0 || commented_) {
      Break(std::max<size_t>(lines, 1), closes);
      out_ += std::string(2 * depth_ + (Continues(token) ? 4 : 0), ' ');
    } else if (Gap(token)) {
      out_ += ' ';
    }
    out_ += t;
    Remember(token);
  }

  void Remember(const Token& token) {
    const std::string_view t = token.text;
    if (t == "{") ++depth_;
    if (t == "(" || t == "[") ++brackets_;
    if ((t == ")" || t == "]") && brackets_ > 0) --brackets_;
    // `thread` and `motion` go on over several lines, up to their brace.
    if (token.kind == TokenKind::kName && (t == "thread" || t == "motion") && brackets_ == 0) header_ = true;
    if (t == "{" || t == "}") header_ = false;
    unary_ = t == "-" && !EndsValue();
    previous_ = token;
    opened_ = t == "{";
    commented_ = false;
    end_ = token.span.end;
  }

  // Could what stands before be the end of a value? Then a sign is a binary one.
  bool EndsValue() const {
    switch (previous_.kind) {
      case TokenKind::kInt:
      case TokenKind::kFloat:
      case TokenKind::kString:
        return true;
      case TokenKind::kName:
        return !OneOf(previous_.text, kOperators) && !OneOf(previous_.text, kBeforeBracket);
      case TokenKind::kPunctuation:
        return previous_.text == ")" || previous_.text == "]" || previous_.text == "}";
      case TokenKind::kEnd:
      case TokenKind::kNewline:
      case TokenKind::kIndent:
      case TokenKind::kDedent:
        break;
    }
    return false;
  }

  // Does the line go on with what the one before began?
  bool Continues(const Token& token) const {
    const std::string_view t = token.text;
    if (t == "}" || t == "{" || previous_.text == "}") return false;
    if (brackets_ > 0 || t == ")" || t == "]") return true;
    if (t == ",") return true;
    if (previous_.text == ",") return !AtCall();
    if (OneOf(previous_.text, kOperators) || OneOf(previous_.text, kBeforeBracket)) return true;
    if (OneOf(t, kOperators)) return true;
    return header_ && (OneOf(t, kFacts) || OneOf(t, kKinds));
  }

  // The motions of a joint step stand one below the other: `a: Move(),` and `b: Idle()`.
  bool AtCall() const { return index_ + 1 < stream_.tokens.size() && stream_.tokens[index_ + 1].text == ":"; }

  bool Gap(const Token& token) const {
    const std::string_view a = previous_.text, b = token.text;
    if (a == "(" || a == "[" || b == ")" || b == "]" || b == "," || b == ";" || b == ":") return false;
    if (a == "." || b == "." || b == "'") return false;
    if (a == "{" && b == "}") return false;
    if (unary_) return false;
    if (b == "(") {
      return previous_.kind != TokenKind::kName || OneOf(a, kBeforeBracket) || OneOf(a, kOperators);
    }
    return true;
  }

  std::string_view text_;
  const lang::TokenStream& stream_;
  std::string out_;
  size_t index_ = 0;    // of the token that is put
  size_t comment_ = 0;  // of the next comment
  size_t end_ = 0;      // of what was put last, in the source
  size_t depth_ = 0;    // of blocks
  int brackets_ = 0;
  bool header_ = false;
  bool unary_ = false;
  bool opened_ = false;
  bool commented_ = false;  // a comment was put last: a new line has to begin
  Token previous_{};
};

}  // namespace

lang::TokenStream Tokens(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics) {
  return lang::Lex(sources, file, RondoLexer(), diagnostics);
}

std::string Format(const diag::SourceSet& sources, diag::FileId file, const lang::TokenStream& stream) {
  return Formatter(sources, file, stream).Run();
}

}  // namespace rondo::choreo
