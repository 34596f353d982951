// Who may read and write what: each rule with what it allows and a small change that it forbids.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"

namespace rondo::koord {
namespace {

using diag::Kind;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kState =
    "def adt Task:\n    int id\n    int notes[2]\n"
    "using M:\n    sensors:\n        int at\n        List<int> seen\n    actuators:\n        int to\n        stream log\n"
    "allread:\n    int x[N_sys]\nallwrite:\n    int s\n    int cells[3]\n    List<int> jobs\n"
    "local:\n    int n\n    bool b\n    Task task\n    List<int> list\n    Motor motor\n";

class Access : public testing::Test {
 protected:
  std::vector<Kind> Reports(const std::string& text) {
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    Program program;
    Parse(sources, sources.Add("test.koord", text), program, diagnostics);
    Check(program, diagnostics);
    std::vector<Kind> kinds;
    for (const diag::Diagnostic& d : diagnostics.all()) kinds.push_back(d.kind);
    return kinds;
  }
  /// What is reported of a statement in an event.
  std::vector<Kind> Event(const std::string& statement) {
    return Reports(kState + std::string("E:\n    eff:\n        ") + statement + "\n");
  }
  std::vector<Kind> Atomic(const std::string& statement) {
    return Event("atomic:\n            " + statement);
  }
  std::vector<Kind> Init(const std::string& statement) {
    return Reports(kState + std::string("init:\n    ") + statement + "\nE:\n    eff:\n        n = 0\n");
  }
  /// Of a function whose parameters are `k` and `a`.
  std::vector<Kind> Function(const std::string& statement) {
    return Reports("def fun f(int k, int[3] a) -> int:\n    " + statement + "\n    return k\n" + kState +
                   "E:\n    eff:\n        n = f(n, cells)\n");
  }
};

TEST_F(Access, SensorsAreRead) {
  EXPECT_THAT(Event("n = M.at"), IsEmpty());
  EXPECT_THAT(Event("M.at = n"), ElementsAre(Kind::kKoordSensorWrite));
  EXPECT_THAT(Event("M.at++"), ElementsAre(Kind::kKoordSensorWrite));
  EXPECT_THAT(Event("M.seen.append(1)"), ElementsAre(Kind::kKoordSensorWrite));
}

TEST_F(Access, ActuatorsAreWritten) {
  EXPECT_THAT(Event("M.to = n"), IsEmpty());
  EXPECT_THAT(Event("n = M.to"), ElementsAre(Kind::kKoordActuatorRead));
  EXPECT_THAT(Event("M.to = M.to + 1"), ElementsAre(Kind::kKoordActuatorRead));
}

TEST_F(Access, ABarePortIsThatPort) {
  EXPECT_THAT(Event("to = at"), IsEmpty());
  EXPECT_THAT(Event("at = n"), ElementsAre(Kind::kKoordSensorWrite));
  EXPECT_THAT(Event("n = to"), ElementsAre(Kind::kKoordActuatorRead));
}

TEST_F(Access, EveryCellIsReadAndTheOwnOneIsWritten) {
  EXPECT_THAT(Event("x[pid] = x[n]"), IsEmpty());
  EXPECT_THAT(Event("x[n] = x[pid]"), ElementsAre(Kind::kKoordAllreadOwnership));
  EXPECT_THAT(Event("x[0] = 1"), ElementsAre(Kind::kKoordAllreadOwnership));
  EXPECT_THAT(Event("x[pid + 0] = 1"), ElementsAre(Kind::kKoordAllreadOwnership));
}

TEST_F(Access, WhatAllWriteIsWrittenUnderALock) {
  for (const char* statement : {"s = 1", "cells[0] = 1", "jobs.append(1)", "jobs.remove(1)", "s += 1"}) {
    EXPECT_THAT(Atomic(statement), IsEmpty()) << statement;
    EXPECT_THAT(Event(statement), ElementsAre(Kind::kKoordLostUpdate)) << statement;
  }
}

TEST_F(Access, InitNeedsNoLock) {
  EXPECT_THAT(Init("s = 1"), IsEmpty());
  EXPECT_THAT(Init("atomic:\n        s = 1"), ElementsAre(Kind::kKoordMisplacedStatement));
}

TEST_F(Access, TheLockEndsWithItsBlock) {
  EXPECT_THAT(Event("atomic:\n            s = 1\n        n = 1"), IsEmpty());
  EXPECT_THAT(Event("atomic:\n            n = 1\n        s = 1"), ElementsAre(Kind::kKoordLostUpdate));
}

TEST_F(Access, LocalsAndTheirPartsAreWritten) {
  for (const char* statement :
       {"n = 1", "n++", "task.id = 1", "task.notes[1] = 2", "list.append(n)", "list[0] = 1"})
    EXPECT_THAT(Event(statement), IsEmpty()) << statement;
}

TEST_F(Access, ParametersAndTheNumberOfRobotsAreFixed) {
  EXPECT_THAT(Reports("param int p\nlocal:\n    int n\nE:\n    eff:\n        n = p + N_sys\n"), IsEmpty());
  EXPECT_THAT(Reports("param int p\nlocal:\n    int n\nE:\n    eff:\n        p = n\n"),
              ElementsAre(Kind::kKoordNotAssignable));
  EXPECT_THAT(Event("N_sys = 3"), ElementsAre(Kind::kKoordNotAssignable));
}

TEST_F(Access, AVariableOfALoopIsFixed) {
  EXPECT_THAT(Event("for i = 0, 3:\n            n = i"), IsEmpty());
  EXPECT_THAT(Event("for i = 0, 3:\n            i = n"), ElementsAre(Kind::kKoordNotAssignable));
  EXPECT_THAT(Event("for i in list:\n            i = n"), ElementsAre(Kind::kKoordNotAssignable));
}

TEST_F(Access, NobodyWritesIntoAnOpaqueValue) {
  EXPECT_THAT(Event("n = motor.speed"), IsEmpty());
  EXPECT_THAT(Event("motor.speed = n"), ElementsAre(Kind::kKoordNotAssignable));
}

TEST_F(Access, AFunctionWritesItsParametersOnly) {
  EXPECT_THAT(Function("k = k + 1"), IsEmpty());
  EXPECT_THAT(Function("a[0] = 1"), IsEmpty());
  EXPECT_THAT(Function("n = k"), ElementsAre(Kind::kKoordNotAssignable));
  EXPECT_THAT(Function("s = k"), ElementsAre(Kind::kKoordNotAssignable));
  EXPECT_THAT(Function("x[pid] = k"), ElementsAre(Kind::kKoordNotAssignable));
}

TEST_F(Access, AFunctionReadsSensorsButNoActuators) {
  EXPECT_THAT(Function("k = M.at + n + s"), IsEmpty());
  EXPECT_THAT(Function("k = M.to"), ElementsAre(Kind::kKoordActuatorRead));
}

TEST_F(Access, AStreamTakesValuesOnly) {
  EXPECT_THAT(Event("M.log << \"n = \" << n"), IsEmpty());
  EXPECT_THAT(Event("n << 1"), ElementsAre(Kind::kKoordStreamMisuse));
}

TEST_F(Access, PortsOfOtherRobotsAreForSpecifications) {
  EXPECT_THAT(Event("n = M[0].at"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Event("n = M.at\ninvariant: M[0].at > 0 and n[0] > 0 and M[0].to > M.to"), IsEmpty());
}

TEST_F(Access, ChoicesAreMadeWhileAnEventRuns) {
  EXPECT_THAT(Event("n = any int in 0..3"), IsEmpty());
  EXPECT_THAT(Init("n = any q in [1, 2]"), IsEmpty());
  EXPECT_THAT(Function("k = any int in 0..3"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Event("b = exists i in ID: i == any int in 0..3"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Event("list[any int in 0..3] = 1"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Reports("E:\n    pre: any int in 0..1 == 0\n    eff:\n        stop\n"),
              ElementsAre(Kind::kKoordSpecScope));
}

TEST_F(Access, ProgramsRangeOverRobotsAndLists) {
  EXPECT_THAT(Event("b = forall i in ID: x[i] > 0"), IsEmpty());
  EXPECT_THAT(Event("b = exists i in list: i > 0"), IsEmpty());
  EXPECT_THAT(Event("b = exists i in int: i > n"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Event("n = 0\ninvariant: exists i in int: i > n"), IsEmpty());
}

TEST_F(Access, BreakAndContinueNeedALoop) {
  for (const std::string word : {"break", "continue"}) {
    EXPECT_THAT(Event("for i = 0, 3:\n            " + word), IsEmpty());
    EXPECT_THAT(Event(word), ElementsAre(Kind::kKoordMisplacedStatement));
    EXPECT_THAT(Event("for i = 0, 3:\n            n = i\n        " + word),
                ElementsAre(Kind::kKoordMisplacedStatement));
  }
}

TEST_F(Access, OnlyFunctionsReturnValues) {
  EXPECT_THAT(Event("return"), IsEmpty());
  EXPECT_THAT(Event("return 1"), ElementsAre(Kind::kKoordMisplacedStatement));
  EXPECT_THAT(Function("if k > 0:\n        return 1"), IsEmpty());
}

TEST_F(Access, OnlyEventsStopTheRobot) {
  EXPECT_THAT(Event("stop"), IsEmpty());
  EXPECT_THAT(Function("if k > 0:\n        stop"), ElementsAre(Kind::kKoordMisplacedStatement));
}

TEST_F(Access, NothingRunsBehindTheEndOfABlock) {
  for (const std::string word : {"stop", "return"}) {
    EXPECT_THAT(Event("n = 1\n        " + word), IsEmpty());
    EXPECT_THAT(Event(word + "\n        n = 1"), ElementsAre(Kind::kKoordUnreachable));
    EXPECT_THAT(Event("if b:\n            " + word + "\n        n = 1"), IsEmpty());
  }
}

TEST_F(Access, AFunctionDoesNotCallItself) {
  const auto program = [](const std::string& f, const std::string& g) {
    return "def fun f(int k) -> int:\n    return " + f + "\ndef fun g(int k) -> int:\n    return " + g +
           "\nlocal:\n    int n\nE:\n    eff:\n        n = f(n)\n";
  };
  EXPECT_THAT(Reports(program("g(k)", "k")), IsEmpty());
  EXPECT_THAT(Reports(program("f(k)", "k")), ElementsAre(Kind::kKoordRecursion));
  EXPECT_THAT(Reports(program("g(k)", "f(k)")), ElementsAre(Kind::kKoordRecursion, Kind::kKoordRecursion));
}

}  // namespace
}  // namespace rondo::koord
