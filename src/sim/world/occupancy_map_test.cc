#include "sim/world/occupancy_map.h"

#include <gtest/gtest.h>
#include <png.h>

#include <map>
#include <random>

namespace rondo::sim {
namespace {

using Files = std::map<std::string, std::string>;

base::Result<OccupancyMap> Read(const Files& files) {
  return ReadOccupancyMap("maps/map.yaml", [&](const std::string& path) -> base::Result<std::string> {
    const auto it = files.find(path);
    if (it == files.end()) return base::Error{"no such file"};
    return it->second;
  });
}

const std::string kYaml =
    "image: map.pgm\nresolution: 0.5\norigin: [-1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::string Pgm(int columns, int rows, const std::string& cells) {
  return "P5\n# a comment\n" + std::to_string(columns) + " " + std::to_string(rows) + "\n255\n" + cells;
}

// Is the middle of the cell in a wall? Rows from the top.
int WallsAt(const OccupancyMap& map, int rows, int column, int row) {
  const double x = -1 + 0.5 * (column + 0.5);
  const double y = 2 + 0.5 * (rows - row - 0.5);
  int walls = 0;
  for (const Rectangle& r : map.walls)
    walls += r.low[0] < x && x < r.high[0] && r.low[1] < y && y < r.high[1] ? 1 : 0;
  return walls;
}

TEST(OccupancyMap, OccupiedAndUnknownCellsAreWalls) {
  // Free, unknown (grey), occupied; the second row is the lower one.
  const auto map =
      Read({{"maps/map.yaml", kYaml}, {"maps/map.pgm", Pgm(3, 2, {"\xfe\xcd\x00\xfe\xfe\x00", 6})}});
  ASSERT_TRUE(map.ok()) << map.error().message;
  EXPECT_EQ(map.value().low[0], -1);
  EXPECT_EQ(map.value().high[0], 0.5);
  EXPECT_EQ(map.value().high[1], 3);
  const int expected[2][3] = {{0, 1, 1}, {0, 0, 1}};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column)
      EXPECT_EQ(WallsAt(map.value(), 2, column, row), expected[row][column]) << row << " " << column;
  }
}

TEST(OccupancyMap, NegationModesAndThresholdsCount) {
  const std::string cells("\x00\x32\x64\xff", 4);
  const auto walls = [&](const std::string& more) {
    const auto map = Read({{"maps/map.yaml", kYaml + more}, {"maps/map.pgm", Pgm(4, 1, cells)}});
    EXPECT_TRUE(map.ok()) << map.error().message;
    std::string text;
    for (int column = 0; column < 4 && map.ok(); ++column)
      text += WallsAt(map.value(), 1, column, 0) > 0 ? '#' : '.';
    return text;
  };
  EXPECT_EQ(walls(""), "###.");
  EXPECT_EQ(walls("mode: raw\n"), ".###");  // 0: free; 50, 100: occupied; 255: unknown
  const auto negated =
      Read({{"maps/map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [-1, 2, 0]\nnegate: 1\n"},
            {"maps/map.pgm", Pgm(4, 1, cells)}});
  ASSERT_TRUE(negated.ok());
  EXPECT_EQ(WallsAt(negated.value(), 1, 0, 0), 0);
  EXPECT_EQ(WallsAt(negated.value(), 1, 3, 0), 1);
}

TEST(OccupancyMap, WallsCoverTheirCellsOnce) {
  std::mt19937_64 random(3);
  for (int run = 0; run < 50; ++run) {
    const int columns = 1 + static_cast<int>(random() % 9);
    const int rows = 1 + static_cast<int>(random() % 9);
    std::string cells;
    for (int i = 0; i < columns * rows; ++i) cells += random() % 3 == 0 ? '\x00' : '\xfe';
    const auto map = Read({{"maps/map.yaml", kYaml}, {"maps/map.pgm", Pgm(columns, rows, cells)}});
    ASSERT_TRUE(map.ok());
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column)
        EXPECT_EQ(WallsAt(map.value(), rows, column, row),
                  cells[static_cast<size_t>(row * columns + column)] == 0 ? 1 : 0);
    }
  }
}

TEST(OccupancyMap, ReadsPngAndTextPgm) {
  const std::vector<uint8_t> grey{254, 0, 254, 205};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 4;
  image.height = 1;
  image.format = PNG_FORMAT_GRAY;
  png_alloc_size_t size = 0;
  ASSERT_NE(png_image_write_to_memory(&image, nullptr, &size, 0, grey.data(), 0, nullptr), 0);
  std::string png(size, '\0');
  ASSERT_NE(png_image_write_to_memory(&image, png.data(), &size, 0, grey.data(), 0, nullptr), 0);
  for (const std::string& bytes : {png, std::string("P2 4 1 255\n254 0 # wall\n254 205\n")}) {
    const auto map = Read({{"maps/map.yaml", kYaml}, {"maps/map.pgm", bytes}});
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map.value().walls.size(), 2U);
  }
  // Behind its cells, a picture may be cut off.
  for (size_t cut = 0; cut < png.size(); ++cut) {
    const auto map = Read({{"maps/map.yaml", kYaml}, {"maps/map.pgm", png.substr(0, cut)}});
    EXPECT_TRUE(cut > png.size() / 2 || !map.ok()) << cut;
  }
}

TEST(OccupancyMap, WhatIsWrongIsSaid) {
  const auto message = [](const std::string& yaml, const std::string& image) {
    const auto map = Read({{"maps/map.yaml", yaml}, {"maps/map.pgm", image}});
    return map.ok() ? std::string("fine") : map.error().message;
  };
  const std::string image = Pgm(1, 1, "\xfe");
  EXPECT_EQ(message(kYaml, image), "fine");
  EXPECT_EQ(message("image: map.pgm\norigin: [0, 0, 0]\n", image),
            "cannot use the map `maps/map.yaml`: it has no `resolution`");
  EXPECT_EQ(message("image: map.pgm\nresolution: 0\norigin: [0, 0, 0]\n", image),
            "cannot use the map `maps/map.yaml`: `resolution` must be the side of a cell in metres");
  EXPECT_EQ(
      message("image: map.pgm\nresolution: 1\norigin: [0, 0, 1]\n", image),
      "cannot use the map `maps/map.yaml`: its `origin` is turned: only maps along the axes can be read");
  EXPECT_EQ(message(kYaml + "mode: tetra\n", image),
            "cannot use the map `maps/map.yaml`: its `mode` is `tetra`: none of trinary, scale, raw");
  EXPECT_NE(message("a: [", image).find("cannot use the map `maps/map.yaml`: yaml-cpp"), std::string::npos);
  EXPECT_EQ(message(kYaml, "GIF"), "cannot use the map `maps/map.pgm`: it is neither PGM nor PNG");
  EXPECT_EQ(message(kYaml, "P5 3 3 255\nab"), "cannot use the map `maps/map.pgm`: it is cut off");
  EXPECT_EQ(message(kYaml, "P5 -3 3 255\n"), "cannot use the map `maps/map.pgm`: its header is damaged");
  EXPECT_EQ(Read({}).error().message, "cannot use the map `maps/map.yaml`: no such file");
}

}  // namespace
}  // namespace rondo::sim
