#include <fmt/format.h>

#include <functional>

#include "expr/substitute.h"
#include "koord/prove/execution/executor.h"

namespace rondo::koord {

using diag::Kind;
using lang::ExprKind;
using lang::TypeKind;

// Loops are unrolled as often as something bounds them.

// A parameter with a declared value is that value: every proof has it among its facts.
std::optional<int64_t> Executor::ConstantInt(TermId term) {
  constexpr int kDeepest = 8;  // parameters whose values are made of others
  for (int depth = 0; depth < kDeepest && !arena_.IsNumber(term); ++depth) {
    expr::Substitution declared;
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      if (variable.kind == VariableKind::kParam && variable.initial.valid() &&
          model_.types.Is(variable.type, TypeKind::kInt))
        declared.emplace(frame_.view->value[v], Eval(variable.initial));
    }
    const TermId known = Substitute(arena_, term, declared);
    if (known == term) break;
    term = known;
  }
  if (!arena_.IsNumber(term) || !arena_.number(term).IsInteger()) return std::nullopt;
  const std::string digits = arena_.number(term).ToString();
  if (digits.size() > 12) return std::nullopt;
  return std::stoll(digits);
}

void Executor::LoopRange(const Stmt& stmt) {
  const auto first = ConstantInt(Eval(stmt.value));
  const auto end = ConstantInt(Eval(stmt.operands[0]));
  if (!first || !end || *end - *first > options_.unrolling) {
    diagnostics_
        .Report(Kind::kKoordUnboundedLoop, stmt.span,
                first && end ? fmt::format("this loop has more than {} iterations", options_.unrolling)
                             : "the number of iterations of this loop is not known")
        .Help(first && end ? "proofs unroll loops: use a smaller range"
                           : "use constant bounds, or fix the number of robots with `--robots`");
    return;
  }
  const uint32_t variable = model_.bound_by.at(&stmt)[0];
  InLoop([&] {
    for (int64_t i = *first; i < *end; ++i) {
      frame_.bindings[variable] = arena_.IntNumber(i);
      Body(stmt.body);
      frame_.state->continued = arena_.False();
    }
  });
}

// Unrolled as often as it says; that it is not repeated more often must be shown.
void Executor::LoopWhile(const Stmt& stmt) {
  const auto most = ConstantInt(Eval(stmt.operands[0]));
  if (!most || *most > options_.unrolling) {
    diagnostics_
        .Report(Kind::kKoordUnboundedLoop, stmt.span,
                most ? fmt::format("this loop may have more than {} iterations", options_.unrolling)
                     : "the number of iterations of this loop is not known")
        .Help(most ? "proofs unroll loops: use a smaller number behind `within`"
                   : "use a constant behind `within`, or fix the parameter");
    return;
  }
  InLoop([&] {
    for (int64_t i = 0; i < *most; ++i) Iterate(Eval(stmt.value), stmt.body);
    Check(CheckKind::kRepeating, stmt.span, arena_.Not(Eval(stmt.value)));
  });
}

// One iteration, if there is one.
void Executor::Iterate(TermId happens, const std::vector<Stmt>& body) {
  State* whole = frame_.state;
  State then = *whole;
  const TermId path = whole->path;
  then.path = arena_.And(path, happens);
  frame_.state = &then;
  Body(body);
  frame_.state = whole;
  *whole = Merge(happens, then, *whole);
  whole->path = path;
  whole->continued = arena_.False();
}

// Runs a loop with flags of its own; outside they stay as they are. Nothing happens where control does not
// get here.
void Executor::InLoop(const std::function<void()>& iterations) {
  State* whole = frame_.state;
  const TermId live = Live();
  State inner = *whole;
  inner.path = arena_.And(whole->path, live);
  inner.broke = inner.continued = inner.ended = arena_.False();
  frame_.state = &inner;
  iterations();
  frame_.state = whole;
  inner.broke = inner.continued = arena_.False();
  const TermId path = whole->path;
  *whole = Merge(live, inner, *whole);
  whole->path = path;
}

void Executor::LoopIn(const Stmt& stmt) {
  const TermId list = Eval(stmt.value);
  const bool is_list = model_.types.Is(model_.TypeOf(stmt.value), TypeKind::kList);
  std::optional<int64_t> bound;
  if (arena_.op(list) == expr::Op::kListMake) {
    bound = static_cast<int64_t>(arena_.args(list).size());
  } else {
    bound = LengthBound(stmt.value);
  }
  if (!bound || *bound > options_.unrolling) {
    diagnostics_.Report(Kind::kKoordUnboundedLoop, stmt.span, "nothing says how long this list can be")
        .Under("proofs unroll loops")
        .Help(
            "state it: `invariant bounded: len(...) <= 4`, or `assume M always len(M.port) <= 4` for a sensor");
    return;
  }
  const std::vector<uint32_t>& variables = model_.bound_by.at(&stmt);
  if (is_list) {
    // The bound is not trusted: it must hold wherever control gets here.
    Check(CheckKind::kUnrolling, stmt.span, arena_.Le(arena_.Length(list), arena_.IntNumber(*bound)));
  }
  InLoop([&] {
    for (int64_t i = 0; i < *bound; ++i) {
      const TermId index = arena_.IntNumber(i);
      const TermId item = is_list ? arena_.At(list, index) : arena_.Select(list, index);
      if (variables.size() == 1) {
        frame_.bindings[variables[0]] = item;
      } else {
        for (uint32_t k = 0; k < variables.size(); ++k) frame_.bindings[variables[k]] = arena_.Field(item, k);
      }
      // An iteration beyond the end of the list does not happen.
      const TermId inside = is_list ? arena_.Lt(index, arena_.Length(list)) : arena_.True();
      Iterate(inside, stmt.body);
    }
  });
}

std::optional<int64_t> Executor::LengthBound(ExprId list) {
  const TypeId type = model_.TypeOf(list);
  if (model_.types.Is(type, TypeKind::kArray)) return ConstantInt(ArrayLength(type));
  const Ref ref = model_.RefOf(list);
  if (ref.kind != RefKind::kVariable && ref.kind != RefKind::kCell) return std::nullopt;
  const Variable& variable = model_.variables[ref.index];
  return variable.function < 0 ? ListBound(ref.index) : std::nullopt;
}

// Looks for `len(v) <= number` as a part of an invariant or assumption. Only a hint: CheckKind::kUnrolling
// proves it.
std::optional<int64_t> Executor::ListBound(size_t variable) const {
  std::optional<int64_t> best;
  const auto is_length = [&](ExprId id) {
    const lang::Expr& e = exprs_[id];
    if (e.kind != ExprKind::kCall || model_.RefOf(id).kind != RefKind::kBuiltin || e.args.size() != 2 ||
        static_cast<Builtin>(model_.RefOf(id).index) != Builtin::kLen) {
      return false;
    }
    const Ref ref = model_.RefOf(e.args[1]);
    return (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf) &&
           ref.index == variable;
  };
  const std::function<void(ExprId)> visit = [&](ExprId id) {
    const lang::Expr& e = exprs_[id];
    if (e.kind == ExprKind::kBinary && (e.text == "<=" || e.text == "<") && is_length(e.args[0]) &&
        exprs_[e.args[1]].kind == ExprKind::kInt && exprs_[e.args[1]].text.size() < 6) {
      const int64_t bound = std::stoll(exprs_[e.args[1]].text) - (e.text == "<" ? 1 : 0);
      best = best ? std::min(*best, bound) : bound;
    }
    for (const ExprId arg : e.args) visit(arg);
  };
  for (const InvariantDef* def : model_.invariants) visit(def->body);
  for (const AssumeDef* def : model_.assumptions) visit(def->body);
  return best;
}

}  // namespace rondo::koord
