#include "deploy/keystore.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace rondo::deploy {
namespace {

namespace fs = std::filesystem;

class Keystores : public testing::Test {
 protected:
  Keystores() : folder_(fs::temp_directory_path() / ("rondo_keystore_" + std::to_string(::getpid()))) {
    texts_.program = "program";
    texts_.spec = "spec";
    texts_.fleet = "fleet";
  }
  ~Keystores() override { fs::remove_all(folder_); }

  Keystore Make() {
    const std::vector<security::Enclave> enclaves{{"/bot0", {"rt/a"}, {}}, {"/hall/bot1", {}, {"rt/a"}}};
    auto made = MakeKeystore(folder_.string(), enclaves, texts_);
    EXPECT_TRUE(made.ok()) << made.error().message;
    return made.ok() ? made.value() : Keystore();
  }
  std::string Read(const fs::path& file) const {
    std::ifstream in(folder_ / file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
  RobotOptions texts_;
};

TEST_F(Keystores, WhoHasAKeyKeepsIt) {
  const Keystore first = Make();
  EXPECT_TRUE(first.fresh);
  EXPECT_EQ(first.named, (std::vector<std::string>{"/bot0", "/hall/bot1"}));
  const std::string key = Read("enclaves/hall/bot1/key.pem"), owner = Read("private/ca.key.pem");
  EXPECT_FALSE(key.empty());
  const Keystore second = Make();
  EXPECT_FALSE(second.fresh);
  EXPECT_TRUE(second.named.empty());
  EXPECT_EQ(Read("enclaves/hall/bot1/key.pem"), key);
  EXPECT_EQ(Read("private/ca.key.pem"), owner);
}

TEST_F(Keystores, KeysAreForTheFilesThatWereSigned) {
  Make();
  const auto keys = KeysFor(folder_.string(), "/hall/bot1", texts_);
  ASSERT_TRUE(keys.ok()) << keys.error().message;
  EXPECT_EQ(keys.value().folder, (folder_ / "enclaves/hall/bot1").string());
  EXPECT_EQ(keys.value().enclave, "/hall/bot1");
  for (std::string* text : {&texts_.program, &texts_.spec, &texts_.fleet}) {
    const std::string before = std::exchange(*text, "other");
    EXPECT_FALSE(KeysFor(folder_.string(), "/bot0", texts_).ok());
    *text = before;
  }
  texts_.files = {{"map.pgm", "P5"}};
  EXPECT_FALSE(KeysFor(folder_.string(), "/bot0", texts_).ok());
  Make();  // signed again
  EXPECT_TRUE(KeysFor(folder_.string(), "/bot0", texts_).ok());
  const auto nobody = KeysFor(folder_.string(), "/bot7", texts_);
  ASSERT_FALSE(nobody.ok());
  EXPECT_NE(nobody.error().message.find("`rondo keys`"), std::string::npos);
}

TEST_F(Keystores, KeysOfAnotherOwnerAndHalvesAreMadeAnew) {
  Make();
  fs::remove(folder_ / "enclaves/bot0/cert.pem");
  EXPECT_EQ(Make().named, std::vector<std::string>{"/bot0"});
  fs::remove_all(folder_ / "private");
  const Keystore again = Make();
  EXPECT_TRUE(again.fresh);
  EXPECT_EQ(again.named.size(), 2U);
  EXPECT_TRUE(KeysFor(folder_.string(), "/bot0", texts_).ok());
}

TEST_F(Keystores, OthersCannotReadKeysAndFoldersThatWereThereStay) {
  fs::create_directories(folder_);
  fs::permissions(folder_, static_cast<fs::perms>(0755));
  Make();
  EXPECT_EQ(fs::status(folder_).permissions(), static_cast<fs::perms>(0755));
  EXPECT_EQ(fs::status(folder_ / "private").permissions(), static_cast<fs::perms>(0700));
  for (const char* key : {"private/ca.key.pem", "enclaves/hall/bot1/key.pem"})
    EXPECT_EQ(fs::status(folder_ / key).permissions(), static_cast<fs::perms>(0600)) << key;
}

TEST_F(Keystores, WhatCannotBeReadIsSaid) {
  Make();
  std::ofstream(folder_ / "private/ca.key.pem") << "no key";
  const auto failed = MakeKeystore(folder_.string(), {}, texts_);
  ASSERT_FALSE(failed.ok());
  EXPECT_NE(failed.error().message.find("the key cannot be read"), std::string::npos)
      << failed.error().message;
}

}  // namespace
}  // namespace rondo::deploy
