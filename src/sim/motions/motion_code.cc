#include "sim/motions/motion_code.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/numeric.h"
#include "robot/model/control.h"

namespace rondo::sim::motions {
namespace {

using expr::TermId;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Coder {
 public:
  Coder(const choreo::Graph& graph, const choreo::Instance& instance, expr::Arena& arena,
        const SceneState& scene)
      : instance_(instance), body_(graph.BodyOf(instance.robot)), arena_(arena), scene_(scene) {}

  base::Result<MotionCode> Run() {
    const robot::Contract& c = instance_.contract;
    std::vector<TermId> ranges;
    std::vector<size_t> free;
    std::vector<double> low, high;
    for (size_t i = 0; i < body_.states.size(); ++i) {
      if (i >= c.modifies.size() || !c.modifies[i]) continue;
      const robot::Variable& v = body_.states[i];
      free.push_back(scene_.Of(v.term));
      low.push_back(v.least ? expr::Numeric(arena_, {})(*v.least) : -kInfinity);
      high.push_back(v.most ? expr::Numeric(arena_, {})(*v.most) : kInfinity);
      if (v.least) ranges.push_back(arena_.Le(*v.least, v.term));
      if (v.most) ranges.push_back(arena_.Le(v.term, *v.most));
    }
    ranges.push_back(c.during);
    const TermId during = arena_.And(ranges);
    auto pre = Compiled(c.pre), assume = Compiled(c.assume), all_along = Compiled(during),
         end = Compiled(arena_.And(during, c.post));
    if (!problem_.empty()) return base::Error{problem_};
    MotionCode code{fmt::format("{}: {}", body_.name.text, instance_.text),
                    instance_.text,
                    instance_.robot.index(),
                    instance_.duration.least.ToDouble(),
                    instance_.duration.most ? instance_.duration.most->ToDouble() : kInfinity,
                    instance_.duration.interruptible,
                    std::move(free),
                    std::move(low),
                    std::move(high),
                    Reads({c.pre, during, c.post}),
                    std::move(*pre),
                    std::move(*assume),
                    std::move(*all_along),
                    std::move(*end),
                    std::nullopt,
                    false,
                    std::nullopt};
    const auto& footprint = c.footprint ? c.footprint : body_.body;
    if (footprint) code.footprint = robot::Solid::Of(arena_, *footprint, scene_.variables());
    code.unseen = footprint && !code.footprint;
    if (instance_.control && HasDynamics()) code.drive = Drive(*instance_.control);
    if (!problem_.empty()) return base::Error{problem_};
    return code;
  }

 private:
  void Problem(const std::string& what, const base::Error& error) {
    if (problem_.empty())
      problem_ = fmt::format("{} of `{}: {}`: {}", what, body_.name.text, instance_.text, error.message);
  }

  std::optional<Condition> Compiled(TermId formula) {
    auto condition = Condition::Of(arena_, formula, scene_.variables());
    if (condition.ok()) return std::move(condition).value();
    Problem("the contract", condition.error());
    return std::nullopt;
  }

  std::vector<size_t> Reads(const std::vector<TermId>& terms) const {
    std::vector<size_t> places;
    for (const TermId t : robot::VariablesOf(arena_, terms)) places.push_back(scene_.Of(t));
    return places;
  }

  bool HasDynamics() const {
    return !body_.derivatives.empty() &&
           std::ranges::all_of(body_.derivatives, [](const auto& d) { return d.has_value(); });
  }

  std::optional<Assignment> Assigned(const std::vector<std::pair<TermId, TermId>>& pairs) {
    std::vector<size_t> set;
    std::vector<TermId> values;
    for (const auto& [variable, value] : pairs) {
      set.push_back(scene_.Of(variable));
      values.push_back(value);
    }
    auto functions = Functions::Of(arena_, values, scene_.variables());
    if (functions.ok()) return Assignment{std::move(set), std::move(functions).value()};
    Problem("the controller", functions.error());
    return std::nullopt;
  }

  std::optional<DriveCode> Drive(const robot::Control& control) {
    std::vector<std::pair<TermId, TermId>> rates;
    // What a motion does not modify stays as it is.
    for (size_t i = 0; i < body_.states.size(); ++i) {
      if (i >= instance_.contract.modifies.size() || !instance_.contract.modifies[i]) continue;
      rates.emplace_back(body_.states[i].term, robot::Determined(arena_, control, *body_.derivatives[i]));
    }
    auto flow = Assigned(rates);
    auto laws = Assigned(control.laws);
    if (!flow || !laws) return std::nullopt;
    DriveCode drive{0, std::nullopt, std::move(*flow), {}};
    if (control.period) {
      drive.period = expr::Numeric(arena_, {})(*control.period);
      drive.laws = std::move(laws);
    }
    for (const robot::ControlEvent& e : control.events) {
      auto condition = Compiled(e.condition);
      auto update = Assigned(e.updates);
      if (!condition || !update) return std::nullopt;
      drive.events.push_back({std::move(*condition), std::move(*update)});
    }
    return drive;
  }

  const choreo::Instance& instance_;
  const robot::Body& body_;
  expr::Arena& arena_;
  const SceneState& scene_;
  std::string problem_;
};

}  // namespace

base::Result<MotionCode> CodeOf(const choreo::Graph& graph, const choreo::Instance& instance,
                                expr::Arena& arena, const SceneState& scene) {
  return Coder(graph, instance, arena, scene).Run();
}

}  // namespace rondo::sim::motions
