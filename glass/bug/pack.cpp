// gzip streams (RFC 1952): their sum and length are zlib's to make and to check.
#include "glass/bug/pack.h"

#include <zlib.h>

#include <algorithm>
#include <climits>
#include <new>
#include <stdexcept>

namespace vitrine::glass::bug {
namespace {

constexpr int kGzip = 15 + 16;  ///< the largest window, with gzip's header
constexpr std::size_t kChunk = std::size_t{256} << 10;
/// Captures are large and seldom: speed counts more than the last percent.
constexpr int kLevel = 3;

/// Feeds all of `input` to zlib's `step`, in turns that its counts of 32 bits can name; what comes out is appended.
/// The last answer of `step`.
template <class Step>
int run(z_stream& z, std::string_view input, std::string& output, Step step) {
  int answer = Z_OK;
  do {
    if (z.avail_in == 0) {
      const std::size_t taken = std::min<std::size_t>(input.size(), UINT_MAX / 2);
      z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data()));
      z.avail_in = static_cast<uInt>(taken);
      input.remove_prefix(taken);
    }
    const std::size_t before = output.size();
    output.resize(before + kChunk);
    z.next_out = reinterpret_cast<Bytef*>(output.data() + before);
    z.avail_out = static_cast<uInt>(kChunk);
    answer = step(input.empty());
    output.resize(before + kChunk - z.avail_out);
  } while (answer == Z_OK && (z.avail_in != 0 || !input.empty() || z.avail_out == 0));
  if (answer == Z_STREAM_END && (z.avail_in != 0 || !input.empty())) return Z_DATA_ERROR;
  return answer;
}

}  // namespace

std::string pack(std::string_view bytes) {
  z_stream z{};
  if (deflateInit2(&z, kLevel, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string out;
  int answer = Z_OK;
  try {
    answer = run(z, bytes, out, [&](bool last) { return deflate(&z, last ? Z_FINISH : Z_NO_FLUSH); });
  } catch (...) {
    deflateEnd(&z);
    throw;
  }
  deflateEnd(&z);
  if (answer != Z_STREAM_END) throw std::bad_alloc();
  return out;
}

base::Result<std::string> unpack(std::string_view stream) {
  z_stream z{};
  if (inflateInit2(&z, kGzip) != Z_OK) throw std::bad_alloc();
  std::string out;
  int answer = Z_OK;
  try {
    answer = run(z, stream, out, [&](bool) { return inflate(&z, Z_NO_FLUSH); });
  } catch (...) {
    inflateEnd(&z);
    throw;
  }
  inflateEnd(&z);
  if (answer == Z_STREAM_END) return out;
  if (answer == Z_MEM_ERROR) throw std::bad_alloc();
  return base::Error{answer == Z_DATA_ERROR ? "it is no bug file, or was altered" : "it ends too early"};
}

}  // namespace vitrine::glass::bug
