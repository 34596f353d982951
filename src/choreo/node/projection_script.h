#pragma once

#include "choreo/node/senses.h"
#include "choreo/project/project.h"
#include "runtime/sessions/session.h"

namespace rondo::choreo {

/// Does what a local type says. Its motions are the instances of the graph, by index.
class ProjectionScript final : public runtime::sessions::Program {
 public:
  /// Everything must outlive it.
  ProjectionScript(const Graph& graph, const expr::Arena& arena, const LocalType& type, Senses& senses)
      : graph_(graph), arena_(arena), type_(type), senses_(senses) {}

  runtime::sessions::Step Next() override;
  bool Waits() const override;
  void Sent() override { at_ = only_; }
  void Took(size_t which, const std::vector<double>& values) override;
  void Moved() override { at_ = only_; }

 private:
  bool Choose(std::string& problem);
  void Behind(runtime::sessions::Step& step);
  const LocalState& At(StateId s) const { return type_.states[s.index()]; }

  const Graph& graph_;
  const expr::Arena& arena_;
  const LocalType& type_;
  Senses& senses_;
  StateId at_{0};
  StateId only_{0};             // behind the present step, if it has one way on
  std::vector<StateId> cases_;  // by case of the present step
};

}  // namespace rondo::choreo
