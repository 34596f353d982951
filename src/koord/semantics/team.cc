#include "koord/semantics/team.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "koord/check/spec_labels.h"
#include "koord/semantics/machine/values.h"

namespace rondo::koord::semantics {

using diag::Kind;
using lang::TypeKind;

std::unique_ptr<Team> Team::Make(const Model& model, const TeamOptions& options,
                                 diag::Diagnostics& diagnostics, Heap heap) {
  std::unique_ptr<Team> team(new Team(model, std::move(heap)));
  if (!team->Parameters(options, diagnostics) || !team->Compile(options, diagnostics)) return nullptr;
  return team;
}

// `param int a[4] = 0`: lengths are not known yet, unless they are numbers.
std::optional<std::vector<Word>> Team::Filled(
    const Variable& variable, const std::function<std::optional<std::vector<Word>>(ExprId, TypeId)>& evaluate,
    diag::Diagnostics& diagnostics) {
  std::vector<size_t> dimensions;
  TypeId type = variable.type;
  size_t items = 1;
  for (; model_.types.Is(type, TypeKind::kArray); type = model_.types[type].parts[0]) {
    const std::string& text = model_.types[type].length;
    size_t length = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), length);
    items =
        problem != std::errc() || end != text.data() + text.size() || length > 1'000'000 ? 0 : items * length;
    if (items == 0 || items > 1'000'000) {
      diagnostics.Report(Kind::kKoordNotExecutable, variable.span,
                         fmt::format("how many items `{}` has is not known yet", variable.name));
      return std::nullopt;
    }
    dimensions.push_back(length);
  }
  auto value = evaluate(variable.initial, type);
  for (size_t d = dimensions.size(); value && d-- > 0;) {
    std::vector<Word> all;
    for (size_t i = 0; i < dimensions[d]; ++i) all.insert(all.end(), value->begin(), value->end());
    value = std::vector<Word>{heap_.Intern(all)};
  }
  return value;
}

// Parameters, in the order of their declaration, and the lengths of arrays.
bool Team::Parameters(const TeamOptions& options, diag::Diagnostics& diagnostics) {
  // Without lengths: nothing but parameters is looked at.
  const Layout flat(model_, options.robots, {});
  params_.assign(flat.param_words(), 0);
  const size_t before = diagnostics.errors();
  const auto evaluate = [&](ExprId e, TypeId type) -> std::optional<std::vector<Word>> {
    Code code;
    Compiler compiler(model_, flat, heap_, code);
    const uint32_t entry = compiler.Expression(e, type);
    const auto bad = compiler.TakeUnsupported();
    if (bad) {
      diagnostics.Report(Kind::kKoordNotExecutable, bad->span, bad->reason);
      return std::nullopt;
    }
    Machine machine(code, flat, heap_);
    machine.params() = params_;
    machine.marks().resize(compiler.branches().size());
    std::vector<Word> nothing(flat.words());
    machine.SetMemory(nothing.data());
    if (!compiler.externals().empty()) {
      diagnostics.Report(Kind::kKoordNotExecutable, model_.program->exprs[e].span,
                         "this value needs a function that has no body");
      return std::nullopt;
    }
    if (!machine.Run(entry, 0, false)) {
      diagnostics.Report(Kind::kKoordFault, machine.fault_span(), std::string(Describe(machine.fault())));
      return std::nullopt;
    }
    return std::vector<Word>(machine.result().begin(), machine.result().end());
  };
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind != VariableKind::kParam) continue;
    std::optional<std::vector<Word>> value;
    const auto fixed = options.params.find(v);
    const auto explored = model_.exploration.values.find(v);
    if (fixed != options.params.end()) {
      value = fixed->second;
    } else if (variable.initial.valid() && model_.filled.contains(v)) {
      value = Filled(variable, evaluate, diagnostics);
    } else if (variable.initial.valid()) {
      value = evaluate(variable.initial, variable.type);
    } else if (explored != model_.exploration.values.end()) {
      value = evaluate(explored->second, variable.type);
    } else {
      diagnostics
          .Report(Kind::kKoordNotExecutable, variable.span,
                  fmt::format("parameter `{}` has no value", variable.name))
          .Help(fmt::format("give it one: `explore:` and, in the block below, `{} = ...`", variable.name));
    }
    if (value) std::copy(value->begin(), value->end(), params_.begin() + flat[v].at);
  }
  constexpr int64_t kLongest = 100'000;
  constexpr uint64_t kMostItems = 1'000'000;
  for (const auto& [text, e] : model_.lengths) {
    if (diagnostics.errors() != before) break;
    const auto length = evaluate(e, model_.types.integer());
    if (length && ToInt((*length)[0]) >= 1 && ToInt((*length)[0]) <= kLongest)
      lengths_[text] = static_cast<uint32_t>((*length)[0]);
  }
  lengths_[kRobotsLength] = static_cast<uint32_t>(options.robots);
  for (size_t v = 0; v < model_.variables.size() && diagnostics.errors() == before; ++v) {
    const Variable& variable = model_.variables[v];
    uint64_t items = 1;
    for (TypeId type = variable.type; model_.types.Is(type, TypeKind::kArray) && items <= kMostItems;
         type = model_.types[type].parts[0]) {
      const auto length = lengths_.find(model_.types[type].length);
      items = length == lengths_.end() ? kMostItems + 1 : items * length->second;
    }
    if (items > kMostItems)
      diagnostics.Report(Kind::kKoordNotExecutable, variable.span,
                         fmt::format("array `{}` has no length that can be executed", variable.name));
  }
  return diagnostics.errors() == before;
}

bool Team::Compile(const TeamOptions& options, diag::Diagnostics& diagnostics) {
  const size_t before = diagnostics.errors();
  layout_ = std::make_unique<Layout>(model_, options.robots, lengths_);
  robots_stop_ = RobotsStop(model_);
  Compiler compiler(model_, *layout_, heap_, code_);
  const auto refuse = [&] {
    if (const auto bad = compiler.TakeUnsupported())
      diagnostics.Report(Kind::kKoordNotExecutable, bad->span, "this cannot be executed").Under(bad->reason);
  };
  for (const InitDef* def : model_.inits) {
    inits_.push_back(compiler.Statements(def->body));
    refuse();
  }
  std::vector<bool> initialised;
  for (size_t v = 0; v < model_.variables.size(); ++v) initialised.push_back(compiler.assigned(v));
  for (const EventDef* def : model_.events) {
    EventCode event{def, 0, 0, def->urgent, false};
    if (def->pre.valid()) event.guard = compiler.Formula(def->pre);
    refuse();
    event.body = compiler.Statements(def->body);
    event.locks = compiler.locks();
    refuse();
    events_.push_back(event);
  }
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind == VariableKind::kParam) continue;
    has_sensors_ = has_sensors_ || (variable.kind == VariableKind::kSensor && variable.function < 0);
    if (variable.initial.valid())
      declared_.push_back({v, compiler.Initial(v, variable.initial), variable.initial});
    refuse();
    const auto choice = model_.exploration.choices.find(v);
    if (choice == model_.exploration.choices.end()) continue;
    const lang::Expr& list = model_.program->exprs[choice->second];
    choices_[v] = compiler.Expression(choice->second, model_.TypeOf(choice->second));
    if (list.kind == lang::ExprKind::kList && list.args.empty()) {
      diagnostics.Report(Kind::kKoordNotExecutable, list.span,
                         fmt::format("there is no value for `{}`", variable.name));
    }
    refuse();
  }
  for (const auto& [v, words] : options.choices) {
    if (!choices_.contains(v) && !model_.variables[v].initial.valid()) given_choices_[v] = words;
  }
  Specification(compiler);
  refuse();
  for (const size_t f : compiler.externals()) {
    if (options.hosted && options.hosted(f)) continue;
    const Function& function = model_.functions[f];
    diagnostics
        .Report(Kind::kKoordNotExecutable, function.span, fmt::format("`{}` has no body", function.name))
        .Help(fmt::format("give it one: `explore:` and, in the block below, `{}({}) = ...`", function.name,
                          fmt::join(function.parameter_names, ", ")));
  }
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    const auto has = [&](const std::vector<InitialCode>& list) {
      return std::any_of(list.begin(), list.end(), [&](const InitialCode& i) { return i.variable == v; });
    };
    if (variable.kind == VariableKind::kParam || variable.kind == VariableKind::kSensor ||
        !(*layout_)[v].exists)
      continue;
    if (!has(declared_) && !has(derived_) && !choices_.contains(v) && !given_choices_.contains(v) &&
        !initialised[v])
      zeroed_.push_back(v);
  }
  for (const auto& [s, why] : compiler.unchecked_summaries())
    unchecked_.push_back({SummaryName(*model_.summaries[s]), why.span, why.reason});
  branches_ = compiler.branches();  // those of fallbacks are no part of a round
  for (const FallbackDef* def : model_.fallbacks) {
    fallbacks_.push_back({&def->code, 0, compiler.Statements(def->code.body), false, false});
    refuse();
  }
  logged_ = compiler.logged();
  MakeBlank();
  heap_.Pin();
  machine_ = std::make_unique<Machine>(code_, *layout_, heap_);
  machine_->params() = params_;
  machine_->marks().resize(compiler.branches().size());
  machine_->SetShow([this](size_t type, std::span<const Word> value) { return ShowLogged(type, value); });
  return diagnostics.errors() == before;
}

// Zero, false, the first member, the empty list or text; of an array as many as it has.
std::vector<Word> Team::Default(TypeId type) {
  const lang::Type& t = model_.types[type];
  std::vector<Word> words;
  if (t.kind == TypeKind::kRecord || t.kind == TypeKind::kTuple) {
    for (const TypeId part : t.parts) {
      const std::vector<Word> more = Default(part);
      words.insert(words.end(), more.begin(), more.end());
    }
    return words;
  }
  const auto length = t.kind == TypeKind::kArray ? lengths_.find(t.length) : lengths_.end();
  if (length == lengths_.end()) return {0};
  const std::vector<Word> item = Default(t.parts[0]);
  for (uint32_t i = 0; i < length->second; ++i) words.insert(words.end(), item.begin(), item.end());
  return {heap_.Intern(words)};
}

void Team::MakeBlank() {
  blank_.assign(layout_->words(), 0);
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Layout::Place& place = (*layout_)[v];
    if (!place.exists || model_.variables[v].kind == VariableKind::kParam) continue;
    const std::vector<Word> item = Default(place.item);
    for (size_t r = 0; r < (place.own ? robots() : 1); ++r) {
      for (uint32_t at = 0; at < place.words(); at += place.width)
        std::copy(item.begin(), item.end(), blank_.begin() + layout_->Address(v, r) + at);
    }
  }
}

std::optional<FormulaCode> Team::CompileFormula(Compiler& compiler, std::string name, diag::Span span,
                                                ExprId e) {
  const uint32_t entry = compiler.Formula(e);
  const bool per_robot = compiler.used_robot();
  if (const auto bad = compiler.TakeUnsupported()) {
    unchecked_.push_back({std::move(name), bad->span, bad->reason});
    return std::nullopt;
  }
  return FormulaCode{std::move(name), span, entry, per_robot, false, e};
}

void Team::Specification(Compiler& compiler) {
  const auto add = [&](std::vector<FormulaCode>& list, std::string name, diag::Span span, ExprId e) {
    if (auto formula = CompileFormula(compiler, std::move(name), span, e))
      list.push_back(std::move(*formula));
  };
  for (size_t i = 0; i < model_.invariants.size(); ++i) {
    const size_t before = invariants_.size();
    add(invariants_, InvariantName(model_, i), model_.invariants[i]->span, model_.invariants[i]->body);
    if (invariants_.size() > before) invariants_.back().at_rounds = model_.invariants[i]->at_rounds;
  }
  for (const ResponseDef* def : model_.responses) {
    auto when = CompileFormula(compiler, def->name, def->span, def->when);
    auto then = when ? CompileFormula(compiler, def->name, def->span, def->then) : std::nullopt;
    if (then) responses_.push_back({def->name, def->span, std::move(*when), std::move(*then), def->rounds});
  }
  for (const AssumeDef* def : model_.assumptions) {
    const std::string name = AssumptionName(model_, *def);
    switch (def->kind) {
      case AssumeKind::kFact:
        add(facts_, name, def->span, def->body);
        break;
      case AssumeKind::kInitially:
        Derive(compiler, def->body);
        add(initially_, name, def->span, def->body);
        break;
      case AssumeKind::kPort: {
        if (HoldsAlways(model_, *def)) {
          add(port_facts_, name, def->span, def->body);
          break;
        }
        PromiseCode promise{name, def->span, 0, 0, def->at_end, def->when, def->body};
        if (def->when.valid()) promise.when = compiler.Formula(def->when);
        promise.always = compiler.Formula(def->body);
        if (const auto bad = compiler.TakeUnsupported())
          unchecked_.push_back({name, bad->span, bad->reason});
        else
          promises_.push_back(std::move(promise));
        break;
      }
    }
  }
}

// `v == e`, as a part of `assume initially`, gives v its value if nothing else does.
void Team::Derive(Compiler& compiler, ExprId id) {
  const lang::Expr& e = model_.program->exprs[id];
  if (e.kind != lang::ExprKind::kBinary) return;
  if (e.text == "and") {
    for (const ExprId arg : e.args) Derive(compiler, arg);
    return;
  }
  if (e.text != "==") return;
  for (size_t side = 0; side < 2; ++side) {
    const ExprId target = e.args[side];
    const Ref ref = model_.RefOf(target);
    const lang::Expr& t = model_.program->exprs[target];
    const bool cell =
        ref.kind == RefKind::kCell && model_.program->exprs[t.args[1]].kind == lang::ExprKind::kPid;
    if ((ref.kind != RefKind::kVariable && !cell) || t.kind == lang::ExprKind::kCall) continue;
    const Variable& variable = model_.variables[ref.index];
    const bool known = variable.initial.valid() || model_.exploration.choices.contains(ref.index) ||
                       std::any_of(derived_.begin(), derived_.end(),
                                   [&](const InitialCode& i) { return i.variable == ref.index; });
    if (known || variable.kind == VariableKind::kSensor || variable.kind == VariableKind::kParam) continue;
    if (variable.kind == VariableKind::kAllread && !cell) continue;
    const uint32_t entry = compiler.Initial(ref.index, e.args[1 - side]);
    if (compiler.TakeUnsupported() || (compiler.used_robot() && !variable.PerRobot())) continue;
    derived_.push_back({ref.index, entry, e.args[1 - side]});
    return;
  }
}

bool Team::LastWasDefined() const { return !machine_->used_default() && machine_->fault() == Fault::kNone; }

bool Team::Holds(const FormulaCode& formula, size_t* robot, bool* defined) {
  bool holds = true;
  for (size_t r = 0; r < (formula.per_robot ? robots() : 1); ++r) {
    const bool here = machine_->RunFormula(formula.entry, r);
    const bool known = LastWasDefined();
    if (defined != nullptr) *defined = *defined && known;
    if (here) continue;
    if (holds && robot != nullptr) *robot = r;
    holds = false;
    if (defined == nullptr || known) return false;
  }
  return holds;
}

std::string Team::ShowLogged(size_t type, std::span<const Word> value) const {
  if (type == kPlainText) return heap_.Text(value[0]);
  if (model_.types.Is(logged_[type], TypeKind::kString)) return heap_.Text(value[0]);
  return Show(model_.types, heap_, logged_[type], value);
}

std::string Team::ShowVariable(std::span<const Word> state, size_t v, size_t robot) const {
  const Layout::Place& place = (*layout_)[v];
  return Show(model_.types, heap_, place, state.subspan(layout_->Address(v, robot), place.words()));
}

std::string Team::NameOf(size_t v, size_t robot) const {
  const Variable& variable = model_.variables[v];
  if (!variable.PerRobot()) return variable.name;
  if (variable.module.empty()) return fmt::format("{}[{}]", variable.name, robot);
  return fmt::format("{}[{}]{}", variable.module, robot, variable.name.substr(variable.module.size()));
}

void Team::Collect(std::span<const std::span<const Word>> states) {
  for (const auto state : states) {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Layout::Place& place = (*layout_)[v];
      if (!place.exists || model_.variables[v].kind == VariableKind::kParam) continue;
      for (size_t r = 0; r < (place.own ? robots() : 1); ++r) {
        for (uint32_t i = 0; i < std::max<uint32_t>(1, place.length); ++i) {
          const size_t at = layout_->Address(v, r) + i * place.width;
          MarkHandles(model_.types, heap_, place.item, state.subspan(at, place.width));
        }
      }
    }
  }
  heap_.Sweep();
}

}  // namespace rondo::koord::semantics
