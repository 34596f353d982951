#include "koord/ports/port_problem.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/substitute.h"
#include "koord/check/spec_labels.h"
#include "koord/prove/obligations/theory.h"

namespace rondo::koord {

using expr::Substitution;

namespace {

class Builder {
 public:
  Builder(const Model& model, const PlatformDef& platform, const robot::World& world, const robot::Body& body,
          expr::Arena& arena, diag::Diagnostics& diagnostics, const robot::Loose* loose)
      : model_(model),
        platform_(platform),
        world_(world),
        body_(body),
        arena_(arena),
        loose_(loose),
        vocabulary_(arena, model, std::nullopt),
        executor_(vocabulary_, diagnostics) {}

  std::vector<PortProblem> Run() {
    std::vector<PortProblem> all;
    Theory theory(vocabulary_, executor_);
    const TermId robot = arena_.FreshConstant("robot", arena_.Int());
    View settled = vocabulary_.MakeView(".settled");
    View end = vocabulary_.MakeView(".end");
    for (const robot::Variable& v : body_.states) {
      const TermId copy = arena_.FreshConstant(v.name.text + " at the start", arena_.Real());
      copies_.emplace(v.term, copy);
    }
    for (size_t v = 0; v < model_.variables.size(); ++v) Fill(v, robot, settled, end);
    const TermId period = executor_.Value(platform_.period, model_.types.real(), settled, robot);
    for (const Theory::Promise& promise : theory.Promises(settled, end, robot))
      Add(promise, settled, period, theory, all);
    // Without a condition: true at every moment.
    for (const AssumeDef* def : model_.assumptions) {
      if (def->kind != AssumeKind::kPort || !HoldsAlways(model_, *def) || def->module != platform_.module)
        continue;
      const TermId always = executor_.Specification(def->body, end, robot, nullptr, {});
      Add({def, AssumptionName(model_, *def), arena_.True(), always}, settled, period, theory, all);
    }
    return all;
  }

 private:
  // What the model says that a port is: at the start in terms of copies, at the end of the states themselves.
  void Fill(size_t v, TermId robot, View& settled, View& end) {
    const Variable& variable = model_.variables[v];
    if (variable.kind == VariableKind::kParam) {
      const auto given = model_.exploration.values.find(v);
      if (given == model_.exploration.values.end() || IsLoose(variable)) return;
      settled.value[v] = end.value[v] = executor_.Value(given->second, variable.type, settled, robot);
      return;
    }
    if (variable.module != platform_.module || variable.function >= 0) return;
    const std::string port = variable.name.substr(variable.module.size() + 1);
    const auto it = body_.ports.find(port);
    if (it == body_.ports.end()) return;
    const auto sort = vocabulary_.CellSort(v);
    TermId term;
    if (it->second.terms.size() == 1 && sort == arena_.Real()) {
      term = it->second.terms[0];
    } else if (arena_.sort(sort).kind == expr::SortKind::kRecord &&
               arena_.sort(sort).parts.size() == it->second.terms.size()) {
      term = arena_.MakeRecord(sort, it->second.terms);
    } else {
      mismatch_.push_back(variable.name);
      return;
    }
    for (const TermId t : it->second.terms) {
      if (copies_.contains(t)) visible_.push_back(t);
    }
    const bool sensor = variable.kind == VariableKind::kSensor;
    end.value[v] = arena_.Store(end.value[v], robot, term);
    settled.value[v] =
        arena_.Store(settled.value[v], robot, sensor ? expr::Substitute(arena_, term, Copies()) : term);
  }

  bool IsLoose(const Variable& v) const { return loose_ != nullptr && loose_->name == v.name; }

  Substitution Copies() const { return {copies_.begin(), copies_.end()}; }

  void Add(const Theory::Promise& promise, const View& settled, TermId period, Theory& theory,
           std::vector<PortProblem>& all) {
    const auto* def = promise.def;
    if (def->module != platform_.module) return;
    PortProblem problem;
    problem.assumption = def;
    problem.name = promise.name;
    problem.made.problem.name = promise.name;
    problem.impossible = Make(promise, settled, period, theory, problem);
    all.push_back(std::move(problem));
  }

  std::string Make(const Theory::Promise& promise, const View& settled, TermId period, Theory& theory,
                   PortProblem& out) {
    if (!mismatch_.empty())
      return fmt::format("the port `{}` of `{}` has another type than `{}`", mismatch_[0], platform_.type,
                         mismatch_[0]);
    if (!arena_.IsNumber(period)) return "how long a round takes is no constant";
    robot::MotionInstance instance;
    instance.text = promise.name;
    instance.control = body_.control;
    instance.duration = arena_.number(period);
    Substitution originals;
    for (const auto& [state, copy] : copies_) originals.emplace(copy, state);
    std::vector<TermId> conditions{expr::Substitute(arena_, promise.condition, originals)};
    for (const solve::Assertion& fact : theory.Facts()) conditions.push_back(fact.formula);
    instance.contract.pre = arena_.And(conditions);
    // Facts are about parameters by their symbols; those that have a value are that.
    Substitution values;
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].kind != VariableKind::kParam) continue;
      const TermId symbol =
          arena_.Variable(arena_.Declare(model_.variables[v].name, {}, vocabulary_.CellSort(v)));
      if (symbol != settled.value[v]) values.emplace(symbol, settled.value[v]);
    }
    instance.contract.pre = expr::Substitute(arena_, instance.contract.pre, values);
    const TermId promised = expr::Substitute(arena_, promise.promise, values);
    instance.contract.during = promise.def->at_end ? arena_.True() : promised;
    instance.contract.post = promise.def->at_end ? promised : arena_.True();
    instance.least = *instance.duration;
    instance.contract.assume = arena_.True();
    instance.contract.modifies.assign(body_.states.size(), true);
    instance.visible = visible_;
    const auto mentioned = robot::VariablesOf(arena_, {promised});
    for (const auto& [state, copy] : copies_) {
      if (mentioned.contains(copy)) instance.copies.emplace_back(copy, state);
    }
    // Actuators: whatever the program set, held during the round.
    for (const robot::Variable& v : body_.inputs) {
      const bool actuator = std::ranges::any_of(body_.ports, [&](const auto& port) {
        return std::ranges::find(port.second.terms, v.term) != port.second.terms.end();
      });
      if (!actuator) continue;
      if (!v.least || !v.most) return fmt::format("the input `{}` has no bounds", v.name.text);
      instance.unknowns.push_back(v);
      if (arena_.IsNumber(*v.least) && arena_.IsNumber(*v.most)) {
        out.domain.push_back(fmt::format("{} in [{:.6g}, {:.6g}]", v.name.text,
                                         arena_.number(*v.least).ToDouble(),
                                         arena_.number(*v.most).ToDouble()));
      }
    }
    const auto terms = robot::VariablesOf(arena_, {instance.contract.pre, promised});
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      if (variable.kind != VariableKind::kParam) continue;
      const TermId value = settled.value[v];
      if (terms.contains(value) && arena_.sort_of(value) == arena_.Real()) {
        robot::Variable unknown{{variable.name, variable.span}, {}, value, {}, {}};
        if (IsLoose(variable)) {
          unknown.least = arena_.Number(arena_.Real(), loose_->least);
          unknown.most = arena_.Number(arena_.Real(), loose_->most);
        }
        instance.unknowns.push_back(std::move(unknown));
      }
      if (!model_.exploration.values.contains(v) || IsLoose(variable)) continue;
      out.domain.push_back(arena_.IsNumber(value)
                               ? fmt::format("{} = {}", variable.name, arena_.number(value).ToString())
                               : fmt::format("{} as in `explore`", variable.name));
    }
    for (const robot::Variable& v : body_.states) {
      if (v.least && v.most && arena_.IsNumber(*v.least) && arena_.IsNumber(*v.most)) {
        out.domain.push_back(fmt::format("{} in [{:.6g}, {:.6g}] at the start of a round", v.name.text,
                                         arena_.number(*v.least).ToDouble(),
                                         arena_.number(*v.most).ToDouble()));
      }
    }
    auto made = robot::ProblemOf(world_, body_, instance, arena_);
    if (!made.ok()) return made.error().message;
    out.made = std::move(made).value();
    out.made.problem.name = promise.name;
    for (reach::Claim& claim : out.made.problem.claims) {
      if (claim.name == "during") claim.name = "always";
      if (claim.name == "post") claim.name = "finally";
    }
    return "";
  }

  const Model& model_;
  const PlatformDef& platform_;
  const robot::World& world_;
  const robot::Body& body_;
  expr::Arena& arena_;
  const robot::Loose* loose_;
  Vocabulary vocabulary_;
  Executor executor_;
  std::map<TermId, TermId> copies_;  ///< of states
  std::vector<TermId> visible_;
  std::vector<std::string> mismatch_;
};

}  // namespace

std::vector<PortProblem> PortProblems(const Model& model, const PlatformDef& platform,
                                      const robot::World& world, const robot::Body& body, expr::Arena& arena,
                                      diag::Diagnostics& diagnostics, const robot::Loose* loose) {
  return Builder(model, platform, world, body, arena, diagnostics, loose).Run();
}

}  // namespace rondo::koord
