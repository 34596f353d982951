#include <fmt/format.h>

#include "choreo/obligations/statements.h"

namespace rondo::choreo {
namespace {

using expr::TermId;
using robot::Shape;

// The hull of a robot stands for its body.
void Hulls(Statements& s) {
  const TermId always = s.arena().True();
  for (const robot::Body& body : s.graph().world->bodies) {
    if (!body.body || !body.hull) continue;
    s.Apart(ObligationKind::kHull, body.type->name.span,
            {fmt::format("the hull of `{}`", body.name.text),
             fmt::format("the hull of `{}` does not contain its body", body.type->name.text)},
            {always, {*body.body}, always, *body.hull});
  }
}

void Exists(Statements& s, diag::Span span, const std::string& what, const Shape& shape) {
  s.Unsat(ObligationKind::kBody, span,
          {what + " has points, whatever the state is", what + " may have no points"},
          {robot::MayBeEmpty(s.arena(), shape)});
  s.Sat(span, {what + " has points", what + " has no points"},
        {robot::Contains(s.arena(), shape, s.graph().world->point)}, ObligationKind::kBody);
}

// A shape that has no value, or no points, would be in nobody's way.
void Solid(Statements& s) {
  for (const robot::Body& b : s.graph().world->bodies) {
    if (b.body) Exists(s, b.type->name.span, fmt::format("the body of `{}`", b.name.text), *b.body);
  }
  for (const robot::Obstacle& o : s.graph().world->obstacles)
    Exists(s, o.name.span, fmt::format("the obstacle `{}`", o.name.text), o.shape);
}

void ApartInitially(Statements& s) {
  const Graph& graph = s.graph();
  std::vector<Member> members;
  for (size_t i = 0; i < graph.robots.size(); ++i) {
    const Shape* body = BodyOf(s, RobotId(i));
    if (body == nullptr) continue;
    members.push_back({fmt::format("`{}`", graph.NameOf(RobotId(i))), body, {}, {}});
    for (const robot::Obstacle& o : graph.world->obstacles) {
      const std::string both =
          fmt::format("`{}` and the obstacle `{}`", graph.NameOf(RobotId(i)), o.name.text);
      s.Apart(ObligationKind::kInitial, graph.source->span,
              {both + " are apart initially", both + " may touch initially"},
              {graph.initially, {*body, o.shape}, s.arena().True(), {}});
    }
  }
  StateApart(s, ObligationKind::kInitial, graph.source->span, members, {graph.initially});
}

}  // namespace

const Shape* BodyOf(Statements& s, RobotId robot) {
  const robot::Body& body = s.graph().BodyOf(robot);
  if (!body.body) s.Lacks(body.type->name.span, fmt::format("the body of `{}`", body.type->name.text));
  return body.body ? &*body.body : nullptr;
}

void StateWhole(Statements& s) {
  Hulls(s);
  s.Sat(s.graph().source->span, State("in which it begins"), {s.graph().initially}, ObligationKind::kInitial);
  Solid(s);
  ApartInitially(s);
}

}  // namespace rondo::choreo
