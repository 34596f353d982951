#include "lang/smtlib/sexpr.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace rondo::lang::smtlib {
namespace {

using diag::Kind;
using diag::Span;

class Reader {
 public:
  Reader(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics)
      : text_(sources.text(file)), file_(file), diagnostics_(diagnostics) {}

  std::vector<SExpr> Run() {
    std::vector<SExpr> open;  // the lists that have begun, outermost first
    std::vector<SExpr> result;
    const auto add = [&](SExpr e) {
      if (open.empty()) {
        result.push_back(std::move(e));
      } else {
        open.back().items.push_back(std::move(e));
      }
    };
    while (SkipBlanks()) {
      const auto begin = static_cast<uint32_t>(at_);
      const char c = text_[at_];
      if (c == '(' || c == '[') {
        ++at_;
        if (open.size() == kDeepest) {
          diagnostics_.Report(Kind::kSyntaxNesting, {file_, begin, begin + 1}, "nested too deeply");
          return {};
        }
        open.push_back(
            {c == '(' ? SExpr::Kind::kList : SExpr::Kind::kBracket, "", {}, {file_, begin, begin + 1}});
      } else if (c == ')' || c == ']') {
        ++at_;
        const bool matches = !open.empty() && (c == ')') == open.back().IsList();
        if (!matches) {
          diagnostics_.Report(Kind::kSmtSyntax, {file_, begin, begin + 1},
                              fmt::format("`{}` closes nothing", c));
          continue;
        }
        SExpr done = std::move(open.back());
        open.pop_back();
        done.span.end = static_cast<uint32_t>(at_);
        add(std::move(done));
      } else if (auto atom = Atom()) {
        add(std::move(*atom));
      }
    }
    if (!open.empty()) {
      diagnostics_.Report(Kind::kSmtSyntax, open.back().span, "this list is not closed")
          .Under("opened here")
          .Help("add `)` at its end");
    }
    return result;
  }

 private:
  bool SkipBlanks() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == ';') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
        ++at_;
      } else {
        return true;
      }
    }
    return false;
  }

  std::optional<SExpr> Atom() {
    const size_t begin = at_;
    const auto span = [&] { return Span{file_, static_cast<uint32_t>(begin), static_cast<uint32_t>(at_)}; };
    const char c = text_[at_];
    if (c == '|' || c == '"') {
      const size_t end = text_.find(c, at_ + 1);
      if (end == std::string_view::npos) {
        at_ = text_.size();
        diagnostics_.Report(Kind::kSmtSyntax,
                            {file_, static_cast<uint32_t>(begin), static_cast<uint32_t>(begin + 1)},
                            fmt::format("`{}` has no end", c));
        return std::nullopt;
      }
      at_ = end + 1;
      return SExpr{c == '|' ? SExpr::Kind::kSymbol : SExpr::Kind::kString,
                   std::string(text_.substr(begin + 1, end - begin - 1)),
                   {},
                   span()};
    }
    static constexpr std::string_view kEnds = "()[]; \t\r\n\"|,";
    while (at_ < text_.size() && kEnds.find(text_[at_]) == std::string_view::npos &&
           static_cast<unsigned char>(text_[at_]) > 0x20)
      ++at_;
    if (at_ == begin) {
      ++at_;
      // The comma of `[0, 1]` in a declaration is a blank.
      if (c != ',') diagnostics_.Report(Kind::kSmtSyntax, span(), "this character means nothing here");
      return std::nullopt;
    }
    return SExpr{SExpr::Kind::kSymbol, std::string(text_.substr(begin, at_ - begin)), {}, span()};
  }

  std::string_view text_;
  diag::FileId file_;
  diag::Diagnostics& diagnostics_;
  size_t at_ = 0;
};

}  // namespace

std::vector<SExpr> ReadSExprs(const diag::SourceSet& sources, diag::FileId file,
                              diag::Diagnostics& diagnostics) {
  return Reader(sources, file, diagnostics).Run();
}

}  // namespace rondo::lang::smtlib
