#include "lang/types.h"

#include <gtest/gtest.h>

namespace rondo::lang {
namespace {

TEST(TypeTable, UnifiesThroughVariables) {
  TypeTable types;
  const TypeId v = types.FreshVariable();
  EXPECT_TRUE(types.Unify(types.List(v), types.List(types.pos())));
  EXPECT_EQ(types.Name(v), "pos");
  EXPECT_FALSE(types.Unify(v, types.boolean()));
}

TEST(TypeTable, RefusesAnInfiniteType) {
  TypeTable types;
  const TypeId v = types.FreshVariable();
  EXPECT_FALSE(types.Unify(v, types.List(v)));
}

TEST(TypeTable, OnlyIntBecomesFloat) {
  TypeTable types;
  EXPECT_TRUE(types.Coerce(types.integer(), types.real()));
  EXPECT_FALSE(types.Coerce(types.real(), types.integer()));
  EXPECT_FALSE(types.Coerce(types.boolean(), types.real()));
  EXPECT_FALSE(types.Unify(types.integer(), types.real()));
}

}  // namespace
}  // namespace rondo::lang
