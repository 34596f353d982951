#include "runs/view_page.h"

#include <zlib.h>

#include <algorithm>

#include "base/xml.h"
#include "runs/base64.h"

namespace rondo::runs {

namespace {

// As gzip, without a time: the same trace makes the same page.
base::Result<std::string> Packed(std::string_view bytes) {
  constexpr int kGzip = 16 + MAX_WBITS, kMemory = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    return base::Error{"the trace cannot be packed"};
  std::string packed;
  std::string piece(size_t{1} << 16, '\0');
  int state = Z_OK;
  while (state == Z_OK) {
    if (stream.avail_in == 0 && !bytes.empty()) {
      constexpr size_t kMost = size_t{1} << 30;
      const std::string_view next = bytes.substr(0, kMost);
      bytes.remove_prefix(next.size());
      stream.next_in =
          reinterpret_cast<Bytef*>(const_cast<char*>(next.data()));  // NOLINT: zlib does not write
      stream.avail_in = static_cast<uInt>(next.size());
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    state = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    packed.append(piece, 0, piece.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  if (state != Z_STREAM_END) return base::Error{"the trace cannot be packed"};
  return packed;
}

}  // namespace

base::Result<std::string> PageOf(std::string_view name, std::string_view trace) {
  constexpr std::string_view kHere = "<!--rondo-data-->";
  const std::string_view page = ViewerPage();
  const size_t at = page.find(kHere);
  if (at == std::string_view::npos)
    return base::Error{"Rondo was built without the viewer: it needs node and the packages of `./dev setup`"};
  const auto packed = Packed(trace);
  if (!packed.ok()) return packed.error();
  std::string out(page.substr(0, at));
  out += "<script type=\"application/octet-stream\" id=\"rondo-data\" data-name=\"" + base::XmlEscaped(name) +
         "\">";
  out += ToBase64(packed.value());
  out += "</script>";
  out += page.substr(at + kHere.size());
  return out;
}

}  // namespace rondo::runs
