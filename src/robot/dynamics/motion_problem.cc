#include "robot/dynamics/motion_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "reach/problem/bounds.h"
#include "robot/model/control.h"

namespace rondo::robot {

using expr::Rational;
using interval::Interval;

namespace {

std::optional<Rational> Constant(const Arena& arena, std::optional<TermId> term) {
  if (!term || !arena.IsNumber(*term)) return std::nullopt;
  return arena.number(*term);
}

class Builder {
 public:
  Builder(const World& world, const Body& body, const MotionInstance& instance, Arena& arena)
      : world_(world), body_(body), motion_(instance), arena_(arena) {}

  base::Result<MotionProblem> Run() {
    reach::Problem& p = out_.problem;
    p.name = fmt::format("{}: {}", body_.name.text, motion_.text);
    p.arena = &arena_;
    out_.robot_states = body_.states.size();
    if (!motion_.known_duration) return base::Error{"how long it takes is no constant"};
    rests_ = std::ranges::none_of(motion_.contract.modifies, [](bool m) { return m; });
    p.horizon = motion_.duration.value_or(Rational(1));
    if (!motion_.duration && motion_.control && motion_.control->period) {
      // Whole periods, about a second of them.
      const auto period = Constant(arena_, motion_.control->period);
      if (period && *period > Rational(0))
        p.horizon = *period * ((Rational(1) / *period).Floor() + Rational(1));
    }
    if (!(p.horizon > Rational(0))) return base::Error{"it takes no time at all"};
    if (!motion_.control && !body_.inputs.empty() && motion_.motion != nullptr) {
      return base::Error{fmt::format(
          "no controller sets `{}`: write `control {{ ... }}`, and leave out inputs that are disturbances",
          body_.inputs[0].name.text)};
    }
    if (auto wrong = States(); !wrong.empty()) return base::Error{wrong};
    if (auto wrong = Inputs(); !wrong.empty()) return base::Error{wrong};
    if (auto wrong = Start(); !wrong.empty()) return base::Error{wrong};
    if (auto wrong = ForEver(); !wrong.empty()) return base::Error{wrong};
    Claims();
    return std::move(out_);
  }

 private:
  // Where a variable may be.
  std::vector<TermId> Range(const Variable& v) {
    std::vector<TermId> bounds;
    if (v.least) bounds.push_back(arena_.Le(*v.least, v.term));
    if (v.most) bounds.push_back(arena_.Le(v.term, *v.most));
    return bounds;
  }

  // All that makes the states change.
  std::vector<TermId> Motion() const {
    std::vector<TermId> terms = out_.problem.rates;
    for (const TermId t : reach::Updated(out_.problem)) terms.push_back(t);
    if (motion_.control) AddEvents(*motion_.control, terms);
    return terms;
  }

  static void AddEvents(const Control& control, std::vector<TermId>& terms) {
    for (const ControlEvent& event : control.events) {
      terms.push_back(event.condition);
      for (const auto& [variable, value] : event.updates) terms.push_back(value);
    }
  }

  TermId Zero() { return arena_.Number(arena_.Real(), Rational(0)); }

  bool Sampled(TermId input) const {
    if (!motion_.control || !motion_.control->period) return false;
    return std::ranges::any_of(motion_.control->laws, [&](const auto& law) { return law.first == input; });
  }

  // What an input was before the controller acts first: does anything depend on it?
  bool ReadBeforeSet(TermId input) const {
    std::vector<TermId> terms{motion_.contract.pre};
    for (const auto& [variable, value] : motion_.control->laws) terms.push_back(value);
    AddEvents(*motion_.control, terms);
    return VariablesOf(arena_, terms).contains(input);
  }

  void Add(const std::string& name, TermId term, TermId rate, const Variable* variable,
           lang::Dimension dimension) {
    reach::Problem& p = out_.problem;
    out_.scope.names.emplace(name, Quantity(term, dimension));
    p.states.push_back(term);
    p.rates.push_back(rate);
    out_.names.push_back(name);
    ranges_.push_back(variable);
  }

  bool UsesClock() const {
    std::vector<TermId> terms{motion_.contract.pre, motion_.contract.assume, motion_.contract.during,
                              motion_.contract.post};
    for (const auto& rate : body_.derivatives) {
      if (rate) terms.push_back(*rate);
    }
    if (motion_.control) {
      for (const auto& [variable, value] : motion_.control->laws) terms.push_back(value);
      AddEvents(*motion_.control, terms);
    }
    return VariablesOf(arena_, terms).contains(world_.clock);
  }

  // Plant, controller memory, held inputs, clock.
  std::string States() {
    reach::Problem& p = out_.problem;
    // Inputs that a continuous controller sets are what it says.
    std::unordered_map<TermId, TermId> laws;
    if (motion_.control && !motion_.control->period) {
      for (const auto& [variable, value] : motion_.control->laws) laws.emplace(variable, value);
    }
    const auto substituted = [&](TermId t) {
      return motion_.control ? Determined(arena_, *motion_.control, t) : t;
    };
    for (size_t i = 0; i < body_.states.size(); ++i) {
      const Variable& v = body_.states[i];
      if (!body_.derivatives[i])
        return fmt::format("nothing is known about how `{}` changes: it is not in `dynamics`", v.name.text);
      const TermId rate = substituted(*body_.derivatives[i]);
      if (!motion_.contract.modifies[i] && rate != Zero()) {
        return fmt::format(
            "`{}` is not in `modifies`, but its rate under the motion's controller is not zero", v.name.text);
      }
      Add(v.name.text, v.term, rate, &v, v.dimension);
    }
    for (const Variable& v : body_.memory) {
      if (laws.contains(v.term))
        return fmt::format("`{}` is memory: it needs a controller with a period", v.name.text);
      Add(v.name.text, v.term, Zero(), &v, v.dimension);
    }
    for (const Variable& v : body_.inputs) {
      if (Sampled(v.term))
        Add(v.name.text, v.term, Zero(), ReadBeforeSet(v.term) ? &v : nullptr, v.dimension);
    }
    if (UsesClock())
      Add("clock", world_.clock, arena_.Number(arena_.Real(), Rational(1)), nullptr,
          lang::Dimension{.time = 1});
    for (const auto* list : {&motion_.unknowns, &body_.unknowns}) {
      for (const Variable& u : *list) Add(u.name.text, u.term, Zero(), &u, u.dimension);
    }
    for (const auto& [copy, state] : motion_.copies) {
      const auto of = std::ranges::find(body_.states, state, &Variable::term);
      Add(arena_.symbol(arena_.symbol_of(copy)).name, copy, Zero(), nullptr,
          of == body_.states.end() ? lang::Dimension{} : of->dimension);
    }
    if (motion_.control && motion_.control->period) {
      const auto period = Constant(arena_, motion_.control->period);
      if (!period || !(*period > Rational(0))) return "the period of the controller is no positive constant";
      reach::Controller controller;
      controller.period = *period;
      controller.updates.resize(p.states.size());
      for (const auto& [variable, value] : motion_.control->laws) {
        const auto it = std::ranges::find(p.states, variable);
        controller.updates[static_cast<size_t>(it - p.states.begin())] = value;
      }
      p.controller = std::move(controller);
    }
    for (const ControlEvent& event :
         motion_.control ? motion_.control->events : std::vector<ControlEvent>{}) {
      reach::Event e{substituted(event.condition), {}};
      e.updates.resize(p.states.size());
      for (const auto& [variable, value] : event.updates)
        e.updates[static_cast<size_t>(std::ranges::find(p.states, variable) - p.states.begin())] =
            substituted(value);
      p.events.push_back(std::move(e));
    }
    return "";
  }

  // What the equations mention and nobody sets.
  std::string Inputs() {
    reach::Problem& p = out_.problem;
    std::vector<TermId> terms = Motion();
    std::vector<TermId> about = {motion_.contract.pre, motion_.contract.during, motion_.contract.post};
    terms.insert(terms.end(), about.begin(), about.end());
    std::unordered_map<TermId, const Variable*> known;
    for (const Body& other : world_.bodies) {
      for (const auto* list : {&other.states, &other.inputs, &other.unknowns}) {
        for (const Variable& v : *list) known.emplace(v.term, &v);
      }
    }
    for (const Variable& v : world_.environment) known.emplace(v.term, &v);
    for (const TermId t : VariablesOf(arena_, terms)) {
      if (std::ranges::find(p.states, t) != p.states.end()) continue;
      const std::string& name = arena_.symbol(arena_.symbol_of(t)).name;
      const auto it = known.find(t);
      if (it == known.end()) return fmt::format("`{}` has no known value", name);
      const auto least = ConstantRange(arena_, it->second->least);
      const auto most = ConstantRange(arena_, it->second->most);
      if (!least || !most) return fmt::format("the input `{}` has no bounds", it->second->name.text);
      p.inputs.push_back({t, {least->lo, most->hi}});
      if (std::ranges::find(body_.inputs, t, &Variable::term) != body_.inputs.end())
        out_.scope.names.emplace(it->second->name.text, Quantity(t, it->second->dimension));
      out_.assumed.push_back(fmt::format("`{}` in [{:.6g}, {:.6g}]", name, least->lo, most->hi));
    }
    // The contract assumes more of them.
    if (motion_.contract.assume != arena_.True() && !p.inputs.empty()) {
      interval::Box box;
      std::vector<TermId> variables = p.states;
      for (size_t i = 0; i < p.states.size(); ++i) box.push_back({});
      for (const reach::Input& i : p.inputs) {
        variables.push_back(i.term);
        box.push_back(i.bounds);
      }
      if (reach::Contract(arena_, motion_.contract.assume, variables, box)) {
        for (size_t i = 0; i < p.inputs.size(); ++i) p.inputs[i].bounds = box[p.states.size() + i];
        out_.assumed.emplace_back("what the contract assumes of its surroundings");
      }
    }
    for (const reach::Input& i : p.inputs) {
      if (i.bounds.IsEmpty()) return "what the contract assumes of its inputs is never true";
    }
    return "";
  }

  // The states that satisfy `pre`, in their ranges.
  std::string Start() {
    reach::Problem& p = out_.problem;
    std::vector<TermId> conditions{motion_.contract.pre};
    for (size_t i = 0; i < p.states.size(); ++i) {
      const Variable* v = ranges_[i];
      const auto copy = std::ranges::find(motion_.copies, p.states[i], [](const auto& c) { return c.first; });
      if (copy != motion_.copies.end()) {
        p.copy_of.resize(p.states.size());
        p.copy_of[i] = static_cast<size_t>(std::ranges::find(p.states, copy->second) - p.states.begin());
        continue;
      }
      if (v == nullptr) {  // the clock, and inputs that will be set at once
        conditions.push_back(arena_.Eq(p.states[i], Zero()));
        continue;
      }
      for (const TermId bound : Range(*v)) conditions.push_back(bound);
    }
    p.assume = arena_.And(conditions);
    // What it says about inputs is about the moment of the start: it only bounds states where it must.
    std::vector<TermId> variables = p.states;
    interval::Box box(p.states.size());
    for (const reach::Input& i : p.inputs) {
      variables.push_back(i.term);
      box.push_back(i.bounds);
    }
    auto formula = reach::Normalise(arena_, p.assume);
    if (!formula.ok()) return fmt::format("in `pre`: {}", formula.error().message);
    auto terms = reach::Compile(arena_, variables, formula.value().terms);
    if (!terms.ok()) return fmt::format("in `pre`: {}", terms.error().message);
    p.pinned = reach::Pinned(arena_, terms.value(), formula.value());
    p.pinned.resize(p.states.size());
    reach::Contract(arena_, terms.value(), formula.value(), box);
    for (size_t i = 0; i < p.states.size(); ++i) {
      if (i < p.copy_of.size() && p.copy_of[i]) continue;
      if (box[i].IsEmpty()) return "no state satisfies `pre`";
      if (!std::isfinite(box[i].lo) || !std::isfinite(box[i].hi))
        return fmt::format("nothing bounds `{}` at the start", out_.names[i]);
    }
    box.resize(p.states.size());
    for (size_t i = 0; i < p.copy_of.size(); ++i) {
      if (!p.copy_of[i]) continue;
      const interval::Interval original = box[*p.copy_of[i]];
      box[i] = original;
    }
    p.initial = std::move(box);
    if (!p.inputs.empty()) {
      // Only what is about states alone is left for refutations to satisfy.
      std::vector<TermId> own;
      for (const TermId c : conditions) {
        bool alone = true;
        for (const TermId t : VariablesOf(arena_, {c}))
          alone = alone && std::ranges::find(p.states, t) != p.states.end();
        if (alone) own.push_back(c);
      }
      p.assume = arena_.And(own);
    }
    return "";
  }

  // A motion without an end. What does not move keeps its promises as long as it likes: the start says
  // everything. Else it must be back where it may begin after a while: then it can go on in the same way.
  std::string ForEver() {
    if (motion_.duration) return "";
    reach::Problem& p = out_.problem;
    std::vector<TermId> terms = Motion();
    terms.push_back(motion_.contract.during);
    terms.push_back(motion_.contract.pre);
    if (VariablesOf(arena_, terms).contains(world_.clock))
      return "it may go on for ever, and what it does depends on the clock";
    for (const TermId t : VariablesOf(arena_, {motion_.contract.during, motion_.contract.pre})) {
      if (std::ranges::find(body_.states, t, &Variable::term) == body_.states.end())
        return "it may go on for ever, and what it promises is not about its state alone";
    }
    if (rests_) return "";
    std::vector<TermId> again{motion_.contract.pre};
    for (const auto* list : {&body_.states, &body_.memory}) {
      for (const Variable& v : *list) {
        // What nobody sets is as it was.
        const auto at = static_cast<size_t>(std::ranges::find(p.states, v.term) - p.states.begin());
        const bool event =
            std::ranges::any_of(p.events, [&](const reach::Event& e) { return e.updates[at].has_value(); });
        if (p.rates[at] == Zero() && !(p.controller && p.controller->updates[at]) && !event) continue;
        for (const TermId bound : Range(v)) again.push_back(bound);
      }
    }
    p.claims.push_back({"back where it may begin", arena_.And(again), p.horizon, p.horizon});
    return "";
  }

  // Is a term at most (at least) this, as one can see: numbers, clamps, choices?
  bool Bounded(TermId term, TermId limit, bool upper) {
    if (term == limit) return true;
    const TermId holds = upper ? arena_.Le(term, limit) : arena_.Le(limit, term);
    if (holds == arena_.True()) return true;
    const auto part = [&](size_t i) { return Bounded(arena_.arg(term, i), limit, upper); };
    if (arena_.op(term) == expr::Op::kIte) return part(1) && part(2);
    if (arena_.op(term) != expr::Op::kElementary) return false;
    const expr::Elementary e = arena_.elementary_of(term);
    if (e != expr::Elementary::kMin && e != expr::Elementary::kMax) return false;
    const bool one = (e == expr::Elementary::kMin) == upper;
    return one ? part(0) || part(1) : part(0) && part(1);
  }

  void Claims() {
    reach::Problem& p = out_.problem;
    const Rational start(0);
    if (motion_.contract.during != arena_.True())
      p.claims.push_back({"during", motion_.contract.during, start, p.horizon});
    if (motion_.contract.post != arena_.True()) {
      // A motion that may be interrupted ends at any time that its duration allows; without an end it comes
      // back to where it began, so from the beginning. Any other ends when its controller says so: at the
      // latest time here.
      Rational from = p.horizon;
      if (motion_.interruptible) from = motion_.duration ? motion_.least : start;
      if (!motion_.interruptible && motion_.least < p.horizon)
        out_.assumed.push_back(fmt::format("`{}` ends after {} s, the longest that it may take", motion_.text,
                                           p.horizon.ToString()));
      p.claims.push_back({"post", motion_.contract.post, from, p.horizon});
    }
    for (size_t i = 0; i < body_.states.size(); ++i) {
      const Variable& v = body_.states[i];
      if (!motion_.contract.modifies[i] ||
          std::ranges::find(motion_.visible, v.term) != motion_.visible.end())
        continue;
      const std::vector<TermId> range = Range(v);
      if (range.empty()) continue;
      out_.in_range.push_back(p.claims.size());
      p.claims.push_back({fmt::format("{} in its range", v.name.text), arena_.And(range), start, p.horizon});
    }
    // What a controller sets stays in its range, too.
    for (const Variable& v : body_.inputs) {
      if (!motion_.control || (!v.least && !v.most)) continue;
      for (const auto& [variable, value] : motion_.control->laws) {
        if (variable != v.term) continue;
        const TermId set = motion_.control->period ? v.term : value;
        std::vector<TermId> range;
        if (v.least && !Bounded(value, *v.least, false)) range.push_back(arena_.Le(*v.least, set));
        if (v.most && !Bounded(value, *v.most, true)) range.push_back(arena_.Le(set, *v.most));
        if (range.empty()) continue;
        p.claims.push_back(
            {fmt::format("{} in its range", v.name.text), arena_.And(range), start, p.horizon});
      }
    }
  }

  const World& world_;
  const Body& body_;
  const MotionInstance& motion_;
  Arena& arena_;
  MotionProblem out_;
  std::vector<const Variable*> ranges_;
  bool rests_ = false;
};

}  // namespace

std::optional<Interval> ConstantRange(const Arena& arena, std::optional<TermId> term) {
  if (!term) return std::nullopt;
  auto program = reach::Compile(arena, {}, {*term});
  if (!program.ok()) return std::nullopt;
  return reach::ValuesOn(program.value(), {})[program.value().outputs[0]];
}

base::Result<MotionProblem> ProblemOf(const World& world, const Body& body, const MotionInstance& instance,
                                      Arena& arena) {
  return Builder(world, body, instance, arena).Run();
}

}  // namespace rondo::robot
