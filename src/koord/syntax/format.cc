#include "koord/syntax/format.h"

#include <fmt/format.h>

#include <algorithm>

#include "lang/expr_printer.h"
#include "lang/expr_queries.h"

namespace rondo::koord {
namespace {

using lang::PrintExpr;
using lang::PrintType;

class Formatter {
 public:
  // Without sources: no comments and no blank lines of the author.
  Formatter(const diag::SourceSet* sources, const Program& program) : sources_(sources), program_(program) {
    if (sources != nullptr) comments_ = program.comments;
  }

  std::string Run() {
    for (size_t i = 0; i < program_.items.size(); ++i) {
      const diag::Span span = program_.item_spans[i];
      const bool spec = IsSpecLine(program_.items[i]);
      // One blank line between sections; specifications that belong together stay together.
      if (i > 0 && !(spec && IsSpecLine(program_.items[i - 1]) && !AuthorLeftBlank(span))) gap_ = true;
      std::visit([&](const auto& item) { Print(item); }, program_.items[i]);
    }
    FlushComments(UINT32_MAX);
    return std::move(out_);
  }

 private:
  static bool IsSpecLine(const Item& item) {
    return std::holds_alternative<ParamDef>(item) || std::holds_alternative<AssumeDef>(item) ||
           std::holds_alternative<SummaryDef>(item) || std::holds_alternative<InvariantDef>(item) ||
           std::holds_alternative<ResponseDef>(item) ||
           (std::holds_alternative<FunctionDef>(item) && !std::get<FunctionDef>(item).has_body);
  }

  uint32_t LineOf(diag::Span span) const { return sources_->Locate(span.file, span.begin).line; }
  bool AuthorLeftBlank(diag::Span span) const {
    if (sources_ == nullptr) return false;
    uint32_t line = LineOf(span);
    // Comments above an item belong to it.
    while (line > 1 && next_comment_ < comments_.size() &&
           std::any_of(comments_.begin() + next_comment_, comments_.end(),
                       [&](const lang::Comment& c) { return c.alone && c.line == line - 1; })) {
      --line;
    }
    return line > 1 &&
           sources_->Line(span.file, line - 1).find_first_not_of(" \t\r") == std::string_view::npos;
  }

  void FlushComments(uint32_t before) {
    for (; next_comment_ < comments_.size() && comments_[next_comment_].line < before; ++next_comment_) {
      const lang::Comment& comment = comments_[next_comment_];
      Raw(comment.text.empty() ? "#" : "# " + comment.text);
      // A comment that stands apart stays apart.
      const std::string_view below = sources_->Line(comment.span.file, comment.line + 1);
      if (comment.alone && below.find_first_not_of(" \t\r") == std::string_view::npos) gap_ = true;
    }
  }

  void Raw(const std::string& text) {
    if (gap_ && !out_.empty()) out_ += "\n";
    gap_ = false;
    out_ += std::string(static_cast<size_t>(depth_) * 4, ' ') + text + "\n";
  }

  // One line of output that stands for what begins at `span`; comments above it come first, one behind it at
  // its end.
  void Line(diag::Span span, std::string text) {
    if (sources_ != nullptr && span.file.valid()) {
      const uint32_t line = LineOf(span);
      FlushComments(line);
      const uint32_t end = sources_->Locate(span.file, span.end).line;
      if (next_comment_ < comments_.size() && comments_[next_comment_].line <= end &&
          (next_comment_ + 1 == comments_.size() || comments_[next_comment_ + 1].line > end)) {
        const std::string& comment = comments_[next_comment_++].text;
        text += comment.empty() ? "  #" : "  # " + comment;
      } else {
        FlushComments(end + 1);
      }
    }
    Raw(text);
  }

  std::string Text(ExprId e) const { return PrintExpr(program_.exprs, e); }
  std::string Text(const lang::TypeSyntax& t) const { return PrintType(program_.exprs, t); }

  std::string Text(const Decl& d) const {
    std::string text =
        d.members.empty() ? Text(d.type) : fmt::format("enum {{{}}}", fmt::join(d.members, ", "));
    text += " " + d.name;
    for (const ExprId dim : d.dimensions) text += fmt::format("[{}]", dim.valid() ? Text(dim) : "");
    if (d.initial.valid()) text += " = " + Text(d.initial);
    return text;
  }

  void Decls(const std::vector<Decl>& decls) {
    ++depth_;
    for (const Decl& d : decls) Line(d.span, Text(d));
    --depth_;
  }

  void Print(const AgentHeader& item) { Line(item.span, "agent " + item.name); }

  void Print(const FunctionDef& item) {
    std::string parameters;
    for (const Decl& p : item.parameters) parameters += (parameters.empty() ? "" : ", ") + Text(p);
    std::string head = fmt::format("def fun {}({})", item.name, parameters);
    if (!item.result.name.empty()) head += " -> " + Text(item.result);
    if (!item.has_body) return Line(item.span, head);
    Line(item.span, head + ":");
    Body(item.body);
  }
  void Print(const AdtDef& item) {
    Line(item.span, fmt::format("def adt {}:", item.name));
    Decls(item.fields);
  }
  void Print(const EnumDef& item) {
    Line(item.span, fmt::format("def {} {{{}}}", item.name, fmt::join(item.members, ", ")));
  }
  void Print(const ModuleDef& item) {
    Line(item.span, fmt::format("using {}:", item.name));
    ++depth_;
    for (const PortGroup& group : item.groups) {
      Line(group.span, group.sensors ? "sensors:" : "actuators:");
      Decls(group.ports);
    }
    --depth_;
  }
  void Print(const Section& item) {
    constexpr const char* kNames[] = {"allread:", "allwrite:", "local:"};
    Line(item.span, kNames[static_cast<size_t>(item.kind)]);
    Decls(item.decls);
  }
  void Print(const InitDef& item) {
    Line(item.span, "init:");
    Body(item.body);
  }
  void Print(const EventDef& item) {
    Line(item.span, item.name + ":");
    ++depth_;
    if (item.pre.valid()) {
      Line(program_.exprs[item.pre].span,
           fmt::format("pre{}: {}", item.urgent ? " urgent" : "", Text(item.pre)));
    }
    Raw("eff:");
    Body(item.body);
    --depth_;
  }
  void Print(const FallbackDef& item) {
    Line(item.span, fmt::format("fallback {}:", item.module));
    Body(item.code.body);
  }
  void Print(const ParamDef& item) { Line(item.span, "param " + Text(item.decl)); }

  void Print(const AssumeDef& item) {
    switch (item.kind) {
      case AssumeKind::kInitially:
        return Statement(item.span, "assume initially:", item.body);
      case AssumeKind::kFact:
        return Statement(item.span, item.name.empty() ? "assume" : fmt::format("assume {}:", item.name),
                         item.body);
      case AssumeKind::kPort:
        break;
    }
    const std::string name = item.name.empty() ? item.module : fmt::format("{}.{}", item.module, item.name);
    const std::string_view word = item.at_end ? "finally" : "always";
    if (!item.when.valid()) return Statement(item.span, fmt::format("assume {} {}", name, word), item.body);
    Line(Whole(item.span, item.when), fmt::format("assume {} when {}", name, Text(item.when)));
    ++depth_;
    Line(program_.exprs[item.body].span, fmt::format("{} {}", word, Text(item.body)));
    --depth_;
  }
  void Print(const SummaryDef& item) {
    Statement(
        item.span,
        fmt::format("summary {}({}) -> {}:", item.function, fmt::join(item.parameters, ", "), item.result),
        item.body);
  }
  void Print(const InvariantDef& item) {
    Statement(item.span,
              fmt::format("invariant{}{}:", item.name.empty() ? "" : " " + item.name,
                          item.at_rounds ? " at rounds" : ""),
              item.body);
  }
  void Print(const ResponseDef& item) {
    Line(Whole(item.span, item.then), fmt::format("response {}: {} within {} rounds {}", item.name,
                                                  Text(item.when), item.rounds, Text(item.then)));
  }
  void Print(const PlatformDef& item) {
    Line(Whole(item.span, item.period), fmt::format("platform {} = {} from \"{}\" every {}", item.module,
                                                    item.type, item.file, Text(item.period)));
  }
  void Print(const ExploreDef& item) {
    Line(item.span, "explore:");
    ++depth_;
    for (const ExploreEntry& e : item.entries) {
      const char* sign = e.kind == ExploreKind::kChoice ? "in" : "=";
      const std::string name = e.kind == ExploreKind::kFunction
                                   ? fmt::format("{}({})", e.name, fmt::join(e.parameters, ", "))
                                   : e.name;
      Line(Whole(e.span, e.body), fmt::format("{} {} {}", name, sign, Text(e.body)));
    }
    --depth_;
  }
  // `head body`, on two lines if it is long: behind the variables of a quantifier, or else behind the head.
  void Statement(diag::Span start, const std::string& head, ExprId body) {
    constexpr size_t kWidth = 110;
    const lang::Expr& e = program_.exprs[body];
    std::string first = head;
    std::string second = Text(body);
    if (sources_ == nullptr || first.size() + second.size() < kWidth ||
        second.find('\n') != std::string::npos) {
      return Line(Whole(start, body), first + " " + second);
    }
    if (e.kind == lang::ExprKind::kQuantifier) {
      const auto range = lang::RangeOf(program_.exprs, e);
      const std::string inner = Text(range ? range->body : e.args[0]);
      first += " " + second.substr(0, second.size() - inner.size() - 1);
      second = inner;
    } else if (!first.ends_with(':')) {
      return Line(Whole(start, body), first + " " + second);  // only behind a colon can a line go on
    }
    Line(Whole(start, body), first);
    ++depth_;
    Raw(second);
    --depth_;
  }
  diag::Span Whole(diag::Span start, ExprId last) const { return start.To(program_.exprs[last].span); }

  void Body(const std::vector<Stmt>& body) {
    ++depth_;
    for (const Stmt& stmt : body) Print(stmt, "if");
    --depth_;
  }

  void Print(const Stmt& s, const char* if_word) {
    const auto operands = [&] {
      std::string text;
      for (const ExprId e : s.operands) text += " << " + Text(e);
      return text;
    };
    switch (s.kind) {
      case StmtKind::kAssign:
        if (!s.update.empty()) {
          const ExprId operand = program_.exprs[s.value].args[1];
          return Line(s.span, fmt::format("{} {}= {}", Text(s.target), s.update, Text(operand)));
        }
        return Line(s.span, fmt::format("{} = {}", Text(s.target), Text(s.value)));
      case StmtKind::kLocal:
        return Line(s.span, fmt::format("{} {} = {}", lang::PrintType(program_.exprs, s.type), s.names[0],
                                        Text(s.value)));
      case StmtKind::kPass:
        return Line(s.span, "pass");
      case StmtKind::kAddAssign:
        return Line(s.span, fmt::format("{} += {}", Text(s.target), Text(s.value)));
      case StmtKind::kIncrement:
        return Line(s.span, Text(s.target) + "++");
      case StmtKind::kCall:
        return Line(s.span, Text(s.value));
      case StmtKind::kStream:
        return Line(s.span, Text(s.target) + operands());
      case StmtKind::kStop:
      case StmtKind::kBreak:
      case StmtKind::kContinue:
        return Line(s.span, std::string(WordsOf(s.kind).word));
      case StmtKind::kReturn:
        return Line(s.span, s.value.valid() ? "return " + Text(s.value) : "return");
      case StmtKind::kIf:
        Line(s.span, fmt::format("{} {}:", if_word, Text(s.value)));
        Body(s.body);
        if (s.has_else && s.orelse.size() == 1 && s.orelse[0].elif) {
          Print(s.orelse[0], "elif");
        } else if (s.has_else) {
          Raw("else:");
          Body(s.orelse);
        }
        return;
      case StmtKind::kForIn:
        Line(s.span, fmt::format("for {} in {}:", fmt::join(s.names, ", "), Text(s.value)));
        return Body(s.body);
      case StmtKind::kForRange:
        Line(s.span, fmt::format("for {} = {}, {}:", s.names[0], Text(s.value), Text(s.operands[0])));
        return Body(s.body);
      case StmtKind::kWhile:
        Line(s.span, fmt::format("while {} within {}:", Text(s.value), Text(s.operands[0])));
        return Body(s.body);
      case StmtKind::kAtomic:
        Line(s.span, "atomic:");
        return Body(s.body);
    }
  }

  const diag::SourceSet* sources_;
  const Program& program_;
  std::vector<lang::Comment> comments_;
  size_t next_comment_ = 0;
  std::string out_;
  int depth_ = 0;
  bool gap_ = false;
};

}  // namespace

std::string Format(const diag::SourceSet& sources, const Program& program) {
  return Formatter(&sources, program).Run();
}

std::string Skeleton(const Program& program) { return Formatter(nullptr, program).Run(); }

}  // namespace rondo::koord
