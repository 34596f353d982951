#pragma once

#include <gtest/gtest.h>

#include <unordered_map>

#include "solve/icp/prepare/prepare.h"

namespace rondo::solve::icp {

/// Variables, numbers and functions of reals, for questions that nothing has prepared.
class RealVariables : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name, icp::Variable::Kind kind = icp::Variable::Kind::kReal) {
    const TermId v = arena_.Variable(arena_.Declare(name, {}, arena_.Real()));
    variables_.emplace(v, icp::Variable{v, kind});
    return v;
  }
  TermId Call(expr::Elementary f, TermId a) { return arena_.Apply(f, {a}); }

  expr::Arena arena_;
  std::unordered_map<TermId, icp::Variable> variables_;
};

}  // namespace rondo::solve::icp
