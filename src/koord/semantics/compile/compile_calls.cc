#include <algorithm>

#include "base/check.h"
#include "koord/check/mentions_robot.h"
#include "koord/semantics/compile/compiler.h"

namespace rondo::koord::semantics {

using lang::TypeKind;

void Compiler::Call(ExprId id, const lang::Expr& e) {
  const Ref ref = model_.RefOf(id);
  if (ref.kind == RefKind::kFunction) return CallFunction(e, ref.index);
  CHECK(ref.kind == RefKind::kBuiltin);
  CallBuiltin(e, static_cast<Builtin>(ref.index), model_.TypeOf(id));
}

void Compiler::CallPlain(size_t f, uint32_t argument_words, uint32_t result_words) {
  const Function& function = model_.functions[f];
  const auto given = model_.exploration.functions.find(f);
  if (function.external() && given == model_.exploration.functions.end()) {
    if (std::find(externals_.begin(), externals_.end(), f) == externals_.end()) externals_.push_back(f);
    Emit(Op::kExternal, f, argument_words, result_words);
    return;
  }
  // The arguments go into the frame of the function, the last one first.
  const void* key = function.external() ? static_cast<const void*>(given->second) : function.def;
  const std::vector<uint32_t>& parameters = model_.bound_by.at(key);
  for (size_t i = parameters.size(); i-- > 0;)
    Emit(Op::kSetFrame, FrameOf(parameters[i]), Width(function.parameters[i]));
  Emit(Op::kCall, f);
  wanted_.push_back(f);
}

void Compiler::CallFunction(const lang::Expr& e, size_t f) {
  const Function& function = model_.functions[f];
  const uint32_t result = Width(function.result);
  uint32_t words = 0;
  for (size_t i = 0; i < function.parameters.size(); ++i) {
    GenAs(e.args[i + 1], function.parameters[i]);
    words += Width(function.parameters[i]);
  }
  span_ = e.span;
  if (function.port >= 0) used_robot_ = true;
  if (!function.external()) {
    used_robot_ = used_robot_ || RobotMentions(model_).In(function.def->body);
    return CallPlain(f, words, result);
  }
  std::vector<size_t> summaries;
  for (size_t s = 0; s < model_.summaries.size(); ++s) {
    const std::string& name = model_.summaries[s]->function;
    if (name == function.name || (function.port >= 0 && function.name.ends_with("." + name)))
      summaries.push_back(s);
  }
  if (in_summary_ || summaries.empty() || !model_.bound_by.contains(model_.summaries[summaries[0]]))
    return CallPlain(f, words, result);
  // Every call is checked against the summaries, except calls in summaries. The call itself is like any other: what fails in
  // it fails, and calls in it are checked. Its arguments wait in a frame of this place.
  const std::vector<uint32_t>& first = model_.bound_by.at(model_.summaries[summaries[0]]);
  std::vector<uint32_t> arguments;
  for (const TypeId parameter : function.parameters) arguments.push_back(NewFrame(Width(parameter)));
  for (size_t i = function.parameters.size(); i-- > 0;)
    Emit(Op::kSetFrame, arguments[i], Width(function.parameters[i]));
  for (size_t i = 0; i < function.parameters.size(); ++i)
    Emit(Op::kFrame, arguments[i], Width(function.parameters[i]));
  CallPlain(f, words, result);
  const uint32_t kept = NewFrame(result);
  Emit(Op::kSetFrame, kept, result);
  const size_t begin = Emit(Op::kSummaryBegin);
  for (size_t i = 0; i < function.parameters.size(); ++i) {
    Emit(Op::kFrame, arguments[i], Width(function.parameters[i]));
    Emit(Op::kSetFrame, FrameOf(first[i]), Width(function.parameters[i]));
  }
  Emit(Op::kFrame, kept, result);
  Emit(Op::kSetFrame, FrameOf(first.back()), result);
  for (const size_t s : summaries) {
    const std::vector<uint32_t>& bound = model_.bound_by.at(model_.summaries[s]);
    for (size_t i = 0; s != summaries[0] && i < bound.size(); ++i) {
      const uint32_t width = i + 1 == bound.size() ? result : Width(function.parameters[i]);
      Emit(Op::kFrame, FrameOf(first[i]), width);
      Emit(Op::kSetFrame, FrameOf(bound[i]), width);
    }
    const bool failed = unsupported_.has_value();
    const size_t start = Here();
    const diag::Span span = span_;
    in_summary_ = true;
    Gen(model_.summaries[s]->body);
    in_summary_ = false;
    span_ = span;
    if (!failed && unsupported_) {
      // This summary cannot be evaluated: it is not checked.
      unchecked_summaries_[s] = *unsupported_;
      unsupported_.reset();
      code_.instructions.resize(start);
      code_.spans.resize(start);
    } else {
      Emit(Op::kSummaryTest, s);
    }
  }
  Emit(Op::kSummaryEnd);
  Patch(begin);
  Emit(Op::kFrame, kept, result);
}

void Compiler::CallBuiltin(const lang::Expr& e, Builtin builtin, TypeId type) {
  const auto& types = model_.types;
  switch (builtin) {
    case Builtin::kPos:
      for (size_t i = 1; i < e.args.size(); ++i) GenAs(e.args[i], types.real());
      for (size_t i = e.args.size(); i < 4; ++i) Constant(FromFloat(0));
      return;
    case Builtin::kMid:
    case Builtin::kDist: {
      std::vector<ExprId> points(e.args.begin() + 1, e.args.end());
      if (points.size() == 1) points = exprs_[points[0]].args;
      if (types.Is(model_.TypeOf(points[0]), TypeKind::kRecord)) {
        for (const ExprId p : points) Gen(p);
        span_ = e.span;
        Emit(builtin == Builtin::kMid ? Op::kMidPos : Op::kDistPos);
        return;
      }
      for (const ExprId p : points) GenAs(p, types.real());
      span_ = e.span;
      if (builtin == Builtin::kDist) {
        Emit(Op::kSubFloat);
        Emit(Op::kAbsFloat);
        return;
      }
      Emit(Op::kAddFloat);
      Constant(FromFloat(2));
      Emit(Op::kDivFloat);
      return;
    }
    case Builtin::kLen: {
      Gen(e.args[1]);
      const lang::Type& list = types[model_.TypeOf(e.args[1])];
      Emit(Op::kListLength, list.parts.empty() ? 1 : Width(list.parts[0]));
      return;
    }
    case Builtin::kAbs:
      Gen(e.args[1]);
      Emit(types.Is(model_.TypeOf(e.args[1]), TypeKind::kInt) ? Op::kAbsInt : Op::kAbsFloat);
      Convert(model_.TypeOf(e.args[1]), type);
      return;
    case Builtin::kMin:
    case Builtin::kMax: {
      const bool ints = types.Is(type, TypeKind::kInt);
      const bool min = builtin == Builtin::kMin;
      for (size_t i = 1; i < e.args.size(); ++i) {
        GenAs(e.args[i], type);
        if (i > 1) Emit(ints ? (min ? Op::kMinInt : Op::kMaxInt) : (min ? Op::kMinFloat : Op::kMaxFloat));
      }
      return;
    }
    case Builtin::kRecord:
      for (size_t i = 1; i < e.args.size(); ++i) GenAs(e.args[i], types[type].parts[i - 1]);
      return;
    case Builtin::kSqrt:
      GenAs(e.args[1], types.real());
      span_ = e.span;
      Emit(Op::kSqrtFloat);
      return;
    case Builtin::kHypot:
      for (size_t i = 1; i < 3; ++i) GenAs(e.args[i], types.real());
      span_ = e.span;
      Emit(Op::kHypotFloat);
      return;
    case Builtin::kFloor:
    case Builtin::kCeil:
    case Builtin::kRound:
    case Builtin::kSign:
      if (types.Is(model_.TypeOf(e.args[1]), TypeKind::kInt) && builtin != Builtin::kSign)
        return Gen(e.args[1]);
      GenAs(e.args[1], types.real());
      span_ = e.span;
      Emit(builtin == Builtin::kFloor   ? Op::kFloorFloat
           : builtin == Builtin::kCeil  ? Op::kCeilFloat
           : builtin == Builtin::kRound ? Op::kRoundFloat
                                        : Op::kSignFloat);
      return;
    case Builtin::kOld:
      Emit(Op::kOld);
      Gen(e.args[1]);
      Emit(Op::kNow);
      return;
    case Builtin::kGrid: {
      const TypeId element = types[type].parts[0];
      const bool ints = types.Is(element, TypeKind::kInt);
      GenAs(e.args[1], element);
      GenAs(e.args[2], element);
      GenAs(e.args[3], ints ? element : types.real());
      span_ = e.span;
      Emit(ints ? Op::kGridInt : types.Is(element, TypeKind::kFloat) ? Op::kGridFloat : Op::kGridPos);
      return;
    }
    case Builtin::kRect:
    case Builtin::kContains: {
      const ExprId list = exprs_[e.args[0]].args[0];
      Gen(list);
      GenAs(e.args[1], types[model_.TypeOf(list)].parts[0]);
      Emit(Op::kListContains, Width(types[model_.TypeOf(list)].parts[0]));
      return;
    }
    case Builtin::kFront: {
      const ExprId list = exprs_[e.args[0]].args[0];
      Gen(list);
      Constant(0);
      span_ = e.span;
      Emit(Op::kListAt, Width(types[model_.TypeOf(list)].parts[0]));
      return;
    }
    case Builtin::kSlice:
      for (size_t i = 1; i < e.args.size(); ++i) Gen(e.args[i]);
      span_ = e.span;
      Emit(Op::kListSlice, Width(types[model_.TypeOf(e.args[1])].parts[0]), e.args.size() > 3 ? 0 : 1);
      return;
    case Builtin::kRemove:
    case Builtin::kInsert:
    case Builtin::kPop:
    case Builtin::kClear:
    case Builtin::kAppend:
      break;  // not values
  }
  CHECK(false) << "a builtin that is no value got past the checker";
}

}  // namespace rondo::koord::semantics
