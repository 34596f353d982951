#include "runtime/codec/bytes.h"

#include <gtest/gtest.h>

#include <string>

namespace rondo::runtime::codec {
namespace {

TEST(Bytes, ComeBackAsTheyWere) {
  Bytes bytes;
  Writer writer(bytes);
  const Bytes block{1, 2, 3};
  for (const uint64_t n : {uint64_t{0}, uint64_t{127}, uint64_t{128}, UINT64_MAX}) writer.Number(n);
  writer.Fixed(0x0123456789abcdef);
  writer.Block(block);
  writer.Byte(7);
  Reader reader(bytes);
  for (const uint64_t n : {uint64_t{0}, uint64_t{127}, uint64_t{128}, UINT64_MAX})
    EXPECT_EQ(reader.Number(), n);
  EXPECT_EQ(reader.Fixed(), 0x0123456789abcdefU);
  const View back = reader.Block(3);
  EXPECT_EQ(Bytes(back.begin(), back.end()), block);
  EXPECT_FALSE(reader.Complete());
  EXPECT_EQ(reader.Byte(), 7);
  EXPECT_TRUE(reader.Complete());
}

TEST(Bytes, ANumberHasOneFormOnly) {
  for (const Bytes& bytes :
       {Bytes{0x80, 0x00}, Bytes{0xff, 0x80, 0x00}, Bytes(10, 0xff), Bytes{0x80}, Bytes{}}) {
    Reader reader(bytes);
    EXPECT_EQ(reader.Number(), 0U);
    EXPECT_FALSE(reader.ok());
  }
}

TEST(Bytes, WhatIsTooLongIsRefusedBeforeItIsRead) {
  Bytes bytes;
  Writer(bytes).Number(5);
  EXPECT_TRUE(Reader(bytes).Number(5) == 5);
  Reader small(bytes);
  small.Number(4);
  EXPECT_FALSE(small.ok());
  Bytes long_block;
  Writer(long_block).Block(Bytes(100));
  Reader reader(long_block);
  EXPECT_TRUE(reader.Block(99).empty());
  EXPECT_FALSE(reader.ok());
  Bytes cut;
  Writer(cut).Number(UINT64_MAX);  // a length without its bytes
  Reader missing(cut);
  missing.Block(SIZE_MAX);
  EXPECT_FALSE(missing.ok());
}

TEST(Bytes, NothingIsReadBehindTheFirstError) {
  const Bytes bytes{0x80, 0x00, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  Reader reader(bytes);
  reader.Number();
  EXPECT_EQ(reader.Fixed(), 0U);
  EXPECT_EQ(reader.Byte(), 0U);
  EXPECT_FALSE(reader.Complete());
}

}  // namespace
}  // namespace rondo::runtime::codec
