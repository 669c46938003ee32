// See digest.h. A line a command: what it was, and the allocations that have changed since the line before, by number.
#include "glass/digest.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "base/shake.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace {

using Json = nlohmann::ordered_json;

struct Allocation {
  std::uint64_t number, size;
  std::uint64_t digest;  ///< as it was told last
};

/// Four lanes, so that it goes as fast as memory does.
std::uint64_t digest_of(const std::byte* data, std::uint64_t size) {
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u;
  std::uint64_t lanes[4] = {1, 2, 3, 4}, at = 0;
  for (; size - at >= sizeof lanes; at += sizeof lanes) {
    std::uint64_t words[4];
    std::memcpy(words, data + at, sizeof words);
    for (int i = 0; i < 4; ++i) {
      lanes[i] = (lanes[i] ^ words[i]) * kFactor;
      lanes[i] ^= lanes[i] >> 29;
    }
  }
  std::uint64_t digest = base::mix(base::mix(lanes[0], lanes[1]), base::mix(lanes[2], lanes[3]));
  for (; at < size; ++at) digest = base::mix(digest, std::to_integer<std::uint64_t>(data[at]));
  return digest;
}

std::string hexadecimal(std::uint64_t digest) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest));
  return text;
}

/// "SUBMISSION:COMMAND:ALLOCATION:OFFSET".
struct Stop {
  unsigned long long submission = 0, allocation = 0, offset = 0;
  unsigned command = 0;
  static Stop asked_for() {
    Stop stop;
    const char* text = std::getenv("VITRINE_DIGEST_AT");
    const int numbers = text == nullptr ? 0
                                        : std::sscanf(text, "%llu:%u:%llu:%llu", &stop.submission, &stop.command,
                                                      &stop.allocation, &stop.offset);
    return numbers < 3 ? Stop{} : stop;
  }
};

std::optional<Difference> difference_of(const std::byte* data, std::uint64_t size, const std::string& other) {
  Difference found;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(size, other.size()); ++i) {
    if (data[i] == static_cast<std::byte>(other[i])) continue;
    if (found.differing++ != 0) continue;
    found.offset = i / 4 * 4;
    found.at = data + found.offset;
    for (std::uint64_t b = 0; b < 4 && found.offset + b < std::min<std::uint64_t>(size, other.size()); ++b) {
      found.here[b] = std::to_integer<std::uint8_t>(data[found.offset + b]);
      found.there[b] = static_cast<std::uint8_t>(other[found.offset + b]);
    }
  }
  if (found.differing == 0) return std::nullopt;
  return found;
}

class Digests {
 public:
  void add(const std::byte* data, std::uint64_t size) {
    const std::lock_guard lock(mutex_);
    live_[data] = {++allocations_, size, 0};
  }

  void remove(const std::byte* data) {
    const std::lock_guard lock(mutex_);
    live_.erase(data);
  }

  std::optional<Difference> command(const Address& point) {
    const std::lock_guard lock(mutex_);
    Json memory = Json::object();
    std::map<std::uint64_t, std::string> changed;
    for (auto& [data, allocation] : live_) {
      const std::uint64_t digest = digest_of(data, allocation.size);
      if (std::exchange(allocation.digest, digest) != digest) changed[allocation.number] = hexadecimal(digest);
    }
    for (const auto& [number, digest] : changed) memory[std::to_string(number)] = digest;
    Json line{{"submission", point.submission}, {"command", point.command},   {"name", point.command_name},
              {"labels", point.labels},         {"pipeline", point.pipeline}, {"memory", std::move(memory)}};
    std::optional<Difference> difference;
    if (point.submission == stop_.submission && point.command == stop_.command) difference = stop_here();
    if (difference) line["differs"] = difference->offset;
    lines_ += line.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
    return difference;
  }

  std::optional<DigestWord> word(std::uint64_t submission, std::uint32_t command) const {
    if (submission != stop_.submission || command != stop_.command) return std::nullopt;
    const std::lock_guard lock(mutex_);
    for (const auto& [data, allocation] : live_)
      if (allocation.number == stop_.allocation && stop_.offset < allocation.size)
        return DigestWord{data + stop_.offset};
    return std::nullopt;
  }

  std::string lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  std::optional<Difference> stop_here() {
    for (const auto& [data, allocation] : live_) {
      if (allocation.number != stop_.allocation) continue;
      if (std::getenv("VITRINE_DIGEST_SAVE") != nullptr)
        write_output("VITRINE_DIGEST_SAVE", "", {reinterpret_cast<const char*>(data), allocation.size});
      const char* other = std::getenv("VITRINE_DIGEST_COMPARE");
      if (other == nullptr) continue;
      std::ifstream file(other, std::ios::binary);
      if (!file) complain(std::string("cannot read ") + other);
      return difference_of(data, allocation.size, {std::istreambuf_iterator<char>(file), {}});
    }
    return std::nullopt;
  }

  mutable std::mutex mutex_;
  const Stop stop_ = Stop::asked_for();
  std::map<const std::byte*, Allocation> live_;
  std::uint64_t allocations_ = 0;
  std::string lines_;
};

/// Of the process, once somebody has asked; lives until its end.
std::atomic<Digests*> asked_for{nullptr};
std::mutex findings_mutex;
std::vector<Finding> findings;

std::string bytes_of(const std::array<std::uint8_t, 4>& bytes) {
  char text[16];
  std::snprintf(text, sizeof text, "%02x %02x %02x %02x", bytes[0], bytes[1], bytes[2], bytes[3]);
  return text;
}

/// Watches no shader and no draw.
class DigestTool : public Tool {
 public:
  DigestTool() {
    if (!asked_for.load()) asked_for = new Digests;
  }
  spirv::exec::Interest interest() const override { return {}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program&) override { return nullptr; }
  std::vector<Finding> take_findings() override {
    const std::lock_guard lock(findings_mutex);
    return std::exchange(findings, {});
  }
  void write() override { write_output("VITRINE_DIGEST", "digest.jsonl", asked_for.load()->lines()); }
};

}  // namespace

bool has_digest() { return asked_for.load(std::memory_order_relaxed) != nullptr; }

void add_digested(const std::byte* data, std::uint64_t size) noexcept {
  Digests* digests = asked_for.load();
  if (!digests) return;
  try {
    digests->add(data, size);
  } catch (const std::bad_alloc&) {
    // Left out.
  }
}

void remove_digested(const std::byte* data) noexcept {
  if (Digests* digests = asked_for.load()) digests->remove(data);
}

std::optional<Difference> digest_command(const Address& point) { return asked_for.load()->command(point); }

std::optional<DigestWord> watched_word(std::uint64_t submission, std::uint32_t command) {
  const Digests* const digests = asked_for.load();
  return digests ? digests->word(submission, command) : std::nullopt;
}

void report_difference(const Address& point, const Difference& difference, const std::string& what) {
  Finding finding;
  finding.rule = &rule("order-dependent");
  finding.message = "another order of invocations leaves other bytes: " + bytes_of(difference.here) + " here, " +
                    bytes_of(difference.there) + " there, of " + what;
  finding.count = difference.differing;
  finding.address = point;
  const std::lock_guard lock(findings_mutex);
  findings.push_back(std::move(finding));
}

std::unique_ptr<Tool> make_digest() { return std::make_unique<DigestTool>(); }

}  // namespace vitrine::glass
