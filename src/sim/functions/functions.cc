#include "sim/functions/functions.h"

#include <initializer_list>
#include <string_view>

namespace rondo::sim {

using koord::semantics::ToFloat;
using lang::TypeKind;

namespace {

/// The shape of a parameter or result.
enum class Shape : uint8_t { kBool, kInt, kFloat, kPoint, kPath, kOpaque, kCells, kPaths };

bool Fits(const koord::Model& model, lang::TypeId type, Shape shape) {
  const auto& types = model.types;
  const auto point = [&](lang::TypeId t) { return types.Resolve(t) == types.pos(); };
  const auto is_list = [&] { return types.Is(type, TypeKind::kList); };
  switch (shape) {
    case Shape::kBool:
      return types.Is(type, TypeKind::kBool);
    case Shape::kInt:
      return types.Is(type, TypeKind::kInt);
    case Shape::kFloat:
      return types.Is(type, TypeKind::kFloat);
    case Shape::kPoint:
      return point(type);
    case Shape::kOpaque:
      return types.Is(type, TypeKind::kOpaque);
    case Shape::kPath:
      return is_list() && point(types[type].parts[0]);
    case Shape::kCells:
      return is_list() && types.Is(types[type].parts[0], TypeKind::kOpaque);
    case Shape::kPaths:  // of every robot
      return true;
  }
  return false;
}

}  // namespace

struct Functions::Entry {
  std::string_view name;  ///< empty: of a callable port, whatever its name
  Shape result;
  std::vector<Shape> parameters;
  Handler handler;
};

const Functions::Entry Functions::kFunctions[] = {
    {"pathIsClear", Shape::kBool, {Shape::kPaths, Shape::kPath, Shape::kInt}, &Functions::PathIsClear},
    {"apart", Shape::kFloat, {Shape::kPath, Shape::kPath}, &Functions::Apart},
    {"away", Shape::kFloat, {Shape::kPoint, Shape::kPath}, &Functions::Away},
    {"merge", Shape::kOpaque, {Shape::kOpaque, Shape::kOpaque}, &Functions::MergeMaps},
    {"scanToMap", Shape::kOpaque, {Shape::kPoint, Shape::kOpaque}, &Functions::ScanToMap},
    {"pickFrontierPos", Shape::kPoint, {Shape::kOpaque, Shape::kPoint}, &Functions::PickFrontier},
    {"findObs", Shape::kCells, {Shape::kOpaque}, &Functions::FindObstacles},
    {"right", Shape::kBool, {Shape::kOpaque}, &Functions::Right},
    {"true_scan", Shape::kBool, {Shape::kPoint, Shape::kOpaque}, &Functions::TrueScan},
    {"", Shape::kPath, {Shape::kPoint}, &Functions::PlanPath},
    {"", Shape::kPath, {Shape::kPoint, Shape::kCells}, &Functions::PlanAround},
};

Functions::Functions(const koord::Model& model, const Fleet& fleet, uint64_t seed)
    : model_(model), fleet_(fleet), seed_(seed), path_clearance_(fleet.path_clearance) {
  for (const koord::Function& f : model.functions) known_.push_back(Recognise(f));
}

Functions::Handler Functions::Recognise(const koord::Function& f) const {
  if (!f.external() || !f.declared) return nullptr;
  for (const Entry& entry : kFunctions) {
    const bool named = f.port >= 0 ? entry.name.empty() : entry.name == f.name;
    if (!named || f.parameters.size() != entry.parameters.size() || !Fits(model_, f.result, entry.result))
      continue;
    bool fits = true;
    for (size_t i = 0; i < f.parameters.size(); ++i)
      fits = fits && Fits(model_, f.parameters[i], entry.parameters[i]);
    if (fits) return entry.handler;
  }
  return nullptr;
}

void Functions::Attach(koord::semantics::Team& team, const std::vector<std::unique_ptr<Body>>& bodies) {
  team_ = &team;
  bodies_ = &bodies;
  // A program that has a parameter for it says how far a clear path must be.
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const koord::Variable& variable = model_.variables[v];
    if (variable.kind == koord::VariableKind::kParam && variable.name == "rho" &&
        model_.types.Is(variable.type, TypeKind::kFloat))
      path_clearance_ = ToFloat(team.machine().params()[team.layout()[v].at]);
  }
}

void Functions::Log(size_t robot, size_t type, std::span<const Word> value) {
  log_.emplace_back(robot, team_->ShowLogged(type, value));
}

koord::semantics::Answer Functions::Call(size_t f, size_t robot, std::span<const Word> a,
                                         std::span<Word> result) {
  if (team_ == nullptr || !Knows(f)) return koord::semantics::Answer::kNone;
  later_ = false;
  (this->*known_[f])(robot, a, result);
  return later_ ? koord::semantics::Answer::kLater : koord::semantics::Answer::kValue;
}

}  // namespace rondo::sim
