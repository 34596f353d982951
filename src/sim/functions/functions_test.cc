#include "sim/functions/functions.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"

namespace rondo::sim {
namespace {

using koord::semantics::FromFloat;
using koord::semantics::FromInt;
using koord::semantics::Team;
using koord::semantics::TeamOptions;
using koord::semantics::ToFloat;

const char* const kProgram =
    "def fun pathIsClear(List<List<pos>> all, List<pos> p, int i) -> bool\n"
    "def fun apart(List<pos> p, List<pos> q) -> float\n"
    "def fun away(pos p, List<pos> q) -> float\n"
    "def fun merge(Map a, Map b) -> Map\n"
    "def fun scanToMap(pos p, Scan s) -> Map\n"
    "def fun pickFrontierPos(Map m, pos p) -> pos\n"
    "def fun findObs(Map m) -> List<Cell>\n"
    "def fun right(Map m) -> bool\n"
    "def fun true_scan(pos p, Scan s) -> bool\n"
    "def fun far(pos p, List<pos> q) -> float\n"
    "using Motion:\n"
    "    sensors:\n        pos psn\n        PathPlanner planner\n"
    "    actuators:\n        List<pos> path\n"
    "local:\n    int n\n"
    "Go:\n    eff:\n        Motion.path = Motion.planner(pos(4, 0, 0))\n";

// A world of 6 x 6 m with a box of 1 m around (4.5, 4.5), for one point mass at the origin of its lower corner.
class External : public testing::Test {
 protected:
  External() { Load(kProgram); }
  void Load(const std::string& text) {
    fleet_.world.low = {0, 0, 0};
    fleet_.world.high = {6, 6, 2};
    fleet_.world.boxes = {{{4.5, 4.5, 1}, {0.9, 0.9, 2}}};
    fleet_.path_clearance = 1;
    program_ = {};
    koord::Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = koord::Check(program_, diagnostics_);
    ASSERT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message;
    functions_ = std::make_unique<Functions>(model_, fleet_, 1);
    TeamOptions options;
    options.hosted = [&](size_t f) { return functions_->Knows(f); };
    team_ = Team::Make(model_, options, diagnostics_);
    ASSERT_NE(team_, nullptr);
    bodies_.clear();
    bodies_.push_back(MakeBody("point_mass"));
    bodies_[0]->Place({0.5, 0.5, 0}, 0);
    functions_->Attach(*team_, bodies_);
  }
  size_t Find(const std::string& name) const {
    for (size_t f = 0; f < model_.functions.size(); ++f) {
      if (model_.functions[f].name == name) return f;
    }
    ADD_FAILURE() << "no function " << name;
    return 0;
  }
  std::vector<Word> Call(const std::string& name, const std::vector<Word>& arguments, size_t width = 1) {
    std::vector<Word> result(width);
    EXPECT_EQ(functions_->Call(Find(name), 0, arguments, result), koord::semantics::Answer::kValue) << name;
    return result;
  }
  Word Path(const std::vector<Point>& path) { return EncodePath(team_->heap(), path); }
  Word List(std::vector<Word> words) { return team_->heap().Intern(words); }
  // All unknown but the edge.
  GridMap Blank() const { return EmptyMap(fleet_.world, fleet_.cell); }
  Word Map(const GridMap& map) { return EncodeMap(team_->heap(), map); }
  // Four rays in the directions of the axes.
  Word Scan(const std::vector<double>& distances) {
    return EncodeRays(team_->heap(), {0, std::numbers::pi / 2, 10, distances});
  }
  static std::vector<Word> At(double x, double y, std::vector<Word> more) {
    more.insert(more.begin(), {FromFloat(x), FromFloat(y), FromFloat(0)});
    return more;
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  koord::Program program_;
  koord::Model model_;
  Fleet fleet_;
  std::unique_ptr<Functions> functions_;
  std::unique_ptr<Team> team_;
  std::vector<std::unique_ptr<Body>> bodies_;
};

TEST_F(External, FunctionsAreRecognisedByNameAndType) {
  EXPECT_TRUE(functions_->Knows(Find("apart")));
  EXPECT_FALSE(functions_->Knows(Find("far")));
  Load("def fun apart(pos p, List<pos> q) -> float\nlocal:\n    int n\nGo:\n    eff:\n        n = 1\n");
  EXPECT_FALSE(functions_->Knows(Find("apart")));
}

TEST_F(External, AFunctionThatIsNotKnownHasNoValue) {
  std::vector<Word> result(1);
  EXPECT_EQ(functions_->Call(Find("far"), 0, {}, result), koord::semantics::Answer::kNone);
}

TEST_F(External, APathIsClearOfThoseOfOthers) {
  const Word others = List({Path({{0, 0, 0}, {4, 0, 0}}), Path({{0, 3, 0}, {4, 3, 0}})});
  EXPECT_EQ(Call("pathIsClear", {others, Path({{0, 1.5, 0}, {4, 1.5, 0}}), FromInt(-1)})[0], 1U);
  EXPECT_EQ(Call("pathIsClear", {others, Path({{0, 0.5, 0}, {4, 0.5, 0}}), FromInt(1)})[0], 0U);
  EXPECT_EQ(Call("pathIsClear", {others, Path({{0, 0.5, 0}, {4, 0.5, 0}}), FromInt(0)})[0], 1U);
}

TEST_F(External, APathAtExactlyTheClearanceIsNotClear) {
  const Word others = List({Path({{0, 0, 0}})});
  EXPECT_EQ(Call("pathIsClear", {others, Path({{1, 0, 0}}), FromInt(9)})[0], 0U);
}

TEST_F(External, TheProgramMaySayHowFarAClearPathIs) {
  Load("param float rho = 3\n" + std::string(kProgram));
  const Word others = List({Path({{0, 0, 0}})});
  EXPECT_EQ(Call("pathIsClear", {others, Path({{2, 0, 0}}), FromInt(9)})[0], 0U);
  EXPECT_EQ(Call("pathIsClear", {others, Path({{3.5, 0, 0}}), FromInt(9)})[0], 1U);
}

TEST_F(External, PathsAreAsFarApartAsTheirNearestPoints) {
  EXPECT_EQ(ToFloat(Call("apart", {Path({{0, 0, 0}, {4, 0, 0}}), Path({{2, 3, 0}})})[0]), 3);
  EXPECT_EQ(ToFloat(Call("apart", {Path({{0, 0, 0}, {4, 0, 0}}), Path({{2, -1, 0}, {2, 1, 0}})})[0]), 0);
  EXPECT_EQ(ToFloat(Call("away", At(7, 4, {Path({{0, 0, 0}, {4, 0, 0}})}))[0]), 5);
}

TEST_F(External, NothingIsNearAnEmptyPath) {
  EXPECT_EQ(ToFloat(Call("apart", {Path({}), Path({{0, 0, 0}})})[0]), 1e9);
  EXPECT_EQ(ToFloat(Call("away", At(0, 0, {Path({})}))[0]), 1e9);
}

TEST_F(External, MergingWithNothingChangesNothing) {
  const Word map = Map(Blank());
  EXPECT_EQ(Call("merge", {map, 0})[0], map);
  EXPECT_EQ(Call("merge", {0, map})[0], map);
}

TEST_F(External, MergingKeepsWhatEitherKnows) {
  GridMap a = Blank();
  GridMap b = Blank();
  a.At(1, 1) = GridMap::kEmpty;
  b.At(2, 2) = GridMap::kOccupied;
  const auto both = DecodeMap(team_->heap(), Call("merge", {Map(a), Map(b)})[0]);
  ASSERT_TRUE(both.has_value());
  EXPECT_EQ(both->At(1, 1), GridMap::kEmpty);
  EXPECT_EQ(both->At(2, 2), GridMap::kOccupied);
}

TEST_F(External, AScanMarksTheCellsInWhichItsRaysEnd) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto map = DecodeMap(
      team_->heap(), Call("scanToMap", At(1.5, 4.5, {Scan({2.55, infinity, infinity, infinity})}))[0]);
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(map->At(4, 4), GridMap::kOccupied);
  EXPECT_EQ(map->At(3, 1), GridMap::kUnknown);
}

TEST_F(External, TheFrontierIsTheNearestEmptyCellBesideTheUnknown) {
  GridMap map = Blank();
  map.At(1, 1) = map.At(2, 1) = map.At(1, 2) = map.At(3, 1) = GridMap::kEmpty;
  map.At(2, 2) = GridMap::kOccupied;
  const auto target = Call("pickFrontierPos", {Map(map), FromFloat(2.5), FromFloat(1.5), FromFloat(0.75)}, 3);
  EXPECT_EQ(ReadPoint(target.data()), (Point{3.5, 1.5, 0.75}));
}

TEST_F(External, WithoutAFrontierARobotStays) {
  const auto target = Call("pickFrontierPos", {0, FromFloat(2.5), FromFloat(1.25), FromFloat(0.75)}, 3);
  EXPECT_EQ(ReadPoint(target.data()), (Point{2.5, 1.25, 0.75}));
}

TEST_F(External, ObstaclesAreTheCellsAroundEmptyOnes) {
  GridMap map = Blank();
  map.At(2, 2) = GridMap::kEmpty;
  const auto cells = team_->heap()[Call("findObs", {Map(map)})[0]];
  ASSERT_EQ(cells.size(), 8U);
  const auto first = team_->heap()[cells[0]];
  EXPECT_EQ(std::vector<Word>(first.begin(), first.end()),
            (std::vector<Word>{FromFloat(1.5), FromFloat(1.5), FromFloat(1)}));
}

TEST_F(External, AMapIsRightIfOccupiedCellsAreOccupied) {
  GridMap map = Blank();
  map.At(4, 4) = GridMap::kOccupied;
  map.At(2, 2) = GridMap::kEmpty;
  EXPECT_EQ(Call("right", {Map(map)})[0], 1U);
  map.At(2, 2) = GridMap::kOccupied;
  EXPECT_EQ(Call("right", {Map(map)})[0], 0U);
}

TEST_F(External, AScanIsTrueIfItsRaysEndOnObstacles) {
  const double infinity = std::numeric_limits<double>::infinity();
  // The box begins at x = 4.05.
  EXPECT_EQ(Call("true_scan", At(1.5, 4.5, {Scan({2.55, infinity, infinity, infinity})}))[0], 1U);
  EXPECT_EQ(Call("true_scan", At(1.5, 4.5, {Scan({2.45, infinity, infinity, infinity})}))[0], 0U);
  EXPECT_EQ(Call("true_scan", At(1.5, 4.5, {Scan({2.55, 1, infinity, infinity})}))[0], 0U);
}

TEST_F(External, NoiseAndResolutionMakeScansLessTrue) {
  const double infinity = std::numeric_limits<double>::infinity();
  fleet_.lidar.noise = 0.02;  // five deviations
  EXPECT_EQ(Call("true_scan", At(1.5, 4.5, {Scan({2.46, infinity, infinity, infinity})}))[0], 1U);
  EXPECT_EQ(Call("true_scan", At(1.5, 4.5, {Scan({2.44, infinity, infinity, infinity})}))[0], 0U);
}

TEST_F(External, APlanGoesFromTheRobotToTheTarget) {
  const auto result = Call("Motion.planner", At(5.5, 0.5, {}));
  const std::vector<Point> path = DecodePath(team_->heap(), result[0]);
  ASSERT_EQ(path.size(), 2U);  // the straight line is free
  EXPECT_EQ(path[0], (Point{0.5, 0.5, 0}));
  EXPECT_EQ(path[1], (Point{5.5, 0.5, 0}));
  EXPECT_EQ(functions_->plans(), 1U);
}

TEST_F(External, WithoutAWayThePlanIsEmpty) { EXPECT_EQ(Call("Motion.planner", At(4.5, 4.5, {}))[0], 0U); }

}  // namespace
}  // namespace rondo::sim
