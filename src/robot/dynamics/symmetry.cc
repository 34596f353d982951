#include "robot/dynamics/symmetry.h"

#include <algorithm>
#include <limits>
#include <set>

#include "reach/problem/bounds.h"
#include "reach/problem/symmetry.h"

namespace rondo::robot {

using interval::Interval;

namespace {

class Reducer {
 public:
  Reducer(const World& world, const Body& body, const MotionInstance& instance, Evaluator& evaluator,
          std::string_view keep)
      : world_(world),
        body_(body),
        instance_(instance),
        keep_(keep),
        arena_(evaluator.arena()),
        // That a parameter has no value may be an error of its own, which nobody needs to know of.
        evaluator_(arena_, evaluator.pool(), unheard_, evaluator.loose()) {}

  std::optional<Reduced> Run() {
    if (!Symbolic()) return std::nullopt;
    auto made = ProblemOf(world_, body_, symbolic_, arena_);
    if (!made.ok()) return std::nullopt;
    problem_ = std::move(made).value();
    if (!Describe()) return std::nullopt;
    const reach::Removable removable = reach::RemovableParameters(structure_);
    if (removable.parameters.empty()) return std::nullopt;
    std::set<TermId> free;
    for (const size_t c : removable.parameters) free.insert(structure_.coordinates[c].term);
    for (const size_t c : removable.moved) moved_.insert(structure_.coordinates[c].term);
    if (!StaysInRange(symbolic_.contract.during, symbolic_.unknowns)) return std::nullopt;

    Reduced result;
    const auto problem = Fixed(free, false);
    auto anywhere = Fixed(free, true);
    if (!problem || !anywhere) return std::nullopt;
    result.anywhere = std::move(anywhere->problem);
    bool ranged = false;
    for (size_t i = 0; i < parameters_.size(); ++i) {
      if (!parameters_[i].valid() || !free.contains(parameters_[i])) continue;
      result.parameters.push_back(instance_.motion->params[i].name.text);
      ranged = ranged || IsUnknown(parameters_[i]);
    }
    if (ranged) result.made = problem;
    return result;
  }

 private:
  bool IsUnknown(TermId term) const {
    return std::ranges::find(instance_.unknowns, term, &Variable::term) != instance_.unknowns.end();
  }

  // The motion with variables for lengths and angles.
  bool Symbolic() {
    const MotionDef& motion = *instance_.motion;
    std::vector<Value> args = instance_.arguments;
    std::vector<Variable> unknowns = instance_.unknowns;
    parameters_.resize(args.size());
    bool any = false;
    for (size_t i = 0; i < args.size(); ++i) {
      if (args[i].kind != ValueKind::kQuantity || args[i].any_dimension) continue;
      if (!(args[i].dimension == kLength) && !(args[i].dimension == kAngle)) continue;
      any = true;
      parameters_[i] = args[i].terms[0];
      if (IsUnknown(parameters_[i])) continue;
      const TermId value = parameters_[i];
      parameters_[i] = arena_.FreshConstant(motion.params[i].name.text, arena_.Real());
      args[i] = Quantity(parameters_[i], args[i].dimension);
      unknowns.push_back({motion.params[i].name, args[i].dimension, parameters_[i], value, value});
    }
    if (!any) return false;
    symbolic_ = With(args, std::move(unknowns));
    return !unheard_.has_errors();
  }

  MotionInstance With(const std::vector<Value>& args, std::vector<Variable> unknowns) {
    std::vector<diag::Span> spans;
    for (const Param& p : instance_.motion->params) spans.push_back(p.name.span);
    MotionInstance other = InstanceOf(body_, *instance_.motion, args, spans, evaluator_);
    other.text = instance_.text;
    other.duration = instance_.duration;
    other.least = instance_.least;
    other.interruptible = instance_.interruptible;
    other.known_duration = instance_.known_duration;
    other.unknowns = std::move(unknowns);
    return other;
  }

  size_t KindOf(const lang::Dimension& dimension) {
    const auto it = std::ranges::find(kinds_, dimension);
    if (it != kinds_.end()) return static_cast<size_t>(it - kinds_.begin());
    kinds_.push_back(dimension);
    return kinds_.size() - 1;
  }

  bool Describe() {
    const reach::Problem& p = problem_.problem;
    structure_.arena = &arena_;
    for (const Variable& v : body_.states)
      structure_.coordinates.push_back({v.term, KindOf(v.dimension), false});
    // Inputs that are held have no values of their own before the controller acts.
    std::vector<TermId> reads{symbolic_.contract.pre};
    for (const auto& [variable, law] : symbolic_.control ? symbolic_.control->laws : Control().laws)
      reads.push_back(law);
    const std::set<TermId> read = VariablesOf(arena_, reads);
    for (const Variable& v : body_.inputs) {
      const bool held = std::ranges::find(p.states, v.term) != p.states.end();
      if (held && !read.contains(v.term) && p.events.empty())
        structure_.coordinates.push_back({v.term, KindOf(v.dimension), false});
    }
    for (size_t i = 0; i < parameters_.size(); ++i) {
      if (parameters_[i].valid())
        structure_.coordinates.push_back({parameters_[i], KindOf(instance_.arguments[i].dimension), true,
                                          instance_.motion->params[i].name.text == keep_});
    }
    for (size_t i = 0; i < p.states.size(); ++i) structure_.rates.emplace_back(p.states[i], p.rates[i]);
    const std::vector<TermId> updated = reach::Updated(p);
    for (size_t i = 0; i < p.states.size(); ++i) structure_.jumps.emplace_back(p.states[i], updated[i]);
    bool good = Keep(symbolic_.contract.pre) && Keep(symbolic_.contract.assume);
    for (const reach::Event& e : p.events) {
      good = good && Keep(e.condition);
      for (const auto& value : e.updates) {
        if (value) structure_.invariant.push_back(*value);
      }
    }
    for (size_t c = 0; c < p.claims.size(); ++c) {
      const bool range = std::ranges::find(problem_.in_range, c) != problem_.in_range.end();
      good = good && (range || Keep(p.claims[c].formula));
    }
    return good;
  }

  bool Keep(TermId formula) {
    const auto normal = reach::Normalise(arena_, formula);
    if (!normal.ok()) return false;
    structure_.invariant.insert(structure_.invariant.end(), normal.value().terms.begin(),
                                normal.value().terms.end());
    return true;
  }

  // Does the formula keep all that is moved in its range, for parameters like these?
  bool StaysInRange(TermId formula, const std::vector<Variable>& unknowns) {
    const reach::Problem& p = problem_.problem;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<TermId> variables = p.states;
    interval::Box box(p.states.size(), Interval{-kInfinity, kInfinity});
    for (const reach::Input& i : p.inputs) {
      variables.push_back(i.term);
      box.push_back(i.bounds);
    }
    for (size_t i = 0; i < p.states.size(); ++i) {
      if (p.states[i] == world_.clock) box[i] = {0, reach::Enclose(p.horizon).hi};
      const auto u = std::ranges::find(unknowns, p.states[i], &Variable::term);
      if (u == unknowns.end()) continue;
      const auto least = ConstantRange(arena_, u->least);
      const auto most = ConstantRange(arena_, u->most);
      if (least && most) box[i] = interval::Hull(*least, *most);
    }
    if (!reach::Contract(arena_, formula, variables, box)) return false;
    return std::ranges::all_of(body_.states, [&](const Variable& v) {
      if (!moved_.contains(v.term)) return true;
      const auto least = ConstantRange(arena_, v.least);
      const auto most = ConstantRange(arena_, v.most);
      const Interval& side = box[static_cast<size_t>(std::ranges::find(p.states, v.term) - p.states.begin())];
      return (!v.least || (least && side.lo >= least->hi)) && (!v.most || (most && side.hi <= most->lo));
    });
  }

  // The problem with one value for each parameter that does not matter, if `pre` alone keeps the start in the
  // ranges of the states then. `zero`: zero; else its own, or the middle of its range.
  std::optional<MotionProblem> Fixed(const std::set<TermId>& free, bool zero) {
    const TermId none = arena_.Number(arena_.Real(), expr::Rational(0));
    const TermId half = arena_.Number(arena_.Real(), expr::Rational(1) / expr::Rational(2));
    std::vector<Variable> unknowns = symbolic_.unknowns;
    std::vector<Value> args = instance_.arguments;
    std::vector<Variable> left;
    for (size_t i = 0; i < unknowns.size(); ++i) {
      Variable& u = unknowns[i];
      if (free.contains(u.term)) {
        const TermId value = zero ? none : arena_.Mul(half, arena_.Add(*u.least, *u.most));
        u.least = u.most = value;
        const auto at = static_cast<size_t>(std::ranges::find(parameters_, u.term) - parameters_.begin());
        args[at] = Quantity(value, u.dimension);
      } else if (IsUnknown(u.term)) {
        left.push_back(u);
      }
    }
    if (!StaysInRange(symbolic_.contract.pre, unknowns)) return std::nullopt;
    auto made = ProblemOf(world_, body_, With(args, std::move(left)), arena_);
    if (!made.ok() || unheard_.has_errors()) return std::nullopt;
    return std::move(made).value();
  }

  const World& world_;
  const Body& body_;
  const MotionInstance& instance_;
  std::string_view keep_;
  Arena& arena_;
  diag::Diagnostics unheard_;
  Evaluator evaluator_;
  MotionInstance symbolic_;
  std::vector<TermId> parameters_;  ///< by parameter: its variable, if it has one
  MotionProblem problem_;           ///< with these
  reach::Structure structure_;
  std::vector<lang::Dimension> kinds_;
  std::set<TermId> moved_;
};

}  // namespace

std::optional<Reduced> WithoutPlace(const World& world, const Body& body, const MotionInstance& instance,
                                    Evaluator& evaluator, std::string_view keep) {
  if (instance.motion == nullptr) return std::nullopt;
  return Reducer(world, body, instance, evaluator, keep).Run();
}

}  // namespace rondo::robot
