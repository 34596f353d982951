#pragma once

#include <string>
#include <vector>

#include "koord/check/model.h"

/// Finds what a program itself says about its robots: the predicates that helper invariants are made of.
namespace rondo::runs {

/// Holds a formula that is true or false of a robot, as the specification writes it: of the robot `i`, and of `j`.
struct Literal {
  std::string of_i, of_j;
};

/// Returns the atoms of invariants, of `assume initially`, guards and conditions, and what assignments make true
/// (`target == value`, of numbers also `<=` and `>=`), each once, in this order and at most so many. Leaves out what depends on block variables,
/// choices or callable ports.
std::vector<Literal> LiteralsOf(const koord::Model& model, size_t most);

}  // namespace rondo::runs
