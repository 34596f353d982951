#include "sim/models/robot_code.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expr/numeric.h"
#include "robot/model/control.h"

namespace rondo::sim {

using expr::TermId;

size_t RobotCode::Find(std::string_view name) const {
  return static_cast<size_t>(std::ranges::find(variables, name, &RobotVariable::name) - variables.begin());
}

namespace {

class Builder {
 public:
  Builder(const robot::World& world, const robot::Body& body, expr::Arena& arena)
      : world_(world), body_(body), arena_(arena) {}

  base::Result<RobotCode> Run() {
    Variables();
    Rates();
    if (body_.control) Controller(*body_.control);
    Ports();
    Disturbances();
    Place();
    if (!problem_.empty()) return base::Error{problem_};
    return std::move(code_);
  }

 private:
  void Problem(std::string text) {
    if (problem_.empty()) problem_ = std::move(text);
  }

  void Variables() {
    const auto add = [&](const std::vector<robot::Variable>& list) {
      for (const robot::Variable& v : list) {
        RobotVariable variable{v.name.text};
        if (v.least) variable.low = expr::Numeric(arena_, {})(*v.least);
        if (v.most) variable.high = expr::Numeric(arena_, {})(*v.most);
        code_.variables.push_back(std::move(variable));
        terms_.push_back(v.term);
      }
    };
    code_.states = body_.states.size();
    code_.memory = body_.memory.size();
    code_.inputs = body_.inputs.size();
    add(body_.states);
    add(body_.memory);
    add(body_.inputs);
    add(body_.unknowns);
    const auto state = [&](std::string_view name) {
      const size_t at = code_.Find(name);
      return at < code_.states ? at : code_.variables.size();
    };
    code_.position = {state("x"), state("y"), state("z")};
    code_.heading = std::min(state("theta"), state("yaw"));
  }

  size_t NumberOf(TermId variable) const {
    return static_cast<size_t>(std::ranges::find(terms_, variable) - terms_.begin());
  }

  reach::Program Compiled(const std::vector<TermId>& functions, const std::string& what) {
    if (robot::VariablesOf(arena_, functions).contains(world_.clock)) {
      Problem(fmt::format("{} depends on `clock`, which only motions have", what));
      return {};
    }
    auto program = reach::Compile(arena_, terms_, functions);
    if (!program.ok()) {
      Problem(fmt::format("{}: {}", what, program.error().message));
      return {};
    }
    return std::move(program).value();
  }

  RobotFormula CompiledFormula(TermId formula, const std::string& what) {
    auto normal = reach::Normalise(arena_, formula);
    if (!normal.ok()) {
      Problem(fmt::format("{}: {}", what, normal.error().message));
      return {};
    }
    RobotFormula result;
    result.terms = Compiled(normal.value().terms, what);
    result.formula = std::move(normal).value();
    return result;
  }

  RobotUpdate Update(const std::vector<std::pair<TermId, TermId>>& pairs, const std::string& what) {
    RobotUpdate update;
    std::vector<TermId> values;
    for (const auto& [variable, value] : pairs) {
      update.set.push_back(NumberOf(variable));
      values.push_back(Continuous(value));
    }
    update.values = Compiled(values, what);
    return update;
  }

  // Inputs that a controller sets at all times are what it says.
  TermId Continuous(TermId term) {
    return body_.control ? robot::Determined(arena_, *body_.control, term) : term;
  }

  void Rates() {
    std::vector<TermId> rates;
    for (size_t i = 0; i < body_.states.size(); ++i) {
      if (!body_.derivatives[i]) {
        Problem(fmt::format("nothing is known about how `{}` changes: it is not in `dynamics`",
                            body_.states[i].name.text));
        return;
      }
      rates.push_back(Continuous(*body_.derivatives[i]));
    }
    code_.rates = Compiled(rates, "`dynamics`");
  }

  void Controller(const robot::Control& control) {
    for (const auto& [variable, value] : control.laws) set_.push_back(variable);
    if (control.period) {
      code_.period = expr::Numeric(arena_, {})(*control.period);
      code_.laws = Update(control.laws, "`control`");
    }
    for (const robot::ControlEvent& event : control.events)
      code_.events.push_back(
          {CompiledFormula(Continuous(event.condition), "`when`"), Update(event.updates, "`when`")});
  }

  bool IsFreeInput(TermId term) const {
    return std::ranges::find(body_.inputs, term, &robot::Variable::term) != body_.inputs.end() &&
           std::ranges::find(set_, term) == set_.end();
  }

  void Ports() {
    for (const auto& [name, value] : body_.ports) {
      RobotCode::Port port;
      port.name = name;
      port.port.number = code_.ports.size();
      const std::string what = fmt::format("port `{}`", name);
      std::vector<TermId> terms;
      for (const TermId t : value.terms) terms.push_back(Continuous(t));
      if (value.kind == robot::ValueKind::kBool) {
        port.port.kind = BodyPort::Kind::kBool;
        port.holds = CompiledFormula(terms[0], what);
      } else if (terms.size() == 1) {
        port.values = Compiled(terms, what);
      } else if (terms.size() == 2 || terms.size() == 3) {
        port.port.kind = BodyPort::Kind::kPoint;
        terms.resize(3, arena_.Number(arena_.Real(), expr::Rational(0)));
        port.values = Compiled(terms, what);
      } else {
        Problem(fmt::format("{} is no number, point or condition", what));
        continue;
      }
      port.port.settable = std::ranges::any_of(value.terms, [&](TermId t) { return IsFreeInput(t); });
      for (const TermId t : value.terms) {
        if (!port.port.settable) break;
        // What is no input of a point that can be set, such as the height of a target on the floor, is ignored.
        port.set.push_back(IsFreeInput(t) ? NumberOf(t) : code_.variables.size());
        if (IsFreeInput(t)) by_port_.push_back(t);
      }
      code_.ports.push_back(std::move(port));
    }
  }

  void Disturbances() {
    for (const robot::Variable& v : body_.inputs) {
      if (std::ranges::find(set_, v.term) != set_.end() ||
          std::ranges::find(by_port_, v.term) != by_port_.end())
        continue;
      const size_t number = NumberOf(v.term);
      const RobotVariable& variable = code_.variables[number];
      if (!std::isfinite(variable.low) || !std::isfinite(variable.high)) {
        Problem(
            fmt::format("nobody sets the input `{0}`, and it has no range: add a law to `control`, a port, "
                        "or a range if `{0}` is a disturbance",
                        v.name.text));
      }
      code_.disturbances.push_back(number);
    }
  }

  void Place() {
    robot::Pose pose = body_.self;
    const robot::Value* base = body_.scope.Find("base");
    if (base != nullptr && base->kind == robot::ValueKind::kFrame) pose = *base->pose;
    std::vector<TermId> terms(pose.origin.begin(), pose.origin.end());
    if (base == nullptr) {
      for (size_t i = 0; i < 3; ++i) {
        if (code_.position[i] < code_.states) terms[i] = terms_[code_.position[i]];
      }
    }
    for (const robot::Vector& row : pose.rotation) terms.insert(terms.end(), row.begin(), row.end());
    code_.place = Compiled(terms, "the frame `base`");
  }

  const robot::World& world_;
  const robot::Body& body_;
  expr::Arena& arena_;
  RobotCode code_;
  std::vector<TermId> terms_;    // of the variables
  std::vector<TermId> set_;      // by the controller
  std::vector<TermId> by_port_;  // inputs that a program may set
  std::string problem_;
};

}  // namespace

base::Result<RobotCode> CodeOf(const robot::World& world, const robot::Body& body, expr::Arena& arena) {
  return Builder(world, body, arena).Run();
}

}  // namespace rondo::sim
