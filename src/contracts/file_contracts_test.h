#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "contracts/decide.h"
#include "contracts/load.h"
#include "fixtures/temporary_folder.h"

namespace rondo::contracts {

/// The contracts of a robot type `P` in a file, which stands in a folder of its own.
class FileContracts : public testing::Test {
 protected:
  explicit FileContracts(const std::string& text) : file_(folder_.Write("p.rondo", text)) {}

  void Load(const robot::Loose* loose = nullptr) {
    EXPECT_TRUE(LoadContracts({file_}, "", loose, true, session_, loaded_));
  }
  ContractResult& Find(const std::string& motion) {
    if (loaded_.results.empty()) Load();
    const auto it = std::ranges::find(loaded_.results, "P: " + motion,
                                      [](const ContractResult& r) { return r.made.problem.name; });
    EXPECT_NE(it, loaded_.results.end()) << motion;
    return *it;
  }
  ContractResult& Decided(const std::string& motion) {
    ContractResult& result = Find(motion);
    DecideOptions options;
    options.jobs = 1;
    DecideContract(result, options, base::StopToken());
    return result;
  }

  fixtures::TemporaryFolder folder_;
  const std::string file_;
  workspace::Session session_;
  LoadedContracts loaded_;
};

}  // namespace rondo::contracts
