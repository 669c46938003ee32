// See capture.h. The tool `capture` watches no shader: it is there so that commands have numbers and names.
#include "glass/bug/capture.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "base/words.h"
#include "glass/bug/file.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass::bug {
namespace {

/// Of one submission, for those who do not know yet which command they want.
constexpr std::uint64_t kMostBytes = std::uint64_t{2} << 30;

std::atomic<Captures*> asked_for{nullptr};

/// "2:7".
bool read_command(std::string_view word, Request& request) {
  unsigned long long submission = 0;
  unsigned command = 0;
  int end = 0;
  const std::string text(word);
  if (std::sscanf(text.c_str(), "%llu:%u%n", &submission, &command, &end) != 2) return false;
  if (static_cast<std::size_t>(end) != text.size() || text[0] == '-' || text[0] == '+') return false;
  request.commands.emplace(submission, command);
  return true;
}

void replace(std::string& text, std::string_view what, std::uint64_t number) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
    text.replace(at, what.size(), std::to_string(number));
}

std::uint64_t bytes_of(const Bug& bug) {
  std::uint64_t bytes = 0;
  for (const Memory& memory : bug.memories)
    for (const Piece& piece : memory.pieces) bytes += size_of(piece.before) + size_of(piece.after);
  for (const Image& image : bug.images)
    for (const Texels& texels : image.texels) bytes += size_of(texels.before) + size_of(texels.after);
  return bytes;
}

class CaptureTool : public Tool {
 public:
  CaptureTool() {
    if (asked_for.load()) return;
    const char* text = std::getenv("VITRINE_CAPTURE");
    Request request = parse_request(text != nullptr && *text != 0 ? text : "finding,lost");
    for (const std::string& word : request.unknown)
      complain("VITRINE_CAPTURE: '" + word + "' is no command (SUBMISSION:COMMAND), nor 'finding', 'lost' or 'all'");
    asked_for = new Captures(std::move(request));
  }
  spirv::exec::Interest interest() const override { return {}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program&) override { return nullptr; }
  bool needs_every_fragment() const override { return false; }
};

}  // namespace

Request parse_request(const char* text) {
  Request request;
  base::for_each_word(text, [&](std::string_view word) {
    if (word == "all") {
      request.all = true;
    } else if (word == "finding") {
      request.findings = true;
    } else if (word == "lost") {
      request.losses = true;
    } else if (!read_command(word, request)) {
      request.unknown.emplace_back(word);
    }
  });
  return request;
}

void Captures::begin(const void* owner, std::unique_ptr<Bug> bug) {
  const std::lock_guard lock(mutex_);
  Owned& owned = owners_[owner];
  // Who wants a lost device alone needs the last one alone.
  if (!request_.findings) std::erase_if(owned.kept, [&](const auto& kept) { return !is_wanted(*kept); });
  owned.kept.push_back(std::move(bug));
  owned.running = true;
}

void Captures::done(const void* owner) {
  const std::lock_guard lock(mutex_);
  Owned& owned = owners_[owner];
  owned.running = false;
  owned.bytes += bytes_of(*owned.kept.back());
  const Bug& last = *owned.kept.back();
  if (owned.bytes <= kMostBytes || is_wanted(last)) return;
  if (refused_.insert("full").second)
    complain("submission " + std::to_string(last.submission) + " from command " + std::to_string(last.command_number) +
             " on: too much memory to keep every command; name one in VITRINE_CAPTURE");
  owned.kept.pop_back();
}

void Captures::found(const void* owner, const Finding& finding) {
  if (finding.rule->severity == Severity::kNote) return;
  const std::lock_guard lock(mutex_);
  for (const auto& bug : owners_[owner].kept) {
    if (bug->submission != finding.address.submission || bug->command_number != finding.address.command) continue;
    const Frame place = finding.address.frames.empty() ? Frame{} : finding.address.frames.front();
    bug->findings.push_back({finding.rule->id, finding.message, to_text(place), place.function});
  }
}

void Captures::lost(const void* owner, const std::string& reason) noexcept {
  try {
    const std::lock_guard lock(mutex_);
    Owned& owned = owners_[owner];
    if (!owned.running) return;
    Bug& bug = *owned.kept.back();
    bug.lost = true;
    bug.findings.push_back({"device-lost", reason, {}, {}});
    owned.loss = to_file(bug);
  } catch (const std::bad_alloc&) {
    complain("the command that lost the device is not captured: no memory");
  }
}

bool Captures::is_wanted(const Bug& bug) const {
  if (request_.all || request_.commands.contains({bug.submission, bug.command_number})) return true;
  return bug.lost ? request_.losses : request_.findings && !bug.findings.empty();
}

void Captures::write(const Bug& bug, const std::string& contents) {
  std::string name = output_name("VITRINE_CAPTURE_FILE", "bug-%s-%c.vitrine");
  replace(name, "%s", bug.submission);
  replace(name, "%c", bug.command_number);
  replace(name, "%n", ++files_);
  // Of a name without numbers the first one.
  if (written_.insert(name).second) write_named(name, contents);
}

void Captures::end_submission(const void* owner) noexcept {
  try {
    const std::lock_guard lock(mutex_);
    Owned& owned = owners_[owner];
    const std::vector<std::unique_ptr<Bug>> kept = std::exchange(owned.kept, {});
    owned.running = false;
    owned.bytes = 0;
    for (const auto& bug : kept)
      if (is_wanted(*bug)) write(*bug, bug->lost && !owned.loss.empty() ? owned.loss : to_file(*bug));
  } catch (const std::bad_alloc&) {
    complain("VITRINE_CAPTURE: no memory for a file");
  }
}

void Captures::refuse(std::uint64_t submission, std::uint32_t command, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (!refused_.insert(reason).second) return;
  complain("submission " + std::to_string(submission) + ", command " + std::to_string(command) +
           " cannot be captured: " + reason);
}

std::string Captures::file_of_loss(const void* owner) const {
  const std::lock_guard lock(mutex_);
  const auto at = owners_.find(owner);
  return at == owners_.end() ? std::string() : at->second.loss;
}

Captures* captures() { return asked_for.load(std::memory_order_relaxed); }

}  // namespace vitrine::glass::bug

namespace vitrine::glass {

std::unique_ptr<Tool> make_capture() { return std::make_unique<bug::CaptureTool>(); }

}  // namespace vitrine::glass
