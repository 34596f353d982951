// Invariants and pavings: what proves one contract must not prove another one that is false.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "base/file.h"
#include "contracts/decide.h"
#include "contracts/file_contracts_test.h"
#include "contracts/tube_certificate.h"

namespace rondo::contracts {
namespace {

using reach::certify::Certificate;

const std::string kHeater = R"(robot P {
  param heat = 5
  param wild = 0
  state t: number in [0, 100]
  input leak: number in [-0.1, 0.1]
  input u: number
  memory on: number in [0, 0]
  dynamics { t' = (select(on == 1, heat, 0) + u + wild - 0.1 * (t - 10) + leak) / 1 s }
  motion Keep(low: number in [18, 19], high: number in [21, 22]) noninterruptible [60 s, 60 s] {
    modifies t
    pre t >= 19.5 and t <= 20
    during t >= 17.9 and t <= 22.1
    control { u = 0 when on == 0 and t <= low { on = 1 } when on == 1 and t >= high { on = 0 } }
  }
  motion Tight(low: number in [18, 19], high: number in [21, 22]) noninterruptible [60 s, 60 s] {
    modifies t
    pre t >= 19.5 and t <= 20
    during t >= 18.1 and t <= 22.1
    control { u = 0 when on == 0 and t <= low { on = 1 } when on == 1 and t >= high { on = 0 } }
  }
  motion Late(low: number in [18, 19], high: number in [21, 22]) noninterruptible [60 s, 60 s] {
    modifies t
    pre t >= 19.5 and t <= 20
    during t >= 17.9 and t <= 22.1
    control { u = 0 when on == 0 and t <= low { on = 1 } when on == 1 and t >= high + 1 { on = 0 } }
  }
  motion Wide(low: number in [18, 19], high: number in [21, 22]) noninterruptible [60 s, 60 s] {
    modifies t
    pre t >= 17 and t <= 20
    during t >= 17.9 and t <= 22.1
    control { u = 0 when on == 0 and t <= low { on = 1 } when on == 1 and t >= high { on = 0 } }
  }
  motion Chatter() noninterruptible [1 s, 1 s] {
    modifies t
    pre t >= 19.5 and t <= 20
    during t >= 17.9
    control { u = 0 when on == 0 and t <= 19 { on = 1 } when on == 1 and t >= 19 { on = 0 } }
  }
  motion Look() noninterruptible [10 s, 10 s] {
    modifies t
    pre t >= 19.5 and t <= 20.5
    during t >= 19.2 and t <= 20.8
    post t >= 19.3 and t <= 20.7
    control every 0.2 s { u = select(t < 20, 3, 0) }
  }
  motion LookAt() noninterruptible [10 s, 10 s] {
    modifies t
    pre t == 20.1
    during t >= 19.2 and t <= 20.8
    control every 0.2 s { u = select(t < 20, 3, 0) }
  }
  motion LookTight() noninterruptible [10 s, 10 s] {
    modifies t
    pre t >= 19.5 and t <= 20.5
    during t >= 19.2 and t <= 20.8
    post t >= 19.95 and t <= 20.7
    control every 0.2 s { u = select(t < 20, 3, 0) }
  }
  motion LookSeldom() noninterruptible [10 s, 10 s] {
    modifies t
    pre t >= 19.5 and t <= 20.5
    during t >= 19.2 and t <= 20.8
    post t >= 19.3 and t <= 20.7
    control every 1 s { u = select(t < 20, 3, 0) }
  }
  motion LookFrom() noninterruptible [10 s, 10 s] {
    modifies t
    pre t >= 19.1 and t <= 20.5
    during t >= 19.2 and t <= 20.8
    post t >= 19.3 and t <= 20.7
    control every 0.2 s { u = select(t < 20, 3, 0) }
  }
}
)";

class WithoutTubes : public FileContracts {
 protected:
  WithoutTubes() : FileContracts(kHeater) {}
  Certificate ProofOf(const std::string& motion) {
    const auto* proved = std::get_if<reach::Proved>(&*Decided(motion).outcome);
    EXPECT_NE(proved, nullptr) << motion;
    if (proved == nullptr) return {};
    EXPECT_TRUE(proved->IsWithoutTube()) << motion;
    return CertificateOf(*proved);
  }
  bool Accepts(const std::string& motion, const Certificate& certificate) {
    ContractResult& result = Find(motion);
    CertifyContract(result, certificate, 1, base::StopToken());
    EXPECT_EQ(result.IsCertified(), result.certified->reason.empty());
    return result.IsCertified();
  }
};

const std::string kLevels = "(low, high)";

TEST_F(WithoutTubes, AThermostatIsProvedByAnInvariant) {
  const Certificate proof = ProofOf("Keep" + kLevels);
  ASSERT_TRUE(proof.invariant);
  EXPECT_TRUE(proof.parts.empty());
  EXPECT_TRUE(Accepts("Keep" + kLevels, proof));
}

TEST_F(WithoutTubes, AnInvariantOfAnotherSystemIsRejected) {
  Certificate proof = ProofOf("Keep" + kLevels);
  for (const char* other : {"Tight", "Late", "Wide"}) EXPECT_FALSE(Accepts(other + kLevels, proof)) << other;
  EXPECT_FALSE(Accepts("Look()", proof));
  EXPECT_FALSE(Accepts("Keep" + kLevels, {{}, reach::Invariant{}}));
  for (reach::ModeInvariant& mode : *proof.invariant) mode.conjuncts.clear();
  EXPECT_FALSE(Accepts("Keep" + kLevels, proof));
}

TEST_F(WithoutTubes, WhatIsFalseIsNotProved) {
  for (const std::string& motion : {"Tight" + kLevels, "Late" + kLevels, "Wide" + kLevels})
    EXPECT_FALSE(std::holds_alternative<reach::Proved>(*Decided(motion).outcome)) << motion;
  for (const char* motion : {"LookTight()", "LookSeldom()", "LookFrom()"})
    EXPECT_FALSE(std::holds_alternative<reach::Proved>(*Decided(motion).outcome)) << motion;
}

// An invariant says nothing of events without end. (A tube does: all modes are possible at once.)
TEST_F(WithoutTubes, EventsWithoutEndHaveNoInvariant) {
  const auto& outcome = *Decided("Chatter()").outcome;
  const auto* proved = std::get_if<reach::Proved>(&outcome);
  EXPECT_TRUE(proved == nullptr || !proved->invariant);
}

// Whatever becomes of a proof, it never proves what is false.
TEST_F(WithoutTubes, ChangedInvariantsProveNothingFalse) {
  const Certificate proof = ProofOf("Keep" + kLevels);
  std::mt19937_64 random(3);
  for (int k = 0; k < 20; ++k) {
    Certificate changed = proof;
    for (size_t times = 1 + random() % 3; times > 0; --times) {
      auto& mode = (*changed.invariant)[random() % changed.invariant->size()];
      if (mode.conjuncts.empty()) continue;
      reach::Conjunct& conjunct = mode.conjuncts[random() % mode.conjuncts.size()];
      switch (random() % 5) {
        case 0:
          conjunct.bound += std::uniform_real_distribution<double>(-3, 3)(random);
          break;
        case 1:
          conjunct.negated = !conjunct.negated;
          break;
        case 2:
          conjunct.comparison = random() % 3;
          break;
        case 3:
          mode.conjuncts.erase(mode.conjuncts.begin() +
                               static_cast<ptrdiff_t>(random() % mode.conjuncts.size()));
          break;
        default:
          mode.conjuncts.push_back({.index = random() % 5,
                                    .negated = random() % 2 == 0,
                                    .bound = std::uniform_real_distribution<double>(-30, 30)(random)});
      }
    }
    for (const char* other : {"Tight", "Late", "Wide"}) EXPECT_FALSE(Accepts(other + kLevels, changed)) << k;
  }
}

TEST_F(WithoutTubes, AControllerThatSwitchesAtInstantsIsProvedByCells) {
  const Certificate proof = ProofOf("Look()");
  ASSERT_TRUE(proof.paving);
  EXPECT_TRUE(Accepts("Look()", proof));
}

// 20.1 is no double: it is enclosed by two of them, which say nothing of how fine a grid should be.
TEST_F(WithoutTubes, AStartThatIsRoundedIsNoWidth) {
  const Certificate proof = ProofOf("LookAt()");
  ASSERT_TRUE(proof.paving);
  EXPECT_LT(proof.paving->edges[0].size(), 1000u);
  EXPECT_TRUE(Accepts("LookAt()", proof));
}

TEST_F(WithoutTubes, APavingOfAnotherSystemIsRejected) {
  const Certificate proof = ProofOf("Look()");
  for (const char* other : {"LookTight()", "LookSeldom()", "LookFrom()"})
    EXPECT_FALSE(Accepts(other, proof)) << other;
  EXPECT_FALSE(Accepts("Keep" + kLevels, proof));
}

TEST_F(WithoutTubes, ChangedPavingsProveNothingFalse) {
  const Certificate proof = ProofOf("Look()");
  std::mt19937_64 random(4);
  for (int k = 0; k < 18; ++k) {
    Certificate changed = proof;
    reach::Paving& paving = *changed.paving;
    switch (random() % 6) {
      case 0:
        paving.cells.erase(paving.cells.begin() + static_cast<ptrdiff_t>(random() % paving.cells.size()));
        EXPECT_FALSE(Accepts("Look()", changed)) << k;  // no cell is there for nothing
        break;
      case 1:
        paving.edges[0][random() % paving.edges[0].size()] += 0.1;
        break;
      case 2:
        paving.cells[random() % paving.cells.size()][0] = static_cast<uint32_t>(random() % 300);
        break;
      case 3:
        paving.states[0] = random() % 5;
        break;
      case 4:
        paving.edges[0].erase(paving.edges[0].begin() +
                              static_cast<ptrdiff_t>(random() % paving.edges[0].size()));
        break;
      default:
        for (uint32_t cell = 0; cell + 1 < paving.edges[0].size(); ++cell) paving.cells.push_back({cell});
    }
    for (const char* other : {"LookTight()", "LookSeldom()", "LookFrom()"})
      EXPECT_FALSE(Accepts(other, changed)) << k << " " << other;
  }
}

TEST_F(WithoutTubes, TheirFilesSayAllOfThem) {
  for (const std::string& motion : {"Keep" + kLevels, std::string("Look()")}) {
    const Certificate proof = ProofOf(motion);
    const std::string path = folder_.Path("tube.json");
    ASSERT_TRUE(SaveTube(path, {{file_}, "", "P: " + motion, proof}).ok());
    const auto read = ReadTube(base::ReadFile(path).value());
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read.value().certificate.invariant.has_value(), proof.invariant.has_value());
    workspace::Session session;
    const auto answer = CheckTube(read.value(), session, base::StopToken());
    ASSERT_TRUE(answer.ok());
    EXPECT_TRUE(answer.value().accepted) << answer.value().reason;
  }
}

}  // namespace
}  // namespace rondo::contracts
