// The interval solver on arms: points near the last link, said in polynomials that are multiplied out, with sums tied to frames in every
// search. A configuration that is planted is never excluded, and what is excluded has a certificate.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "formulas.h"
#include "lang/smtlib/script.h"
#include "solve/icp/icp_solver.h"

namespace rondo::solve::icp {
namespace {

using testing_support::CertificateProblem;
using testing_support::Say;

// Polynomials in texts, written for this test.
using Sum = std::map<std::multiset<std::string>, double>;

Sum Of(const std::string& atom) { return {{{atom}, 1.0}}; }
Sum Constant(double c) { return {{{}, c}}; }

Sum Plus(Sum a, const Sum& b, double times = 1) {
  for (const auto& [m, c] : b) a[m] += times * c;
  return a;
}

Sum Times(const Sum& a, const Sum& b) {
  Sum product;
  for (const auto& [m, c] : a) {
    for (const auto& [n, d] : b) {
      auto both = m;
      both.insert(n.begin(), n.end());
      product[both] += c * d;
    }
  }
  return product;
}

std::string Text(const Sum& sum) {
  std::string text = "(+ 0 0";
  for (const auto& [m, c] : sum) {
    text += fmt::format(" (* {:.6f}", c);
    for (const std::string& atom : m) text += " " + atom;
    text += ")";
  }
  return text + ")";
}

struct Scene {
  std::string script;
  bool planted;
};

// A planar arm of some joints, perhaps on a base that turns, and a box in which a point is: one of the arm, or one that is moved.
Scene Arm(uint64_t seed) {
  std::mt19937_64 rng(seed);
  const auto between = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(rng);
  };
  const size_t joints = 1 + rng() % 3;
  const bool base = rng() % 2 == 0, again = rng() % 4 == 0;
  std::vector<double> angles, lengths;
  for (size_t j = 0; j < joints; ++j) {
    angles.push_back(between(-2, 2));
    lengths.push_back(std::round(between(0.2, 1) * 100) / 100);
  }
  const double yaw = between(-3, 3), along = between(0, lengths.back()), off = between(-0.05, 0.05);
  // From the last frame back to the base: x along the link, z across.
  double x = along, z = off;
  for (size_t j = joints; j-- > 0;) {
    const double px = std::cos(angles[j]) * x - std::sin(angles[j]) * z;
    z = std::sin(angles[j]) * x + std::cos(angles[j]) * z;
    x = px + (j > 0 ? lengths[j - 1] : 0);
  }
  // A base that turns by its angle once, or twice.
  const double turn = again ? 2 * yaw : yaw;
  const double px = base ? std::cos(turn) * x : x, py = base ? std::sin(turn) * x : 0;

  Sum p = Of("x"), q = Of("z"), length;
  std::string script =
      "(declare-fun x () Real)(declare-fun y () Real)(declare-fun z () Real)(declare-fun w () Real)";
  Sum sideways = Constant(0);
  if (base) {
    script += "(assert (<= -3.2 w 3.2))";
    for (int k = 0; k < (again ? 2 : 1); ++k) {
      const Sum px_ = k == 0 ? Of("x") : p, py_ = k == 0 ? Of("y") : sideways;
      p = Plus(Times(px_, Of("(cos w)")), Times(py_, Of("(sin w)")));
      sideways = Plus(Times(py_, Of("(cos w)")), Times(px_, Of("(sin w)")), -1);
    }
  }
  // |v|^2, moved along with the frames.
  length = Plus(Plus(Times(Of("x"), Of("x")), Times(Of("z"), Of("z"))),
                base ? Times(Of("y"), Of("y")) : Constant(0));
  for (size_t j = 0; j < joints; ++j) {
    const std::string a = fmt::format("a{}", j);
    script += fmt::format("(declare-fun {0} () Real)(assert (<= -2.1 {0} 2.1))", a);
    const Sum c = Of("(cos " + a + ")"), s = Of("(sin " + a + ")");
    const Sum turned = Plus(Times(p, c), Times(q, s));
    q = Plus(Times(q, c), Times(p, s), -1);
    p = turned;
    if (j + 1 == joints) break;
    length = Plus(Plus(length, p, -2 * lengths[j]), Constant(lengths[j] * lengths[j]));
    p = Plus(p, Constant(-lengths[j]));
  }
  const Scene scene{"", rng() % 2 == 0};
  const double moved = scene.planted ? 0 : between(0.3, 2.5), w = between(0.01, 0.2);
  const auto in = [&](const char* name, double at) {
    script += fmt::format("(assert (<= {:.9f} {} {:.9f}))", at - w, name, at + w);
  };
  in("x", px + moved);
  in("y", py);
  in("z", z - moved / 2);
  script += fmt::format("(assert (<= -0.001 {} {:.6f}))", Text(p), lengths.back() + 0.001);
  script += fmt::format("(assert (<= {} 0.0036))", Text(Plus(length, Times(p, p), -1)));
  return {script, scene.planted};
}

TEST(Frames, ArmsReachWhatTheyReach) {
  int refuted = 0, planted = 0;
  const char* wanted = std::getenv("RONDO_CASES");
  const uint64_t cases =
      wanted == nullptr ? 150 : std::max<uint64_t>(150, std::strtoull(wanted, nullptr, 10) / 100);
  for (uint64_t seed = 0; seed < cases; ++seed) {
    const Scene scene = Arm(seed);
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    lang::smtlib::Script script;
    lang::smtlib::ReadScript(sources, sources.Add("arm", scene.script), script, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << scene.script;
    Query query{&script.arena, {}, {}};
    for (const auto& c : script.commands) {
      if (c.kind == lang::smtlib::Command::Kind::kAssert) query.assertions.push_back({c.terms[0], ""});
    }
    Options options;
    options.max_boxes = 3'000;
    options.boxes_before_links = 0;
    const Answer answer =
        IcpSolver(options).Check(query, {std::chrono::milliseconds(5'000), false, true}, {});
    planted += scene.planted ? 1 : 0;
    if (Say(answer) != "unsat") continue;
    ++refuted;
    ASSERT_FALSE(scene.planted) << "seed " << seed << "\n" << scene.script;
    ASSERT_EQ(CertificateProblem(answer), "") << "seed " << seed << "\n" << scene.script;
  }
  EXPECT_GT(planted, 50);
  EXPECT_GT(refuted, 12);
}

}  // namespace
}  // namespace rondo::solve::icp
