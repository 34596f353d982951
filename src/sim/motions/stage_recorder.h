#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "robot/contact/solid.h"
#include "sim/motions/condition.h"
#include "sim/motions/report.h"
#include "sim/motions/scene_state.h"
#include "trace/writer.h"

namespace rondo::sim::motions {

/// Records runs of choreographies as traces.
///
/// Topics: `/rondo/run` (once, JSON: everything that a replay needs), `/rondo/event` (JSON: messages, motions, incidents, the
/// end), `/ROBOT/pose` (PoseStamped: of its frame `base`, or where it was put), `/ROBOT/joint_states` (JointState: its
/// states), `/tf` (TFMessage: ROBOT and ROBOT/FRAME, each in `world`), `/bodies` and `/world` (MarkerArray).
class StageRecorder {
 public:
  /// Begins with `/rondo/run` and the obstacles. Everything must outlive it.
  StageRecorder(trace::Writer& writer, const choreo::Graph& graph, expr::Arena& arena,
                const nlohmann::json& run);

  /// Say what happens, at this moment in seconds since the run began.
  void Message(double time, uint32_t from, uint32_t to, const std::string& label,
               const std::vector<double>& values);
  void Begins(double time, size_t robot, const std::string& motion);
  void Ends(double time, size_t robot, const std::string& motion);
  void Incident(double time, Wrong wrong, const std::string& what);
  /// Shows where everything is, if that was not shown within the last twentieth of a second.
  void Scene(double time, const SceneState& scene);
  /// Shows where everything is in the end, and says why it ended.
  void Finish(double time, const SceneState& scene, const ChoreographyReport& report);

 private:
  struct Frame {
    std::string name;  // ROBOT or ROBOT/FRAME
    bool pose = false;
  };
  struct Robot {
    std::vector<Frame> frames;
    std::optional<Functions> poses;  // twelve numbers each: rotation row by row, origin
    std::optional<robot::Solid> body;
    std::vector<std::string> states;
    std::vector<size_t> places;
  };
  void Event(double time, const nlohmann::json& event);
  void Show(double time, const SceneState& scene);
  uint16_t Channel(const std::string& topic, const trace::Schema& schema, const char* encoding);

  trace::Writer& writer_;
  const choreo::Graph& graph_;
  std::map<std::string, uint16_t> channels_;
  SceneState scene_;  // the variables, in order
  std::vector<Robot> robots_;
  double shown_ = -1;
};

}  // namespace rondo::sim::motions
