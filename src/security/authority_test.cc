#include "security/authority.h"

#include <gtest/gtest.h>

#include "security/rules.h"

namespace rondo::security {
namespace {

Authority Made(const std::string& name) {
  auto made = Authority::Make(name);
  EXPECT_TRUE(made.ok()) << made.error().message;
  return std::move(made).value();
}

TEST(Authority, WhatItSignsIsKnownToBeIts) {
  const Authority authority = Made("fleet"), other = Made("fleet");
  const std::string text = Permissions({"/bot0", {"rt/a"}, {"rt/b&c"}}, 1'800'000'000);
  const auto signature = authority.Sign(text);
  ASSERT_TRUE(signature.ok()) << signature.error().message;
  const auto read = Verified(signature.value(), authority.identity().certificate);
  ASSERT_TRUE(read.ok()) << read.error().message;
  // S/MIME ends lines as mails do.
  std::string lines;
  for (const char c : read.value())
    if (c != '\r') lines += c;
  EXPECT_EQ(lines, text);
  EXPECT_FALSE(Verified(signature.value(), other.identity().certificate).ok());
}

TEST(Authority, AlteredTextsAndThoseOfRobotsAreRefused) {
  const Authority authority = Made("fleet");
  std::string signature = authority.Sign("<governance>no</governance>").value();
  const size_t at = signature.find("<governance>no");
  ASSERT_NE(at, std::string::npos);
  signature.replace(at, 14, "<governance>na");
  const auto altered = Verified(signature, authority.identity().certificate);
  ASSERT_FALSE(altered.ok());
  EXPECT_NE(altered.error().message.find("not what was signed"), std::string::npos)
      << altered.error().message;
  EXPECT_FALSE(Verified("<governance>no</governance>", authority.identity().certificate).ok());
  EXPECT_FALSE(Verified("", authority.identity().certificate).ok());
  const auto robot = authority.Issue("/bot0");
  ASSERT_TRUE(robot.ok()) << robot.error().message;
  const auto own = Authority::Load(robot.value());
  ASSERT_TRUE(own.ok()) << own.error().message;
  const auto refused = Verified(own.value().Sign("<governance>").value(), authority.identity().certificate);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("somebody else"), std::string::npos) << refused.error().message;
}

TEST(Authority, IsLoadedWithItsOwnKeyOnly) {
  const Authority authority = Made("fleet"), other = Made("fleet");
  EXPECT_TRUE(Authority::Load(authority.identity()).ok());
  EXPECT_FALSE(Authority::Load({authority.identity().certificate, other.identity().key}).ok());
  EXPECT_FALSE(Authority::Load({"", ""}).ok());
  EXPECT_FALSE(Authority::Load({authority.identity().certificate, "-----BEGIN PRIVATE KEY-----\n"}).ok());
  EXPECT_NE(authority.Issue("/bot0").value().key, authority.Issue("/bot0").value().key);
}

TEST(Authority, KnowsWhatItIssued) {
  const Authority authority = Made("fleet"), other = Made("fleet");
  const Identity robot = authority.Issue("/bot0").value();
  EXPECT_TRUE(authority.Issued(robot, "/bot0"));
  EXPECT_FALSE(authority.Issued(robot, "/bot1"));
  EXPECT_FALSE(other.Issued(robot, "/bot0"));
  EXPECT_FALSE(authority.Issued({robot.certificate, other.Issue("/bot0").value().key}, "/bot0"));
  EXPECT_FALSE(authority.Issued({"", ""}, "/bot0"));
}

TEST(Authority, SumsAreThoseOfTheStandard) {  // FIPS 180-2, appendix B.1
  EXPECT_EQ(Sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Rules, ListWhatIsAllowedAndNothingElse) {
  const std::string text = Permissions({"/bot0", {"rt/a"}, {"rt/b&c"}}, 86'400);
  for (const char* part :
       {"<subject_name>CN=/bot0</subject_name>", "<not_before>1970-01-01T00:00:00</not_before>",
        "<topic>rt/a</topic>", "<topic>rt/b&amp;c</topic>", "<default>DENY</default>"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(Permissions({"/x", {}, {}}, 0).find("<publish>"), std::string::npos);
}

}  // namespace
}  // namespace rondo::security
