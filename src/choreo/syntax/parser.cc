#include "choreo/syntax/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "choreo/syntax/process_parser.h"
#include "lang/lexer.h"
#include "lang/units.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;
using lang::TokenKind;

constexpr std::array<std::string_view, 26> kWords = {
    "choreography", "process", "import",    "contract", "initially", "option", "parallel",
    "thread",       "choose",  "when",      "loop",     "while",     "rec",    "continue",
    "region",       "assume",  "guarantee", "and",      "or",        "not",    "implies",
    "true",         "false",   "forall",    "exists",   "exit"};
constexpr std::array<std::string_view, 6> kItems = {"robot",   "world",  "choreography",
                                                    "process", "import", "contract"};
constexpr std::array<std::string_view, 3> kFacts = {"region", "assume", "guarantee"};
constexpr int kDeepestBlock = 100;

template <size_t N>
bool Contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class Parser : public ProcessParser {
 public:
  Parser(const lang::TokenStream& stream, Module& module, diag::Diagnostics& diagnostics)
      : ProcessParser(stream, module.exprs, diagnostics), module_(module) {}

  void ParseModule() {
    while (!AtKind(TokenKind::kEnd)) {
      ClearFailure();
      const size_t before = at_;
      ParseItem();
      if (failed()) Recover();
      if (at_ == before) Take();
    }
  }

 protected:
  bool IsReserved(std::string_view word) const override { return IsReservedWord(word); }
  std::vector<std::string> Words() const override {
    std::vector<std::string> words = robot::RobotWords();
    words.insert(words.end(), kWords.begin(), kWords.end());
    words.insert(words.end(), kItems.begin(), kItems.end());
    for (const char* word : {"send", "receive", "from", "else"}) words.emplace_back(word);
    return words;
  }

 private:
  // To the next item, over what belongs to this one.
  void Recover() {
    while (!AtKind(TokenKind::kEnd) && !(AtKind(TokenKind::kName) && Contains(kItems, Peek().text))) Take();
    ClearFailure();
  }

  void ParseItem() {
    const Span start = Peek().span;
    if (Accept("robot")) return Keep(ParseRobot(start));
    if (Accept("world")) return Keep(ParseWorld(start));
    if (Accept("choreography")) return ParseChoreography(start);
    if (Accept("process")) return Keep(ParseProcess(start));
    if (Accept("contract")) return ParseContract(start);
    if (Accept("import")) return ParseImport(start);
    Unexpected("`robot`, `world`, `choreography`, `process`, `contract` or `import`");
  }

  template <typename T>
  void Keep(std::optional<T> item) {
    if (item) module_.items.emplace_back(std::move(*item));
  }

  void ParseImport(Span start) {
    if (!AtKind(TokenKind::kString)) {
      Unexpected("the path of a file in quotes");
      return;
    }
    const lang::Token& token = Take();
    const size_t size = token.text.size();
    const std::string path(size > 2 ? token.text.substr(1, size - 2) : std::string_view());
    module_.items.emplace_back(ImportDef{start.To(token.span), path});
  }

  void ParseContract(Span start) {
    ContractDef contract;
    contract.name = ParseName("a contract");
    contract.span = start.To(PreviousSpan());
    if (!Expect("{", "the name of a contract")) return;
    while (AtFact() && !failed()) {
      contract.facts.push_back(ParseClause());
      Accept(";");
    }
    Expect("}", "the facts of a contract");
    module_.items.emplace_back(std::move(contract));
  }

  bool AtFact() const { return AtKind(TokenKind::kName) && Contains(kFacts, Peek().text); }

  // -- choreographies

  void ParseChoreography(Span start) {
    ChoreographyDef choreography;
    choreography.name = ParseName("a choreography");
    if (!Expect("in", "the name of a choreography")) return;
    choreography.world = ParseName("a world");
    choreography.span = start.To(PreviousSpan());
    if (!Expect("{", "the world of a choreography")) return;
    while (!failed()) {
      if (Accept("option")) {
        choreography.options.push_back(ParseName("an option"));
      } else if (Accept("initially")) {
        choreography.initially = ParseExpr();
      } else {
        break;
      }
      Accept(";");
    }
    choreography.body = ParseStatements();
    Expect("}", "the last step of a choreography");
    module_.items.emplace_back(std::move(choreography));
  }

  // Up to `}`, which is left.
  std::vector<Stmt> ParseStatements() {
    std::vector<Stmt> body;
    if (++nesting_ > kDeepestBlock) {
      if (!failed()) diagnostics_.Report(Kind::kSyntaxNesting, Peek().span, "blocks are nested too deeply");
      Unexpected("fewer blocks");
    }
    while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
      if (Accept(";")) continue;
      Stmt stmt;
      stmt.span = Peek().span;
      ParseStatement(stmt);
      if (failed()) {
        // One report for this statement; the rest of the block is read on.
        SkipStatement();
        continue;
      }
      body.push_back(std::move(stmt));
    }
    --nesting_;
    return body;
  }

  void SkipStatement() {
    int depth = 0;
    while (!AtKind(TokenKind::kEnd)) {
      if (depth == 0 && (At("}") || At(";"))) break;
      if (At("{")) ++depth;
      if (At("}")) --depth;
      Take();
    }
    ClearFailure();
  }

  std::vector<Stmt> ParseBlock(std::string_view after) {
    std::vector<Stmt> body;
    if (!Expect("{", after)) return body;
    body = ParseStatements();
    Expect("}", "the last step of a block");
    return body;
  }

  void ParseStatement(Stmt& stmt) {
    if (Accept("parallel")) return ParseBranches(stmt, StmtKind::kParallel);
    if (Accept("choose")) {
      if (!Expect("at", "`choose`")) return;
      stmt.chooser = ParseName("the robot that chooses");
      return ParseBranches(stmt, StmtKind::kChoose);
    }
    if (Accept("loop")) {
      stmt.kind = StmtKind::kLoop;
      stmt.body = ParseBlock("`loop`");
      return;
    }
    if (Accept("while")) {
      stmt.kind = StmtKind::kWhile;
      stmt.guard = ParseExpr();
      stmt.span = stmt.span.To(PreviousSpan());
      stmt.body = ParseBlock("the guard of a loop");
      return;
    }
    if (Accept("rec")) {
      stmt.kind = StmtKind::kRec;
      stmt.label = ParseName("a recursion");
      stmt.span = stmt.span.To(PreviousSpan());
      stmt.body = ParseBlock("the name of a recursion");
      return;
    }
    if (Accept("continue")) {
      stmt.kind = StmtKind::kContinue;
      stmt.label = ParseName("a recursion");
      stmt.span = stmt.span.To(PreviousSpan());
      return;
    }
    if (Accept("{")) {
      stmt.kind = StmtKind::kMotion;
      do {
        stmt.motions.push_back(ParseMotionCall(ParseName("a robot")));
      } while (!failed() && Accept(","));
      Expect("}", "the motions of a step");
      stmt.span = stmt.span.To(PreviousSpan());
      return;
    }
    const Name first = ParseName("a step: a message `a -> b: label()`, a motion `a: Move()`, or a block");
    if (failed()) return;
    if (At("->")) return ParseMessage(stmt, first);
    stmt.kind = StmtKind::kMotion;
    stmt.motions.push_back(ParseMotionCall(first));
    stmt.span = stmt.span.To(PreviousSpan());
  }

  MotionCall ParseMotionCall(Name robot) {
    if (!Expect(":", "a robot")) return {std::move(robot), {}, {}};
    return ParseCall(std::move(robot));
  }

  void ParseMessage(Stmt& stmt, Name from) {
    stmt.kind = StmtKind::kMessage;
    stmt.from = std::move(from);
    Take();
    stmt.to = ParseName("the robot that receives");
    if (failed() || !Expect(":", "the receiver")) return;
    stmt.label = ParseName("a label");
    if (failed()) return;
    if (Accept("(")) {
      while (!At(")") && !failed()) {
        Payload payload;
        if (AtKind(TokenKind::kName) && Peek(1).text == ":") {
          payload.name = ParseName("a payload");
          Take();
          payload.type = ParseName("a type");
          if (Accept("|")) payload.value = ParseExpr();
        } else {
          payload.value = ParseExpr();
        }
        stmt.payload.push_back(std::move(payload));
        if (!Accept(",")) break;
      }
      Expect(")", "the payload");
    }
    if (!failed() && Accept("when")) stmt.guard = ParseExpr();
    stmt.span = stmt.span.To(PreviousSpan());
  }

  void ParseBranches(Stmt& stmt, StmtKind kind) {
    stmt.kind = kind;
    const bool parallel = kind == StmtKind::kParallel;
    stmt.span = stmt.span.To(PreviousSpan());
    if (!Expect("{", parallel ? "`parallel`" : "the robot that chooses")) return;
    while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
      Branch branch;
      branch.span = Peek().span;
      if (!Expect(parallel ? "thread" : "when", parallel ? "`parallel {`" : "`choose at ... {`")) return;
      if (!parallel) branch.guard = ParseExpr();
      if (parallel && AtKind(TokenKind::kName) && !AtFact()) branch.contract = ParseName("a contract");
      while (parallel && AtFact() && !failed()) branch.facts.push_back(ParseClause());
      branch.span = branch.span.To(PreviousSpan());
      if (failed()) return;
      branch.body = ParseBlock(parallel ? "the head of a thread" : "the guard of an alternative");
      stmt.branches.push_back(std::move(branch));
    }
    if (stmt.branches.empty() && !failed())
      diagnostics_.Report(Kind::kSyntaxUnexpected, stmt.span,
                          parallel ? "a `parallel` without threads" : "a choice without alternatives");
    Expect("}", parallel ? "the threads" : "the alternatives");
  }

  Module& module_;
  int nesting_ = 0;
};

}  // namespace

bool IsReservedWord(std::string_view word) {
  return Contains(kWords, word) || robot::IsRobotWord(word) || lang::FindUnit(word) != nullptr;
}

lang::LexerOptions RondoLexer() {
  lang::LexerOptions options;
  options.indentation = false;
  options.bar = true;
  options.half_open = true;
  options.prime = true;
  return options;
}

void Parse(const diag::SourceSet& sources, diag::FileId file, Module& module,
           diag::Diagnostics& diagnostics) {
  const lang::TokenStream stream = lang::Lex(sources, file, RondoLexer(), diagnostics);
  module.comments.insert(module.comments.end(), stream.comments.begin(), stream.comments.end());
  Parser(stream, module, diagnostics).ParseModule();
}

}  // namespace rondo::choreo
