#pragma once

#include <vector>

#include "choreo/graph/graph.h"

/// Ways from the start of a choreography to one of its nodes.
namespace rondo::choreo {

/// Is what is decided on the way: an alternative that is taken, or another round of a loop.
struct Turn {
  diag::Span span;
  std::string what;  ///< for people: "alternative 2 of 3", "round 2"
};

/// Is one way to a node, as a choreography of its own in which nothing is left to choose: what is known at the node in
/// it is known on this way.
struct Route {
  Graph graph;
  NodeId target;  ///< the node, in that graph
  std::vector<Turn> turns;
  size_t rounds = 1;  ///< how often it comes to the place to which it comes most often
};

/// Holds ways to a node.
struct Routes {
  std::vector<Route> all;
  bool complete = true;  ///< whether there are no others that go through no loop more often
};

/// Returns the ways to a node that pass every place where ways meet at most `rounds` times, those with few decisions
/// first; no more than `most`. Threads that the node is not in, and that go on beside it, are left out.
Routes RoutesTo(const Graph& graph, NodeId node, size_t rounds, size_t most);

}  // namespace rondo::choreo
