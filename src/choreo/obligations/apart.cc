#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "choreo/obligations/statements.h"
#include "robot/separation/support.h"
#include "solve/icp/icp_solver.h"

namespace rondo::choreo {

using expr::Rational;
using expr::TermId;

namespace {

constexpr size_t kFew = 4;        // members that are compared pair by pair
constexpr double kMargin = 1e-4;  // metres
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

struct Slab {
  double low = -kInfinity, high = kInfinity;
  bool Meets(const Slab& other) const { return low <= other.high && other.low <= high; }
};

class Apartness {
 public:
  Apartness(Statements& s, ObligationKind kind, diag::Span span, const std::vector<Member>& members,
            const std::vector<TermId>& known)
      : s_(s), arena_(s.arena()), kind_(kind), span_(span), members_(members), known_(known) {}

  void Run() {
    std::vector<Slab> slabs(members_.size());
    if (members_.size() > kFew) {
      const size_t axis = BestAxis(slabs);
      for (size_t i = 0; i < members_.size(); ++i) Within(members_[i], axis, slabs[i]);
    }
    for (size_t i = 0; i < members_.size(); ++i) {
      for (size_t j = i + 1; j < members_.size(); ++j) {
        if (slabs[i].Meets(slabs[j])) Pair(members_[i], members_[j]);
      }
    }
  }

 private:
  // The slabs along the axis in which the fewest of them meet.
  size_t BestAxis(std::vector<Slab>& best) {
    size_t axis = 0, fewest = std::numeric_limits<size_t>::max();
    for (size_t a = 0; a < kAxes.size(); ++a) {
      std::vector<Slab> slabs;
      for (const Member& m : members_) slabs.push_back(SlabOf(m, a));
      size_t pairs = 0;
      for (size_t i = 0; i < slabs.size(); ++i) {
        for (size_t j = i + 1; j < slabs.size(); ++j) pairs += slabs[i].Meets(slabs[j]) ? 1 : 0;
      }
      if (pairs >= fewest) continue;
      fewest = pairs;
      axis = a;
      best = std::move(slabs);
      if (pairs == 0) break;
    }
    return axis;
  }

  // Bounds that nothing of the member leaves, by contraction.
  Slab SlabOf(const Member& member, size_t axis) {
    const TermId p = s_.graph().world->point[axis];
    if (member.shape == nullptr) return Enclose(member.region, p);
    robot::Meeting alone{arena_.True(), {*member.shape}, arena_.True(), {}};
    const auto pieces = robot::PiecesOf(arena_, s_.graph().world->point, alone, 200);
    if (!pieces || pieces->empty()) return {};
    Slab all{kInfinity, -kInfinity};
    for (const robot::Piece& piece : *pieces) {
      const auto solid =
          std::ranges::find_if(piece, [](const robot::Set& t) { return t.kind == robot::SetKind::kSolid; });
      if (solid == piece.end()) return {};
      std::array<Rational, 3> d{0, 0, 0};
      d[axis] = 1;
      const robot::Direction up = robot::DirectionIn(arena_, robot::Identity(arena_), d);
      all.high = std::max(all.high, Enclose(arena_.Eq(p, robot::Support(arena_, *solid, up)), p).high);
      const TermId down = robot::Support(arena_, *solid, robot::Opposite(arena_, up));
      all.low = std::min(all.low, Enclose(arena_.Eq(p, arena_.Neg(down)), p).low);
    }
    return all;
  }

  Slab Enclose(TermId formula, TermId p) {
    std::vector<TermId> others = known_;
    solve::Query query;
    query.arena = &arena_;
    query.assertions = {{arena_.And(s_.Related({formula}, others), formula), ""}};
    const auto box = solve::icp::IcpSolver().Enclose(query);
    if (!box) return {};  // nothing to say of what may never be
    const auto it = box->find(p);
    if (it == box->end()) return {};
    // Not to the last digit, where proofs are hard.
    return Slab{it->second.first - kMargin, it->second.second + kMargin};
  }

  // The member lies within its slab.
  void Within(const Member& member, size_t axis, const Slab& slab) {
    const TermId p = s_.graph().world->point[axis];
    std::vector<TermId> beyond;
    if (slab.low > -kInfinity) beyond.push_back(arena_.Lt(p, s_.Number(Rational::FromDouble(slab.low))));
    if (slab.high < kInfinity) beyond.push_back(arena_.Lt(s_.Number(Rational::FromDouble(slab.high)), p));
    const std::string where =
        fmt::format("{} where {:.4g} m <= {} <= {:.4g} m", member.name, slab.low, kAxes[axis], slab.high);
    State(member, nullptr, arena_.Or(beyond), {where, member.name + " may be elsewhere"});
  }

  void Pair(const Member& a, const Member& b) {
    const std::string both = fmt::format("{} and {}", a.name, b.name);
    const bool regions = a.shape == nullptr;
    State(a, &b, arena_.True(),
          {both + (regions ? " are disjoint" : " are apart"), both + (regions ? " overlap" : " may touch")});
  }

  // No point is in both, or in one of them where it must not be.
  void State(const Member& a, const Member* b, TermId where, const Claim& claim) {
    s_.instances = a.instances;
    if (b != nullptr) s_.instances.insert(s_.instances.end(), b->instances.begin(), b->instances.end());
    if (a.shape != nullptr) {
      robot::Meeting meeting{arena_.And(known_), {*a.shape}, where, {}};
      if (b != nullptr) meeting.shapes.push_back(*b->shape);
      return s_.Apart(kind_, span_, claim, std::move(meeting));
    }
    std::vector<TermId> formulas = known_;
    formulas.push_back(arena_.And({a.region, where, b != nullptr ? b->region : arena_.True()}));
    s_.Unsat(kind_, span_, claim, formulas);
  }

  Statements& s_;
  expr::Arena& arena_;
  ObligationKind kind_;
  diag::Span span_;
  const std::vector<Member>& members_;
  const std::vector<TermId>& known_;
};

}  // namespace

void StateApart(Statements& statements, ObligationKind kind, diag::Span span,
                const std::vector<Member>& members, const std::vector<TermId>& known) {
  Apartness(statements, kind, span, members, known).Run();
}

}  // namespace rondo::choreo
