#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "koord/check/check.h"
#include "koord/semantics/team.h"
#include "koord/syntax/parser.h"

namespace rondo::koord::node {

/// Holds a program that teams of any size can be compiled from.
class Compiled {
 public:
  explicit Compiled(const std::string& text) {
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    EXPECT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message << "\n" << text;
  }
  std::unique_ptr<semantics::Team> Team(size_t robots) {
    semantics::TeamOptions options;
    options.robots = robots;
    options.hosted = [](size_t) { return true; };  // whoever calls a function brings it
    return semantics::Team::Make(model_, options, diagnostics_);
  }

 private:
  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
};

}  // namespace rondo::koord::node
