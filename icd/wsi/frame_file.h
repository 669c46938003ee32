// Where frames of a display go: numbered PNG files, or one stream in the format YUV4MPEG2 (docs/recording.md). Who
// reads it may be slow, or nobody: then frames are left out, and nobody waits for long.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "icd/wsi/display_setting.h"

namespace vitrine::icd::wsi {

class FrameFile {
 public:
  /// Nothing is opened before the first frame.
  FrameFile(const DisplaySetting& setting, std::uint32_t millihertz) : setting_(setting), millihertz_(millihertz) {}
  FrameFile(const FrameFile&) = delete;
  FrameFile& operator=(const FrameFile&) = delete;
  ~FrameFile();

  /// Adds a frame of the setting's extent, three bytes a pixel: red, green, blue. What cannot be written is left out,
  /// and told once on stderr. Any thread.
  void add(std::span<const std::byte> rgb);

 private:
  using Clock = std::chrono::steady_clock;

  void add_png(std::span<const std::byte> rgb);
  void add_to_stream(std::span<const std::byte> rgb);
  bool open_stream();
  void push(std::span<const std::byte> rgb);
  bool flush(Clock::time_point until);
  void tell(const char* problem);
  void end_stream();

  const DisplaySetting setting_;
  const std::uint32_t millihertz_;
  std::mutex mutex_;
  std::uint32_t frames_ = 0;
  bool told_ = false;
  bool slow_ = false;   ///< the reader has kept us waiting: it gets no more time until it has read all
  bool ended_ = false;  ///< for good
  int file_ = -1;
  std::vector<std::byte> pending_;  ///< a frame, or what its reader has not yet taken
  std::size_t written_ = 0;         ///< of it
};

/// The one of the process for this file: surfaces that come and go add to it.
std::shared_ptr<FrameFile> frame_file_of(const DisplaySetting& setting, std::uint32_t millihertz);

}  // namespace vitrine::icd::wsi
