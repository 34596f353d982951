#pragma once

#include <fmt/format.h>

#include "lang/expr_parser.h"

/// Guards the recursion of the parser; only its sources include it.
namespace rondo::lang {

/// Counts how deep the recursion is; reports once where it is too deep.
class ExprParser::Depth {
 public:
  explicit Depth(ExprParser& parser) : parser_(parser) { ++parser_.depth_; }
  Depth(const Depth&) = delete;
  Depth& operator=(const Depth&) = delete;
  ~Depth() { --parser_.depth_; }
  bool TooDeep() {
    if (parser_.depth_ <= kDeepest) return false;
    if (!parser_.failed_) {
      parser_.diagnostics_
          .Report(diag::Kind::kSyntaxNesting, parser_.Peek().span, "this expression is nested too deeply")
          .Under(fmt::format("more than {} levels", kDeepest));
      parser_.failed_ = true;
    }
    return true;
  }

 private:
  ExprParser& parser_;
};

}  // namespace rondo::lang
