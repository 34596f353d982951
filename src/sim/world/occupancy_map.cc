#include "sim/world/occupancy_map.h"

#include <fmt/format.h>
#include <png.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <sstream>

namespace rondo::sim {
namespace {

constexpr int kLargest = 20'000;  // rows or columns

/// Holds an image in shades of grey; rows from the top.
struct Image {
  int columns = 0;
  int rows = 0;
  std::vector<uint8_t> grey;
  std::vector<uint8_t> alpha;  ///< empty: opaque
};

// The next number of a PGM header; comments run to the end of their line.
int Next(std::istream& in) {
  while (in >> std::ws && in.peek() == '#') in.ignore(1 << 20, '\n');
  int value = -1;
  in >> value;
  return in ? value : -1;
}

base::Result<Image> ReadPgm(const std::string& bytes) {
  std::istringstream in(bytes.substr(2));
  Image image;
  image.columns = Next(in);
  image.rows = Next(in);
  const int most = Next(in);
  if (image.columns < 1 || image.rows < 1 || image.columns > kLargest || image.rows > kLargest || most < 1)
    return base::Error{"its header is damaged"};
  if (most > 255) return base::Error{"it has more than 256 shades"};
  const size_t cells = static_cast<size_t>(image.columns) * static_cast<size_t>(image.rows);
  if (cells > bytes.size()) return base::Error{"it is cut off"};
  image.grey.resize(cells);
  const bool text = bytes[1] == '2';
  if (!text) in.get();
  for (uint8_t& cell : image.grey) {
    const int value = text ? Next(in) : in.get();
    if (value > most) return base::Error{"a cell is brighter than its header allows"};
    if (value < 0 || !in) return base::Error{"it is cut off"};
    cell = static_cast<uint8_t>(std::lround(255.0 * value / most));
  }
  return image;
}

base::Result<Image> ReadPng(const std::string& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    return base::Error{std::string(png.message)};
  Image image;
  image.columns = static_cast<int>(png.width);
  image.rows = static_cast<int>(png.height);
  if (png.width > kLargest || png.height > kLargest) {
    png_image_free(&png);
    return base::Error{"it is larger than 20,000 cells"};
  }
  const bool alpha = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  png.format = PNG_FORMAT_RGBA;
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr) == 0)
    return base::Error{std::string(png.message)};
  for (size_t i = 0; i < pixels.size(); i += 4) {
    image.grey.push_back(
        static_cast<uint8_t>(std::lround((pixels[i] + pixels[i + 1] + pixels[i + 2]) / 3.0)));
    if (alpha) image.alpha.push_back(pixels[i + 3]);
  }
  return image;
}

base::Result<Image> ReadImage(const std::string& bytes) {
  if (bytes.starts_with("P5") || bytes.starts_with("P2")) return ReadPgm(bytes);
  if (bytes.starts_with("\x89PNG")) return ReadPng(bytes);
  return base::Error{"it is neither PGM nor PNG"};
}

/// Says how shades become occupancies.
struct Reading {
  std::string image;
  double resolution = 0;
  double origin[2] = {0, 0};
  bool negate = false;
  double occupied = 0.65;
  double free = 0.25;
  bool raw = false;
  bool scale = false;

  bool IsFree(const Image& picture, size_t cell) const {
    double shade = picture.grey[cell];
    const bool alpha = !picture.alpha.empty();
    if (scale && alpha && picture.alpha[cell] < 255) return false;
    // As the map server does: the opacity counts like a colour.
    if (!raw && !scale && alpha) shade = (3 * shade + picture.alpha[cell]) / 4;
    if (raw) return shade <= 100 && shade / 100 < free;
    return (negate ? shade : 255 - shade) / 255 < free;
  }
};

base::Result<Reading> ReadDescription(const std::string& text) {
  Reading reading;
  try {
    const YAML::Node yaml = YAML::Load(text);
    if (!yaml.IsMap()) return base::Error{"it is no description of a map"};
    for (const char* key : {"image", "resolution", "origin"}) {
      if (!yaml[key]) return base::Error{fmt::format("it has no `{}`", key)};
    }
    reading.image = yaml["image"].as<std::string>();
    reading.resolution = yaml["resolution"].as<double>();
    const auto origin = yaml["origin"].as<std::vector<double>>();
    if (origin.size() != 3 || !std::isfinite(origin[0]) || !std::isfinite(origin[1]))
      return base::Error{"`origin` must be [x, y, yaw]"};
    if (origin[2] != 0) return base::Error{"its `origin` is turned: only maps along the axes can be read"};
    reading.origin[0] = origin[0];
    reading.origin[1] = origin[1];
    if (yaml["negate"])
      reading.negate = yaml["negate"].as<std::string>() != "0" && yaml["negate"].as<std::string>() != "false";
    if (yaml["occupied_thresh"]) reading.occupied = yaml["occupied_thresh"].as<double>();
    if (yaml["free_thresh"]) reading.free = yaml["free_thresh"].as<double>();
    const auto mode = yaml["mode"] ? yaml["mode"].as<std::string>() : "trinary";
    if (mode != "trinary" && mode != "scale" && mode != "raw")
      return base::Error{fmt::format("its `mode` is `{}`: none of trinary, scale, raw", mode)};
    reading.raw = mode == "raw";
    reading.scale = mode == "scale";
  } catch (const YAML::Exception& e) {
    return base::Error{e.what()};
  }
  if (!(reading.resolution > 1e-4 && reading.resolution < 1e3))
    return base::Error{"`resolution` must be the side of a cell in metres"};
  if (!(reading.free >= 0 && reading.free <= reading.occupied && reading.occupied <= 1))
    return base::Error{"0 <= `free_thresh` <= `occupied_thresh` <= 1 must hold"};
  return reading;
}

// Runs of cells in a row; a run that is like one of the row before makes its rectangle higher.
std::vector<Rectangle> Walls(const Image& image, const Reading& reading) {
  struct Run {
    int from, to;  // columns, half-open
    size_t rectangle;
  };
  std::vector<Rectangle> walls;
  std::vector<Run> above;
  for (int row = 0; row < image.rows; ++row) {
    const double high = reading.origin[1] + reading.resolution * (image.rows - row);
    const double low = reading.origin[1] + reading.resolution * (image.rows - row - 1);
    std::vector<Run> runs;
    const size_t first = static_cast<size_t>(row) * static_cast<size_t>(image.columns);
    for (int c = 0; c < image.columns;) {
      if (reading.IsFree(image, first + static_cast<size_t>(c))) {
        ++c;
        continue;
      }
      Run run{c, c, walls.size()};
      while (run.to < image.columns && !reading.IsFree(image, first + static_cast<size_t>(run.to))) ++run.to;
      c = run.to;
      bool grown = false;
      for (const Run& a : above) {
        if (a.from != run.from || a.to != run.to) continue;
        run.rectangle = a.rectangle;
        walls[a.rectangle].low[1] = low;
        grown = true;
      }
      if (!grown) {
        walls.push_back({{reading.origin[0] + reading.resolution * run.from, low},
                         {reading.origin[0] + reading.resolution * run.to, high}});
      }
      runs.push_back(run);
    }
    above = std::move(runs);
  }
  return walls;
}

}  // namespace

base::Result<OccupancyMap> ReadOccupancyMap(
    const std::string& path, const std::function<base::Result<std::string>(const std::string&)>& read) {
  if (!read) return base::Error{"maps in files cannot be used here"};
  const auto fail = [&](const std::string& file, const std::string& why) {
    return base::Error{fmt::format("cannot use the map `{}`: {}", file, why)};
  };
  const auto text = read(path);
  if (!text.ok()) return fail(path, text.error().message);
  const auto reading = ReadDescription(text.value());
  if (!reading.ok()) return fail(path, reading.error().message);
  const std::string file =
      (std::filesystem::path(path).parent_path() / reading.value().image).lexically_normal().string();
  const auto bytes = read(file);
  if (!bytes.ok()) return fail(file, bytes.error().message);
  const auto image = ReadImage(bytes.value());
  if (!image.ok()) return fail(file, image.error().message);
  const Reading& r = reading.value();
  OccupancyMap map;
  map.walls = Walls(image.value(), r);
  for (size_t i = 0; i < 2; ++i) map.low[i] = r.origin[i];
  map.high[0] = r.origin[0] + r.resolution * image.value().columns;
  map.high[1] = r.origin[1] + r.resolution * image.value().rows;
  return map;
}

}  // namespace rondo::sim
