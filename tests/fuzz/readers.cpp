// See readers.h.
#include "tests/fuzz/readers.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "glass/bug/amber.h"
#include "glass/bug/file.h"
#include "glass/bug/pack.h"
#include "glass/cli/counters.h"
#include "glass/cli/debug_adapter.h"
#include "glass/cli/digests.h"
#include "glass/cli/findings.h"
#include "glass/cli/tracefiles.h"
#include "glass/debug/breakpoint.h"
#include "glass/debug/expression.h"
#include "glass/debug/requests.h"
#include "glass/report/report.h"
#include "tests/fuzz/target.h"
#include "texel/block/block.h"
#include "texel/format.h"

namespace vitrine::fuzz {
namespace {

[[noreturn]] void wrong(const char* what) {
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

/// The first byte chooses the format, the rest are blocks: all texels at once, and one by one, as values and as bytes.
bool read_blocks(std::string_view bytes) {
  constexpr VkFormat kFirst = VK_FORMAT_BC1_RGB_UNORM_BLOCK, kLast = VK_FORMAT_ASTC_12x12_SRGB_BLOCK;
  if (bytes.empty()) return false;
  const auto number = static_cast<int>(static_cast<unsigned char>(bytes[0])) % (kLast - kFirst + 1);
  const texel::FormatDesc& format = texel::format_desc(static_cast<VkFormat>(kFirst + number));
  bytes.remove_prefix(1);
  for (; bytes.size() >= format.block_bytes; bytes.remove_prefix(format.block_bytes)) {
    // Of its own size, so that a sanitizer sees who reads on.
    const std::vector<std::byte> block(reinterpret_cast<const std::byte*>(bytes.data()),
                                       reinterpret_cast<const std::byte*>(bytes.data()) + format.block_bytes);
    const std::uint32_t width = format.block_width, texels = width * format.block_height;
    std::vector<texel::Texel> all(texels);
    std::vector<std::uint32_t> words(texels);
    texel::decode_block_texels(format, block.data(), all.data());
    const bool whole_bytes = texels == 16;
    if (whole_bytes) texel::decode_block_bytes(format, block.data(), words.data());
    for (std::uint32_t i = 0; i < texels; ++i) {
      texel::Texel one;
      texel::decode_block_texel(format, block.data(), i % width, i / width, one);
      if (one != all[i]) wrong("a texel of a block differs from the block's");
      if (!whole_bytes) continue;
      std::array<std::uint8_t, 4> single{};
      texel::decode_block_bytes(format, block.data(), i % width, i / width, single);
      std::uint32_t word;
      std::memcpy(&word, single.data(), sizeof word);
      if (word != words[i]) wrong("bytes of a texel differ from the block's");
    }
  }
  return true;
}

bool read_tracefile(std::string_view bytes) {
  glass::Coverage coverage;
  std::string error, written;
  if (!glass::cli::add_tracefile(bytes, coverage, error)) return false;
  glass::cli::summary_of(coverage);
  // Names that lines cannot have are written as others; those stay.
  for (int round = 0; round < 2; ++round) {
    const std::string text = glass::to_lcov(coverage);
    if (round == 1 && text != written) wrong("a tracefile is written in two ways");
    glass::Coverage again;
    if (!glass::cli::add_tracefile(text, again, error)) wrong("a tracefile that was written is not read");
    written = glass::to_lcov(again);
    coverage = std::move(again);
  }
  return true;
}

bool read_report(std::string_view bytes) {
  std::vector<glass::Finding> findings;
  std::string error;
  if (!glass::cli::read_findings(bytes, findings, error)) return false;
  const std::string text = glass::to_report(glass::ReportFormat::kJson, findings);
  std::vector<glass::Finding> again;
  if (!glass::cli::read_findings(text, again, error)) wrong("a report that was written is not read");
  if (glass::to_report(glass::ReportFormat::kJson, again) != text) wrong("a report is written in two ways");
  glass::to_report(glass::ReportFormat::kSarif, findings);
  glass::to_report(glass::ReportFormat::kText, glass::cli::folded(std::move(findings)));
  return true;
}

bool read_counter_files(std::string_view bytes) {
  const auto sum = glass::cli::sum_of_counters(bytes, bytes);
  if (!sum) return false;
  const auto once = glass::cli::read_counters(bytes), twice = glass::cli::read_counters(*sum);
  if (!once || !twice) return false;
  glass::cli::dearest_shaders(*once);
  glass::cli::names_in_group(*once, "pipelines");
  glass::cli::annotated_sources(bytes);
  glass::cli::changes(*once, *twice, "*");
  return true;
}

bool read_digest_files(std::string_view bytes) {
  const auto digests = glass::cli::read_digests(bytes);
  if (!digests) return false;
  if (glass::cli::first_parting(*digests, *digests)) wrong("digests part from themselves");
  return true;
}

/// What is in a bug file's stream; what is taken is written again, and read again.
bool read_bug(std::string_view bytes) {
  const base::Result<glass::bug::Bug> bug = glass::bug::from_file(glass::bug::pack(bytes));
  if (!bug) return false;
  glass::bug::describe(bug.value());
  const base::Result<std::string> script = glass::bug::to_amber(bug.value());
  const std::string file = glass::bug::to_file(bug.value());
  const base::Result<glass::bug::Bug> again = glass::bug::from_file(file);
  if (!again) wrong("a bug file that was written is not read");
  if (glass::bug::to_file(again.value()) != file) wrong("a bug file is written in two ways");
  return script.ok();
}

/// The file itself.
bool read_bug_stream(std::string_view bytes) { return glass::bug::from_file(bytes).ok(); }

bool read_expression(std::string_view bytes) {
  const bool read = glass::debug::Expression::read(bytes).ok();
  base::Result<glass::debug::Breakpoint> breakpoint = glass::debug::parse_breakpoint(bytes);
  if (breakpoint.ok()) glass::debug::to_text(breakpoint.value());
  return read || breakpoint.ok();
}

/// An editor that says anything to an adapter whose application has not started.
bool read_protocol(std::string_view bytes) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) return false;
  glass::cli::DapWire wire(ends[0]);
  glass::cli::DebugAdapter adapter(wire);
  bool taken = false;
  for (bool stays = true; stays && !bytes.empty() && !wire.broken();) {
    const std::size_t part = std::min<std::size_t>(bytes.size(), 4096);
    if (::write(ends[1], bytes.data(), part) != static_cast<ssize_t>(part) || !wire.fill()) break;
    bytes.remove_prefix(part);
    while (const std::optional<nlohmann::json> message = wire.next()) {
      taken = true;
      if (!(stays = adapter.take(*message))) break;
      char answers[4096];
      while (::read(ends[1], answers, sizeof answers) > 0) {
      }
    }
  }
  ::close(ends[1]);
  return taken;
}

/// Nobody: requests to a debugger whose shaders have not begun.
class Nobody : public glass::debug::Face {
 public:
  void stopped(glass::debug::Engine&, const glass::debug::Stop&, std::unique_lock<std::mutex>&) override {}
  void output(const std::string&) override {}
};

bool read_request(std::string_view bytes) {
  Nobody nobody;
  glass::debug::Engine engine(nobody);
  bool any = false;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string answer = glass::debug::answer_to(engine, std::string(bytes.substr(0, end)), true);
    any |= answer.find("\"error\"") == std::string::npos;
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
  return any;
}

constexpr bool (*kReaders[])(std::string_view) = {
    read_blocks, read_tracefile,  read_report,     read_counter_files, read_digest_files,
    read_bug,    read_bug_stream, read_expression, read_protocol,      read_request};

}  // namespace

bool read_input(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return false;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return kReaders[bytes[0] % std::size(kReaders)](text.substr(1));
}

}  // namespace vitrine::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vitrine::fuzz::read_input({data, size});
  return 0;
}
