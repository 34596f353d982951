#include "runs/helper_literals.h"

#include <algorithm>
#include <optional>
#include <set>

#include "lang/expr_printer.h"

namespace rondo::runs {

using koord::Ref;
using koord::RefKind;
using koord::VariableKind;
using lang::Expr;
using lang::ExprId;
using lang::ExprKind;

namespace {

// Rewrites an expression of a robot's own code, or below `forall r in ID`, so that it speaks of the robot `name`.
class About {
 public:
  About(const koord::Model& model, std::string name, std::optional<uint32_t> robot)
      : model_(model), exprs_(model.program->exprs), name_(std::move(name)), robot_(robot) {}

  // Empty if that cannot be said.
  std::string Text(ExprId id) {
    const ExprId copy = Copy(id);
    return good_ ? lang::PrintExpr(out_, copy) : "";
  }
  std::string Comparison(ExprId target, const char* relation, ExprId value) {
    const ExprId a = Copy(target);
    const ExprId b = Copy(value);
    return good_ ? lang::PrintExpr(out_, out_.Add({ExprKind::kBinary, {}, relation, {a, b}, {}})) : "";
  }

 private:
  ExprId Robot() { return out_.Add({ExprKind::kName, {}, name_, {}, {}}); }
  ExprId At(ExprId whole) { return out_.Add({ExprKind::kIndex, {}, {}, {whole, Robot()}, {}}); }
  ExprId Bad() {
    good_ = false;
    return Robot();
  }
  // As it is written: names of modules, functions and arrays.
  ExprId Raw(ExprId id) { return out_.Add(exprs_[id]); }

  ExprId Copy(ExprId id) {
    const Expr& e = exprs_[id];
    const Ref ref = model_.RefOf(id);
    Expr copy{e.kind, e.span, e.text, {}, {}};
    switch (e.kind) {
      case ExprKind::kPid:
        return Robot();
      case ExprKind::kAny:
      case ExprKind::kError:
        return Bad();
      case ExprKind::kName:
        if (ref.kind == RefKind::kBinding && !inner_.contains(ref.index))
          return robot_ == ref.index ? Robot() : Bad();
        if (ref.kind == RefKind::kVariable && model_.variables[ref.index].kind == VariableKind::kLocal)
          return At(Raw(id));
        return Raw(id);
      case ExprKind::kField:
        if (ref.kind == RefKind::kVariable) {
          if (model_.variables[ref.index].function >= 0) return Bad();
          copy.args = {At(Raw(e.args[0]))};
          return out_.Add(std::move(copy));
        }
        break;
      case ExprKind::kIndex:
        if (ref.kind == RefKind::kCell || ref.kind == RefKind::kStopped) {
          copy.args = {Raw(e.args[0]), Copy(e.args[1])};
          return out_.Add(std::move(copy));
        }
        break;
      case ExprKind::kCall:
        if (ref.kind == RefKind::kFunction && model_.functions[ref.index].port >= 0) return Bad();
        if (exprs_[e.args[0]].kind == ExprKind::kName) {
          copy.args.push_back(Raw(e.args[0]));
          for (size_t i = 1; i < e.args.size(); ++i) copy.args.push_back(Copy(e.args[i]));
          return out_.Add(std::move(copy));
        }
        break;
      case ExprKind::kQuantifier:
      case ExprKind::kFold:
        return Quantifier(id, e, std::move(copy));
      default:
        break;
    }
    if (ref.kind == RefKind::kPortOf) {
      const Expr& base = exprs_[e.args[0]];
      const ExprId robot = Copy(base.args[1]);
      copy.args = {out_.Add({ExprKind::kIndex, {}, {}, {Raw(base.args[0]), robot}, {}})};
      return out_.Add(std::move(copy));
    }
    for (const ExprId arg : e.args) copy.args.push_back(Copy(arg));
    return out_.Add(std::move(copy));
  }

  ExprId Quantifier(ExprId id, const Expr& e, Expr copy) {
    const auto domains = model_.domains.find(id);
    if (domains == model_.domains.end()) return Bad();
    for (size_t b = 0; b < e.binders.size(); ++b) {
      lang::Binder binder = e.binders[b];
      if (std::ranges::find(binder.names, name_) != binder.names.end()) return Bad();
      if (domains->second.kinds[b] == koord::DomainKind::kList)
        binder.domain = Copy(binder.domain);
      else if (binder.domain.valid())
        binder.domain = Raw(binder.domain);
      inner_.insert(domains->second.bindings[b].begin(), domains->second.bindings[b].end());
      copy.binders.push_back(std::move(binder));
    }
    copy.args = {Copy(e.args[0])};
    return out_.Add(std::move(copy));
  }

  const koord::Model& model_;
  const lang::ExprPool& exprs_;
  std::string name_;
  std::optional<uint32_t> robot_;
  std::set<uint32_t> inner_;
  lang::ExprPool out_;
  bool good_ = true;
};

class Collector {
 public:
  Collector(const koord::Model& model, size_t most)
      : model_(model), exprs_(model.program->exprs), most_(most) {}

  std::vector<Literal> Run() {
    for (const koord::InvariantDef* def : model_.invariants) Specification(def->body);
    for (const koord::AssumeDef* def : model_.assumptions) {
      if (def->kind == koord::AssumeKind::kInitially) Specification(def->body);
    }
    for (const koord::EventDef* event : model_.events) {
      if (event->pre.valid()) Atoms(event->pre, {});
    }
    for (const koord::AssumeDef* def : model_.assumptions) {
      if (def->kind == koord::AssumeKind::kPort && def->when.valid()) Atoms(def->when, {});
    }
    for (const koord::EventDef* event : model_.events) Statements(event->body);
    Marks();
    return std::move(found_);
  }

 private:
  void Specification(ExprId id) {
    const Expr& e = exprs_[id];
    if (e.kind != ExprKind::kQuantifier) return Atoms(id, {});
    const auto domains = model_.domains.find(id);
    if (domains == model_.domains.end()) return;
    for (size_t b = 0; b < domains->second.kinds.size(); ++b) {
      if (domains->second.kinds[b] != koord::DomainKind::kRobots) continue;
      for (const uint32_t binding : domains->second.bindings[b]) Atoms(e.args[0], binding);
    }
  }

  void Atoms(ExprId id, std::optional<uint32_t> robot) {
    const Expr& e = exprs_[id];
    const bool junction =
        e.kind == ExprKind::kBinary && (e.text == "and" || e.text == "or" || e.text == "implies");
    if (junction || (e.kind == ExprKind::kUnary && e.text == "not")) {
      for (const ExprId arg : e.args) Atoms(arg, robot);
    } else if (e.kind != ExprKind::kBool) {
      Add(About(model_, "i", robot).Text(id), About(model_, "j", robot).Text(id));
    }
  }

  void Statements(const std::vector<koord::Stmt>& body) {
    for (const koord::Stmt& s : body) {
      if (s.kind == koord::StmtKind::kIf) Atoms(s.value, {});
      if (s.kind == koord::StmtKind::kAssign) Assigned(s.target, s.value);
      Statements(s.body);
      Statements(s.orelse);
    }
  }

  // What an array of flags says of the place that a robot has: `taken[dock[i]]`.
  void Marks() {
    for (const koord::Variable& array : model_.variables) {
      const lang::Type& type = model_.types[array.type];
      if (array.kind != VariableKind::kAllwrite || type.kind != lang::TypeKind::kArray ||
          !model_.types.Is(type.parts[0], lang::TypeKind::kBool))
        continue;
      for (const koord::Variable& place : model_.variables) {
        if ((place.kind == VariableKind::kLocal || place.kind == VariableKind::kAllread) &&
            model_.types.Is(place.type, lang::TypeKind::kInt))
          Add(array.name + "[" + place.name + "[i]]", array.name + "[" + place.name + "[j]]");
      }
    }
  }

  void Assigned(ExprId target, ExprId value) {
    if (model_.types.Is(model_.TypeOf(target), lang::TypeKind::kBool)) return Atoms(target, {});
    if (model_.types.Is(model_.TypeOf(target), lang::TypeKind::kList)) return;
    const bool number = model_.types.IsNumeric(model_.TypeOf(target));
    for (const char* relation : {"==", "<=", ">="}) {
      if (!number && relation[0] != '=') break;
      Add(About(model_, "i", {}).Comparison(target, relation, value),
          About(model_, "j", {}).Comparison(target, relation, value));
    }
  }

  void Add(std::string of_i, std::string of_j) {
    if (of_i.empty() || of_j.empty() || found_.size() >= most_ || !seen_.insert(of_i).second) return;
    found_.push_back({std::move(of_i), std::move(of_j)});
  }

  const koord::Model& model_;
  const lang::ExprPool& exprs_;
  size_t most_;
  std::set<std::string> seen_;
  std::vector<Literal> found_;
};

}  // namespace

std::vector<Literal> LiteralsOf(const koord::Model& model, size_t most) {
  return Collector(model, most).Run();
}

}  // namespace rondo::runs
