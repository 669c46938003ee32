// Writes frames without waiting for whoever reads them: descriptors that never block, and a second's patience.
#include "icd/wsi/frame_file.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/lasting.h"
#include "glass/output.h"
#include "icd/wsi/png.h"

namespace vitrine::icd::wsi {
namespace {

/// How long a reader may keep a frame before frames are left out.
constexpr std::chrono::milliseconds kPatience{1000};

/// A reader that has gone must not end the application: while it lives, this thread takes no SIGPIPE.
class WithoutSigpipe {
 public:
  WithoutSigpipe() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    others_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~WithoutSigpipe() {
    const timespec now{};
    if (!others_) {
      while (sigtimedwait(&pipe_, nullptr, &now) < 0 && errno == EINTR) {
      }
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  WithoutSigpipe(const WithoutSigpipe&) = delete;
  WithoutSigpipe& operator=(const WithoutSigpipe&) = delete;

 private:
  sigset_t pipe_, before_;
  bool others_ = false;
};

/// Bytes that a write may have without waiting, once poll() says that there is room (POSIX, write: PIPE_BUF).
std::size_t step_of(int file, std::size_t bytes) {
  const int flags = fcntl(file, F_GETFL);
  struct stat status {};
  const bool waits = flags >= 0 && !(flags & O_NONBLOCK) && fstat(file, &status) == 0 && !S_ISREG(status.st_mode);
  return waits ? std::min<std::size_t>(bytes, PIPE_BUF) : bytes;
}

bool write_whole(const std::string& name, std::span<const std::byte> bytes) {
  const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file < 0) return false;
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  const int error = errno;
  const bool whole = close(file) == 0 && done == bytes.size();
  errno = error;
  return whole;
}

/// ITU-R BT.601 with limited range, which players assume of streams that do not tell, in 8 fractional bits.
struct Weights {
  int red, green, blue, base;
};
constexpr Weights kPlanes[3] = {{66, 129, 25, 16}, {-38, -74, 112, 128}, {112, -94, -18, 128}};

void put_plane(const Weights& w, std::span<const std::byte> rgb, std::byte* to) {
  const auto* from = reinterpret_cast<const std::uint8_t*>(rgb.data());
  const std::size_t pixels = rgb.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i, from += 3)
    to[i] = static_cast<std::byte>(((w.red * from[0] + w.green * from[1] + w.blue * from[2] + 128) >> 8) + w.base);
}

constexpr std::string_view kFrameHeader = "FRAME\n";

std::string header_of(const VkExtent2D& extent, std::uint32_t millihertz) {
  char text[128];
  std::snprintf(text, sizeof text, "YUV4MPEG2 W%u H%u F%u:1000 Ip A1:1 C444 XCOLORRANGE=LIMITED\n", extent.width,
                extent.height, millihertz);
  return text;
}

}  // namespace

FrameFile::~FrameFile() { end_stream(); }

void FrameFile::add(std::span<const std::byte> rgb) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  setting_.file.ends_with(".png") ? add_png(rgb) : add_to_stream(rgb);
}

void FrameFile::add_png(std::span<const std::byte> rgb) {
  char number[16];
  std::snprintf(number, sizeof number, "-%06u", ++frames_);
  std::string name = setting_.file;
  name.insert(name.size() - 4, number);
  if (!write_whole(name, encode_png(rgb, setting_.extent.width, setting_.extent.height))) tell(std::strerror(errno));
}

void FrameFile::add_to_stream(std::span<const std::byte> rgb) {
  const WithoutSigpipe without;
  if (file_ < 0 && !open_stream()) return;
  if (!pending_.empty() && !flush(Clock::now())) return;  // this frame is left out
  push(rgb);
  const Clock::time_point now = Clock::now();
  if (flush(slow_ ? now : now + kPatience)) return;
  if (file_ >= 0 && !slow_) {
    slow_ = true;
    tell("it is not read fast enough: frames are left out");
  }
}

/// False: there is none, which has been told.
bool FrameFile::open_stream() {
  const std::string header = header_of(setting_.extent, millihertz_);
  const auto* const first = reinterpret_cast<const std::byte*>(header.data());
  pending_.assign(first, first + header.size());  // first of all: memory may be short
  const bool standard = setting_.file == "-";
  file_ = standard ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                   : open(setting_.file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file_ < 0) {
    tell(errno == ENXIO ? "nobody reads it yet: frames are left out" : std::strerror(errno));
    pending_.clear();
    return false;
  }
  written_ = 0;
  return true;
}

/// The frame behind what is pending, which is at most the header.
void FrameFile::push(std::span<const std::byte> rgb) {
  const std::size_t pixels = rgb.size() / 3, header = pending_.size();
  pending_.resize(header + kFrameHeader.size() + 3 * pixels);
  std::byte* const frame = pending_.data() + header;
  std::memcpy(frame, kFrameHeader.data(), kFrameHeader.size());
  for (std::size_t plane = 0; plane < 3; ++plane)
    put_plane(kPlanes[plane], rgb, frame + kFrameHeader.size() + plane * pixels);
}

/// True: all that was pending is written. False: the time is over, or the file has ended.
bool FrameFile::flush(Clock::time_point until) {
  while (written_ < pending_.size()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd room{file_, POLLOUT, 0};
    const int ready = poll(&room, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));
    if (ready == 0) return false;
    const std::size_t rest = pending_.size() - written_;
    const ssize_t count = ready < 0 ? -1 : write(file_, pending_.data() + written_, step_of(file_, rest));
    if (count >= 0) {
      written_ += static_cast<std::size_t>(count);
      continue;
    }
    if (errno == EINTR || errno == EAGAIN) {
      if (left <= 0) return false;
      continue;
    }
    tell(std::strerror(errno));
    if (errno == ENOSPC || errno == EDQUOT) return false;  // goes on once there is room
    end_stream();
    return false;
  }
  pending_.clear();
  written_ = 0;
  slow_ = false;
  return true;
}

void FrameFile::tell(const char* problem) {
  const int error = errno;
  if (!told_) glass::complain("VITRINE_DISPLAY: " + setting_.file + ": " + problem);
  told_ = true;
  errno = error;
}

/// A pipe may get another reader, with a header of its own; a file begins once.
void FrameFile::end_stream() {
  if (file_ < 0) return;
  struct stat status {};
  const bool named_pipe = setting_.file != "-" && fstat(file_, &status) == 0 && S_ISFIFO(status.st_mode);
  ended_ = !named_pipe;
  close(file_);
  file_ = -1;
  pending_.clear();
  written_ = 0;
}

std::shared_ptr<FrameFile> frame_file_of(const DisplaySetting& setting, std::uint32_t millihertz) {
  struct Last {
    std::mutex mutex;
    std::string name;
    VkExtent2D extent{};
    std::shared_ptr<FrameFile> file;
  };
  static Last& last = base::lasting([] { return Last{}; });
  const std::lock_guard lock(last.mutex);
  const bool same = last.file && last.name == setting.file && last.extent.width == setting.extent.width &&
                    last.extent.height == setting.extent.height;
  if (!same) {
    last.file = std::make_shared<FrameFile>(setting, millihertz);
    last.name = setting.file;
    last.extent = setting.extent;
  }
  return last.file;
}

}  // namespace vitrine::icd::wsi
