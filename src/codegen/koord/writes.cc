#include "codegen/koord/writes.h"

#include <algorithm>
#include <map>

#include "koord/check/targets.h"

namespace rondo::codegen {

using koord::ExprId;
using koord::Ref;
using koord::RefKind;
using koord::Stmt;
using koord::StmtKind;

namespace {

/// Goes through a body in the order of the text. What is in a loop counts as read at its end, and as written at its beginning.
class Looker {
 public:
  explicit Looker(const koord::Model& model) : model_(model), exprs_(model.program->exprs) {}

  void Look(const std::vector<Stmt>& body) {
    for (const Stmt& stmt : body) Look(stmt);
  }

  std::set<size_t> Result() const {
    std::set<size_t> only;
    for (const auto& [variable, first] : written_) {
      const auto read = read_.find(variable);
      const size_t last = std::max(read == read_.end() ? 0 : read->second, all_read_);
      if (last < first && !parts_.contains(variable)) only.insert(variable);
    }
    return only;
  }

 private:
  void Look(const Stmt& stmt) {
    const bool loops =
        stmt.kind == StmtKind::kForIn || stmt.kind == StmtKind::kForRange || stmt.kind == StmtKind::kWhile;
    const bool outermost = loops && loop_ == 0;
    if (outermost) loop_ = ++now_;
    const koord::Builtin method = MethodOf(stmt);
    if (stmt.value.valid()) Read(stmt.value);
    for (const ExprId e : stmt.operands) Read(e);
    if (stmt.target.valid()) Write(stmt.target, stmt.kind != StmtKind::kAssign);
    if (koord::WritesList(method)) Write(exprs_[exprs_[stmt.value].args[0]].args[0], true);
    Look(stmt.body);
    Look(stmt.orelse);
    if (!outermost) return;
    // Everything that it read, it may read once more at its end.
    ++now_;
    for (const size_t variable : in_loop_) read_[variable] = now_;
    if (all_in_loop_) all_read_ = now_;
    in_loop_.clear();
    all_in_loop_ = false;
    loop_ = 0;
  }

  koord::Builtin MethodOf(const Stmt& stmt) const {
    if (stmt.kind != StmtKind::kCall) return koord::Builtin::kPos;
    const Ref ref = model_.RefOf(stmt.value);
    return ref.kind == RefKind::kBuiltin ? static_cast<koord::Builtin>(ref.index) : koord::Builtin::kPos;
  }

  void Read(ExprId id) {
    const lang::Expr& e = exprs_[id];
    const Ref ref = model_.RefOf(id);
    if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf) {
      read_[ref.index] = ++now_;
      if (loop_ != 0) in_loop_.insert(ref.index);
    }
    // A function may read anything.
    if (ref.kind == RefKind::kFunction && !model_.functions[ref.index].external()) {
      all_read_ = ++now_;
      all_in_loop_ = loop_ != 0;
    }
    for (const ExprId arg : e.args) Read(arg);
    for (const lang::Binder& binder : e.binders) {
      if (binder.domain.valid()) Read(binder.domain);
    }
  }

  // `part`: the old value counts.
  void Write(ExprId target, bool part) {
    const Ref ref = model_.RefOf(target);
    if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell) {
      written_.try_emplace(ref.index, loop_ != 0 ? loop_ : ++now_);
      if (part) parts_.insert(ref.index);
      return;
    }
    const lang::Expr& e = exprs_[target];
    if (e.args.empty()) return;
    for (size_t i = 1; i < e.args.size(); ++i) Read(e.args[i]);
    Write(e.args[0], true);
  }

  const koord::Model& model_;
  const lang::ExprPool& exprs_;
  size_t now_ = 0;
  size_t loop_ = 0;  // when the outermost loop began
  size_t all_read_ = 0;
  bool all_in_loop_ = false;
  std::set<size_t> in_loop_, parts_;
  std::map<size_t, size_t> read_, written_;  // last, and first
};

}  // namespace

std::set<size_t> OnlyWritten(const koord::Model& model, const std::vector<Stmt>& body) {
  Looker looker(model);
  looker.Look(body);
  return looker.Result();
}

}  // namespace rondo::codegen
