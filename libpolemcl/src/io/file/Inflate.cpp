#include "io/file/Inflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include <polemcl/core/common/Types.h>
#include "io/file/ReadLimits.h"

namespace polemcl::io {
namespace {

constexpr std::uint64_t kFirstBlock = 1 << 16;

/// Calls inflateEnd() for inflateInit().
struct Stream : z_stream {
  Stream() : z_stream() {}
  ~Stream() { inflateEnd(this); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

uInt piece(std::uint64_t bytes) {
  return static_cast<uInt>(std::min<std::uint64_t>(bytes, std::numeric_limits<uInt>::max()));
}

}  // namespace

std::string inflated(std::string_view data, std::uint64_t size, const std::string& where) {
  if (size > mostInflated(data.size()))
    throw Error(where + "damaged: " + std::to_string(data.size()) + " bytes cannot hold " +
                std::to_string(size) + " of numbers");
  Stream stream;
  if (inflateInit(&stream) != Z_OK) throw Error(where + "out of memory");
  std::string result;
  std::size_t used = 0, taken = 0;
  int code = Z_OK;
  while (code == Z_OK) {
    // One byte more than claimed, to detect data beyond the claimed size.
    if (used == result.size())
      result.resize(std::min<std::uint64_t>(size + 1, std::max(kFirstBlock, 2 * result.size())));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data())) + taken;
    stream.avail_in = piece(data.size() - taken);
    stream.next_out = reinterpret_cast<Bytef*>(result.data()) + used;
    stream.avail_out = piece(result.size() - used);
    const uInt in = stream.avail_in, out = stream.avail_out;
    code = inflate(&stream, Z_NO_FLUSH);
    taken += in - stream.avail_in;
    used += out - stream.avail_out;
    if (used > size) break;
  }
  if (code != Z_STREAM_END || used != size || taken != data.size())
    throw Error(where + "damaged: it cannot be decompressed");
  result.resize(size);
  return result;
}

}  // namespace polemcl::io
