#pragma once

#include <gtest/gtest.h>

#include <string>

#include "runtime/rounds/parts.h"

/// Instantiates a suite of tests with every exchange, by its name.
#define RONDO_FOR_EVERY_EXCHANGE(suite)                                                  \
  INSTANTIATE_TEST_SUITE_P(Rounds, suite,                                                \
                           testing::Values(rondo::runtime::rounds::Exchange::kAllToAll,  \
                                           rondo::runtime::rounds::Exchange::kSequencer, \
                                           rondo::runtime::rounds::Exchange::kCentral),  \
                           [](const auto& test) {                                        \
                             std::string name(rondo::runtime::rounds::Name(test.param)); \
                             std::erase(name, '-');                                      \
                             return name;                                                \
                           })
