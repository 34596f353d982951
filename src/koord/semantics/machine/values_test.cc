#include "koord/semantics/machine/values.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace rondo::koord::semantics {
namespace {

using nlohmann::json;

class Values : public testing::Test {
 protected:
  std::string Text(TypeId type, const std::vector<Word>& words) const {
    return Show(types_, heap_, type, words);
  }
  std::optional<std::vector<Word>> Read(TypeId type, const json& value) {
    return FromJson(types_, heap_, type, value);
  }
  // From JSON to words and back.
  void ExpectRoundTrip(TypeId type, const json& value) {
    const auto words = Read(type, value);
    ASSERT_TRUE(words.has_value()) << value;
    EXPECT_EQ(words->size(), Layout::Width(types_, type));
    EXPECT_EQ(ToJson(types_, heap_, type, *words), value);
  }

  lang::TypeTable types_;
  Heap heap_;
  TypeId colour_ = types_.Enum("Colour", {"red", "green"});
  TypeId task_ = types_.Record("Task", {"id", "target", "colour"}, {types_.integer(), types_.pos(), colour_});
  TypeId scan_ = types_.Opaque("Scan");
};

TEST_F(Values, PlainOnesComeBack) {
  ExpectRoundTrip(types_.boolean(), true);
  ExpectRoundTrip(types_.integer(), std::numeric_limits<int64_t>::min());
  ExpectRoundTrip(types_.real(), 0.1);
  ExpectRoundTrip(types_.string(), "with \"quotes\" and \n");
  ExpectRoundTrip(colour_, "green");
}

TEST_F(Values, CompoundOnesComeBack) {
  const json task{{"id", 3}, {"target", {{"x", 1.5}, {"y", 0.0}, {"z", -2.0}}}, {"colour", "red"}};
  ExpectRoundTrip(task_, task);
  ExpectRoundTrip(types_.List(task_), json::array({task, task}));
  ExpectRoundTrip(types_.List(types_.List(types_.integer())),
                  json::array({json::array({1, 2}), json::array()}));
  ExpectRoundTrip(types_.Tuple({types_.integer(), types_.string()}), json::array({4, "four"}));
  ExpectRoundTrip(scan_, json::array({1U, 18446744073709551615U}));
}

TEST_F(Values, APointMayBeAListOfCoordinates) {
  EXPECT_EQ(Read(types_.pos(), json::array({1, 2.5, 3})),
            (std::vector<Word>{FromFloat(1), FromFloat(2.5), FromFloat(3)}));
  EXPECT_FALSE(Read(types_.pos(), json::array({1, 2})));
}

TEST_F(Values, AnIntIsAFloatButNotTheReverse) {
  EXPECT_EQ(Read(types_.real(), 3), std::vector<Word>{FromFloat(3)});
  EXPECT_FALSE(Read(types_.integer(), 3.0));
}

TEST_F(Values, ZeroHasOneSign) { EXPECT_EQ(Read(types_.real(), -0.0), std::vector<Word>{FromFloat(0.0)}); }

TEST_F(Values, OthersAreRefused) {
  EXPECT_FALSE(Read(types_.boolean(), 1));
  EXPECT_FALSE(Read(types_.integer(), true));
  EXPECT_FALSE(Read(types_.real(), "1"));
  EXPECT_FALSE(Read(types_.real(), std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(Read(types_.string(), 1));
  EXPECT_FALSE(Read(colour_, "blue"));
  EXPECT_FALSE(Read(colour_, 0));
}

TEST_F(Values, OneWrongPartRefusesTheWhole) {
  EXPECT_FALSE(Read(task_, json{{"id", 3}, {"colour", "red"}}));
  EXPECT_FALSE(Read(task_, json{{"id", "3"}, {"target", {0, 0, 0}}, {"colour", "red"}}));
  EXPECT_FALSE(Read(types_.List(types_.integer()), json::array({1, "2"})));
  EXPECT_FALSE(Read(types_.Tuple({types_.integer(), types_.integer()}), json::array({1, 2, 3})));
}

TEST_F(Values, AreShownAsProgramsWriteThem) {
  EXPECT_EQ(Text(types_.boolean(), {1}), "true");
  EXPECT_EQ(Text(types_.integer(), {FromInt(-4)}), "-4");
  EXPECT_EQ(Text(types_.real(), {FromFloat(0.1)}), "0.1");
  EXPECT_EQ(Text(colour_, {1}), "green");
  EXPECT_EQ(Text(types_.string(), {heap_.InternText("hello")}), "\"hello\"");
  EXPECT_EQ(Text(types_.pos(), {FromFloat(1), FromFloat(2), FromFloat(0.5)}), "(1, 2, 0.5)");
}

TEST_F(Values, ListsAreShownItemByItem) {
  const std::vector<Word> words{1, 1, 0, 0};
  const TypeId pair = types_.Tuple({types_.integer(), types_.boolean()});
  EXPECT_EQ(Text(types_.List(pair), {heap_.Intern(words)}), "[(1, true), (0, false)]");
  EXPECT_EQ(Text(types_.List(pair), {0}), "[]");
}

TEST_F(Values, OpaqueOnesAreShownByName) {
  EXPECT_EQ(Text(scan_, {0}), "empty Scan");
  EXPECT_NE(Text(scan_, {heap_.Intern(std::vector<Word>{1})}), "empty Scan");
}

TEST_F(Values, FlatArraysAreShownLevelByLevel) {
  Layout::Place place;
  place.item = types_.integer();
  place.width = 1;
  place.dimensions = {2, 3};
  const std::vector<Word> words{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(Show(types_, heap_, place, words), "[[1, 2, 3], [4, 5, 6]]");
  EXPECT_EQ(ToJson(types_, heap_, place, words),
            json::array({json::array({1, 2, 3}), json::array({4, 5, 6})}));
}

TEST_F(Values, MarkingReachesInnerLists) {
  const TypeId nested = types_.List(types_.Tuple({types_.integer(), types_.List(types_.string())}));
  const auto words = Read(nested, json::array({json::array({1, json::array({"deep"})})}));
  ASSERT_TRUE(words.has_value());
  MarkHandles(types_, heap_, nested, *words);
  heap_.Sweep();
  EXPECT_EQ(Text(nested, *words), "[(1, [\"deep\"])]");
}

}  // namespace
}  // namespace rondo::koord::semantics
