// The program vitrine-replay: an ordinary Vulkan application that runs the one draw or dispatch of a bug file and holds
// what it leaves in memory against the file. `vitrine replay` starts it on this driver, with or without tools; by
// itself it runs on whatever driver the loader finds.
//
//   vitrine-replay FILE [NEW]    NEW: the same file with what memory held here afterwards
//
// Exit code 0: the same bytes, or the device was lost as it was; 1: other bytes; 2: it could not run.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>

#include "glass/bug/file.h"
#include "glass/replayer/record.h"

namespace vitrine::glass::replayer {
namespace {

enum ExitCode : int { kSame = 0, kDiffers = 1, kCouldNotRun = 2 };

std::optional<std::string> read(const char* name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

bool write(const char* name, const std::string& contents) {
  std::ofstream file(name, std::ios::binary | std::ios::trunc);
  file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
  return file.good();
}

/// What a piece of memory or texels belong to, in words.
std::string name_of(const std::string& kind, std::size_t number, const std::string& name) {
  return kind + (name.empty() ? " " + std::to_string(number) : " '" + name + "'");
}

/// Bytes that differ from those expected.
struct Difference {
  std::uint64_t first = 0, count = 0;
};

Difference compare(const std::byte* here, const bug::Bytes& expected) {
  Difference d;
  if (expected.empty() || std::memcmp(here, expected.data(), expected.size()) == 0) return d;
  for (std::uint64_t i = 0; i < expected.size(); ++i)
    if (here[i] != expected[i] && d.count++ == 0) d.first = i;
  return d;
}

/// Says where memory differs; the number of places.
class Comparison {
 public:
  explicit Comparison(const Staging& staging) : staging_(staging) {}

  template <class Content>
  void look(const Content& content, const std::string& what, std::uint64_t offset) {
    const bug::Blob& expected = content.after ? content.after : content.before;
    const Difference d = compare(staging_.bytes + at_, *expected);
    if (d.count != 0) {
      ++places_;
      std::fprintf(stdout, "%s differs: %llu of %zu bytes, the first at offset %llu: %02x here, %02x in the file\n",
                   what.c_str(), static_cast<unsigned long long>(d.count), expected->size(),
                   static_cast<unsigned long long>(offset + d.first),
                   static_cast<unsigned>(staging_.bytes[at_ + d.first]), static_cast<unsigned>((*expected)[d.first]));
    }
    bytes_ += expected->size();
    written_ += content.after != nullptr;
    at_ = (at_ + content.before->size() + 15) / 16 * 16;
  }

  int summarize() const {
    if (places_ == 0)
      std::fprintf(stdout, "the same bytes as when it was captured: %llu, of which the command changed %s\n",
                   static_cast<unsigned long long>(bytes_), written_ ? "some" : "none");
    return places_ == 0 ? kSame : kDiffers;
  }

 private:
  const Staging& staging_;
  std::uint64_t at_ = 0, bytes_ = 0;
  std::size_t places_ = 0, written_ = 0;
};

/// The name of a buffer that has this byte of the memory.
std::string owner_of(const bug::Bug& bug, std::size_t memory, const bug::Piece& piece, std::uint64_t& offset) {
  for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
    const bug::Buffer& b = bug.buffers[i];
    if (b.memory != memory || piece.offset < b.offset || piece.offset - b.offset >= b.size) continue;
    offset = piece.offset - b.offset;
    return name_of("buffer", i, b.name);
  }
  return "memory";
}

int compare_all(const bug::Bug& bug, const Staging& staging) {
  Comparison comparison(staging);
  for (std::size_t i = 0; i < bug.memories.size(); ++i) {
    for (const bug::Piece& piece : bug.memories[i].pieces) {
      std::uint64_t offset = 0;
      const std::string owner = owner_of(bug, i, piece, offset);
      comparison.look(piece, owner, offset);
    }
  }
  for (std::size_t i = 0; i < bug.images.size(); ++i)
    for (const bug::Texels& texels : bug.images[i].texels)
      comparison.look(texels, name_of("image", i, bug.images[i].name) + ", level " + std::to_string(texels.level), 0);
  return comparison.summarize();
}

/// The file with what is in `staging` as what is behind the command.
bool update(bug::Bug bug, const Staging* staging, const char* name) {
  for_each_content(bug, [&](auto& content, std::uint64_t at) {
    content.after = nullptr;
    if (staging && compare(staging->bytes + at, *content.before).count != 0)
      content.after = std::make_shared<bug::Bytes>(staging->bytes + at, staging->bytes + at + content.before->size());
  });
  bug.lost = staging == nullptr;
  return write(name, bug::to_file(bug));
}

int replay(const bug::Bug& bug, const char* updated) {
  const Device d = make_device(bug);
  const Resources resources = make_resources(d, bug);
  Bound bound = make_sets(d, bug, resources);
  destroy_gone(d, bug, resources);
  bound.pipeline =
      bug.dispatches() ? make_compute_pipeline(d, bug, bound.layout) : make_graphics_pipeline(d, bug, bound.layout);
  try {
    run(d, bug, resources, bound);
  } catch (const Lost&) {
    std::fprintf(stdout, "the device is lost%s\n", bug.lost ? ", as it was" : "");
    if (updated && !update(bug, nullptr, updated)) return kCouldNotRun;
    return bug.lost || updated ? kSame : kDiffers;
  }
  const Staging staging = make_staging(d, for_each_content(bug, [](const auto&, std::uint64_t) {}));
  // What lies in no buffer, since `vitrine reduce` has left it out, is as it was.
  for_each_content(bug, [&](const auto& content, std::uint64_t at) {
    std::copy(content.before->begin(), content.before->end(), staging.bytes + at);
  });
  copy_contents(d, bug, resources, staging, true);
  if (updated) return update(bug, &staging, updated) ? kSame : kCouldNotRun;
  if (!bug.lost) return compare_all(bug, staging);
  std::fputs("the command ends here; where it was captured it lost the device\n", stdout);
  return kDiffers;
}

int main_of(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fputs("usage: vitrine-replay FILE [NEW]\n", stderr);
    return kCouldNotRun;
  }
  const std::optional<std::string> contents = read(argv[1]);
  if (!contents) {
    std::fprintf(stderr, "vitrine-replay: %s cannot be read\n", argv[1]);
    return kCouldNotRun;
  }
  const base::Result<bug::Bug> bug = bug::from_file(*contents);
  if (!bug) {
    std::fprintf(stderr, "vitrine-replay: %s: %s\n", argv[1], bug.message().c_str());
    return kCouldNotRun;
  }
  try {
    return replay(bug.value(), argc > 2 ? argv[2] : nullptr);
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "vitrine-replay: %s\n", error.what());
  } catch (const std::bad_alloc&) {
    std::fputs("vitrine-replay: no memory\n", stderr);
  }
  return kCouldNotRun;
}

}  // namespace
}  // namespace vitrine::glass::replayer

int main(int argc, char** argv) { return vitrine::glass::replayer::main_of(argc, argv); }
