#include "io/file/Decompress.h"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>

#include <polemcl/core/common/Types.h>
#include "io/file/ReadLimits.h"

namespace polemcl::io {
namespace {

constexpr std::uint64_t kFirstDecoded = 1 << 16;

/// What a decoder took and gave in one call.
struct DecodeStep {
  std::size_t in = 0, out = 0;
  bool failed = false, frameEnded = false;
};

/// Calls `decode(data, out, outSize)`, which returns a DecodeStep, until all data are decoded.
template <class Decode>
std::string growing(std::string_view data, std::uint64_t most, const std::string& where,
                    Decode decode) {
  std::string result;
  std::size_t used = 0;
  DecodeStep step;
  while (!step.frameEnded || !data.empty()) {
    // One byte more than allowed, to notice what goes beyond.
    if (used == result.size())
      result.resize(std::min<std::uint64_t>(most + 1, std::max(kFirstDecoded, 2 * result.size())));
    step = decode(data, result.data() + used, result.size() - used);
    if (step.failed || (step.in == 0 && step.out == 0 && !step.frameEnded))
      throw Error(where + "damaged: it cannot be decompressed");
    data.remove_prefix(step.in);
    used += step.out;
    if (used > most)
      throw Error(where + "damaged: it decompresses to more than " + std::to_string(most) +
                  " bytes");
  }
  result.resize(used);
  return result;
}

}  // namespace

std::string decompressedZstd(std::string_view data, std::uint64_t most, const std::string& where) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             &ZSTD_freeDStream);
  if (!stream) throw Error(where + "out of memory");
  return growing(data, most, where, [&](std::string_view in, char* out, std::size_t size) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, size, 0};
    const std::size_t left = ZSTD_decompressStream(stream.get(), &output, &input);
    return DecodeStep{input.pos, output.pos, ZSTD_isError(left) != 0, left == 0};
  });
}

std::string decompressedLz4(std::string_view data, std::uint64_t most, const std::string& where) {
  LZ4F_dctx* handle = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&handle, LZ4F_VERSION)))
    throw Error(where + "out of memory");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
      handle, &LZ4F_freeDecompressionContext);
  return growing(data, most, where, [&](std::string_view in, char* out, std::size_t size) {
    DecodeStep step{in.size(), size, false, false};
    const std::size_t left = LZ4F_decompress(handle, out, &step.out, in.data(), &step.in, nullptr);
    step.failed = LZ4F_isError(left) != 0;
    step.frameEnded = left == 0;
    return step;
  });
}

std::string inflated(std::string_view data, std::uint64_t size, const std::string& where) {
  if (size > mostInflated(data.size()))
    throw Error(where + "damaged: " + std::to_string(data.size()) + " bytes cannot hold " +
                std::to_string(size) + " of numbers");
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw Error(where + "out of memory");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, &inflateEnd);
  const auto piece = [](std::size_t bytes) {
    return static_cast<uInt>(std::min<std::size_t>(bytes, std::numeric_limits<uInt>::max()));
  };
  std::string result =
      growing(data, size, where, [&](std::string_view in, char* out, std::size_t room) {
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
        stream.avail_in = piece(in.size());
        stream.next_out = reinterpret_cast<Bytef*>(out);
        stream.avail_out = piece(room);
        const uInt inBefore = stream.avail_in, outBefore = stream.avail_out;
        const int code = inflate(&stream, Z_NO_FLUSH);
        DecodeStep step{inBefore - stream.avail_in, outBefore - stream.avail_out};
        step.frameEnded = code == Z_STREAM_END;
        step.failed =
            (code != Z_OK && !step.frameEnded) || (step.frameEnded && step.in < in.size());
        return step;
      });
  if (result.size() != size) throw Error(where + "damaged: it cannot be decompressed");
  return result;
}

}  // namespace polemcl::io
