#include "contracts/tube_certificate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "contracts/decide.h"
#include "contracts/discharge.h"
#include "contracts/file_contracts_test.h"
#include "contracts/tube_reuse.h"

namespace rondo::contracts {
namespace {

namespace fs = std::filesystem;

// A point that moves by one each second for two seconds, from somewhere between 0 and 1: to 3 at most.
const std::string kPoint = R"(robot P {
  param gain = 1
  state x: number in [-10, 10]
  dynamics { x' = gain / 1 s }
  motion Below4() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= 4 }
  motion Below5() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= 5 }
  motion Below2() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= 2.5 }
  motion Longer() noninterruptible [3 s, 3 s] { modifies x pre x >= 0 and x <= 1 during x <= 5 }
  motion Later() noninterruptible [2 s, 2 s] { modifies x pre x >= 1 and x <= 2 during x <= 3.5 }
}
)";

class PointTubes : public FileContracts {
 protected:
  PointTubes() : FileContracts(kPoint) {}
  static reach::certify::Certificate Proof(const ContractResult& result) {
    const auto* proved = std::get_if<reach::Proved>(&*result.outcome);
    EXPECT_NE(proved, nullptr);
    return CertificateOf(*proved);
  }
  std::string Tube(const std::string& contract, const reach::certify::Certificate& certificate) const {
    const std::string path = folder_.Path("tube.json");
    EXPECT_TRUE(SaveTube(path, {{file_}, "", contract, certificate}).ok());
    return base::ReadFile(path).value();
  }
};

TEST_F(PointTubes, TheProofIsCertified) {
  ContractResult& result = Decided("Below4()");
  EXPECT_FALSE(result.IsCertified());
  CertifyContract(result, Proof(result), 1, base::StopToken());
  EXPECT_TRUE(result.IsCertified());
}

TEST_F(PointTubes, ACertificateWithoutPartsIsRejected) {
  ContractResult& result = Decided("Below4()");
  CertifyContract(result, {}, 1, base::StopToken());
  EXPECT_FALSE(result.IsCertified());
  EXPECT_NE(result.certified->reason, "");
}

TEST_F(PointTubes, NoCertificateShowsWhatIsFalse) {
  const auto certificate = Proof(Decided("Below4()"));
  ContractResult& wrong = Find("Below2()");
  CertifyContract(wrong, certificate, 1, base::StopToken());
  EXPECT_FALSE(wrong.IsCertified());
}

TEST_F(PointTubes, ATubeIsReadBackAndAccepted) {
  const auto certificate = Proof(Decided("Below4()"));
  const std::string text = Tube("P: Below4()", certificate);
  EXPECT_TRUE(IsTube(text));
  const auto read = ReadTube(text);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value().files, std::vector<std::string>{file_});
  EXPECT_EQ(read.value().certificate.parts.size(), certificate.parts.size());
  EXPECT_EQ(Tube("P: Below4()", read.value().certificate), text);
  workspace::Session fresh;
  const auto checked = CheckTube(read.value(), fresh, base::StopToken());
  ASSERT_TRUE(checked.ok());
  EXPECT_TRUE(checked.value().accepted) << checked.value().reason;
}

TEST_F(PointTubes, EachTruncationOfATubeIsAnError) {
  const std::string text = Tube("P: Below4()", Proof(Decided("Below4()")));
  for (size_t size = 0; size + 2 < text.size(); ++size)
    EXPECT_FALSE(ReadTube(text.substr(0, size)).ok()) << size;
}

TEST_F(PointTubes, ATubeOfAnotherContractIsNotAccepted) {
  TubeFile tube{{file_}, "", "P: Below2()", Proof(Decided("Below4()"))};
  workspace::Session fresh;
  const auto checked = CheckTube(tube, fresh, base::StopToken());
  EXPECT_TRUE(!checked.ok() || !checked.value().accepted);
  tube.contract = "P: Nothing()";
  workspace::Session other;
  EXPECT_FALSE(CheckTube(tube, other, base::StopToken()).ok());
}

TEST_F(PointTubes, ATubeOfAModelThatHasChangedIsNotAccepted) {
  const TubeFile tube{{file_}, "", "P: Below4()", Proof(Decided("Below4()"))};
  std::string text = kPoint;
  text.replace(text.find("gain = 1"), 8, "gain = 2");
  folder_.Write("p.rondo", text);
  workspace::Session fresh;
  const auto checked = CheckTube(tube, fresh, base::StopToken());
  EXPECT_TRUE(!checked.ok() || !checked.value().accepted);
}

TEST_F(PointTubes, ScriptsAreNoTubes) {
  for (const char* text : {"", "(check-sat)", "; remark", " \n"}) EXPECT_FALSE(IsTube(text)) << text;
}

TEST_F(PointTubes, ATubeShowsItsContractAndWeakerOnes) {
  const ContractResult& proved = Decided("Below4()");
  TubeReuse reuse;
  EXPECT_EQ(reuse.Covers(proved).contract, "");
  reuse.Remember(proved, Proof(proved));
  EXPECT_EQ(reuse.Covers(proved).contract, "P: Below4()");
  EXPECT_EQ(reuse.Covers(Find("Below5()")).contract, "P: Below4()");
}

TEST_F(PointTubes, ATubeDoesNotShowWhatItDoesNotKeep) {
  const ContractResult& proved = Decided("Below4()");
  TubeReuse reuse;
  reuse.Remember(proved, Proof(proved));
  for (const char* name : {"Below2()", "Longer()", "Later()"})
    EXPECT_EQ(reuse.Covers(Find(name)).contract, "") << name;
}

TEST_F(PointTubes, WhatIsNotProvedIsNotRemembered) {
  TubeReuse reuse;
  reuse.Remember(Find("Below4()"), {});
  reuse.Remember(Decided("Below2()"), {});
  EXPECT_EQ(reuse.Covers(Find("Below4()")).contract, "");
  EXPECT_EQ(reuse.Covers(Find("Below2()")).contract, "");
}

TEST_F(PointTubes, OnlyProvedOnesAreKept) {
  const solve::cache::ProofCache cache(folder_.path() / "cache");
  StoreProved(Find("Below5()"), cache);
  StoreProved(Decided("Below2()"), cache);
  StoreProved(Decided("Below4()"), cache);
  EXPECT_TRUE(IsProved(Find("Below4()"), cache));
  for (const char* name : {"Below5()", "Below2()", "Later()"})
    EXPECT_FALSE(IsProved(Find(name), cache)) << name;
}

TEST_F(PointTubes, AProofIsNotOneOfAModelThatHasChanged) {
  const solve::cache::ProofCache cache(folder_.path() / "cache");
  StoreProved(Decided("Below4()"), cache);
  std::string text = kPoint;
  text.replace(text.find("gain = 1"), 8, "gain = 2");
  folder_.Write("p.rondo", text);
  loaded_.results.clear();
  Load();
  EXPECT_FALSE(IsProved(Find("Below4()"), cache));
}

}  // namespace
}  // namespace rondo::contracts
