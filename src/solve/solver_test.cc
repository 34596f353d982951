#include "solve/solver.h"

#include <gtest/gtest.h>

#include <sstream>

namespace rondo::solve {
namespace {

class Queries : public testing::Test {
 protected:
  expr::Arena arena_;
  const expr::TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  const expr::TermId zero_ = arena_.Number(arena_.Real(), expr::Rational(0));
  const Query query_{&arena_, {{arena_.Lt(x_, zero_), "low"}, {arena_.Le(zero_, x_), "high"}}, {}};
};

TEST_F(Queries, FormulasComeWithoutGroupsInOrder) {
  EXPECT_EQ(Formulas(query_.assertions),
            (std::vector<expr::TermId>{arena_.Lt(x_, zero_), arena_.Le(zero_, x_)}));
}

TEST_F(Queries, ScriptsHaveEachAssertionOnce) {
  std::istringstream lines(ToSmtLib(query_));
  int assertions = 0, checks = 0;
  for (std::string line; std::getline(lines, line);) {
    assertions += line.starts_with("(assert") ? 1 : 0;
    checks += line == "(check-sat)" ? 1 : 0;
  }
  EXPECT_EQ(assertions, 2);
  EXPECT_EQ(checks, 1);
}

TEST_F(Queries, GroupsAreComments) {
  std::istringstream lines(ToSmtLib(query_));
  for (std::string line; std::getline(lines, line);) {
    const bool group = line.find("low") != std::string::npos || line.find("high") != std::string::npos;
    EXPECT_TRUE(!group || line.starts_with(";")) << line;
  }
  EXPECT_NE(ToSmtLib(query_).find("low"), std::string::npos);
}

TEST_F(Queries, FunctionsAreSpelledOutOrNamed) {
  const expr::TermId size = arena_.Apply(expr::Elementary::kAbs, {x_});
  const Query query{&arena_, {{arena_.Lt(size, arena_.Number(arena_.Real(), expr::Rational(2))), ""}}, {}};
  EXPECT_EQ(ToSmtLib(query).find("(abs "), std::string::npos);
  EXPECT_NE(ToSmtLib(query, expr::SmtFunctions::kNamed).find("(abs "), std::string::npos);
}

}  // namespace
}  // namespace rondo::solve
