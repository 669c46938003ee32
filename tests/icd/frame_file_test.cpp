// Frames for readers that come late, read slowly, stop or go: nobody waits for them for long, and what they get is
// whole. PNG files by a reader of what DEFLATE's fixed codes say (RFC 1951).
#include "icd/wsi/frame_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <random>
#include <thread>

#include "icd/wsi/png.h"

namespace vitrine::icd::wsi {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kWidth = 320, kHeight = 200;
constexpr std::size_t kFrame = 6 + 3 * kWidth * kHeight;  ///< more than a pipe holds

class FrameFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("vitrine-frames-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    setting = {{kWidth, kHeight}, 60000, (folder / "film.y4m").string()};
    ASSERT_EQ(mkfifo(setting.file.c_str(), 0600), 0);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static double seconds(const std::function<void()>& work) {
    const auto begin = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }
  int reader() const { return open(setting.file.c_str(), O_RDONLY | O_NONBLOCK); }

  /// All that is there.
  static std::string take(int file) {
    std::string out;
    char part[65536];
    for (ssize_t count; (count = read(file, part, sizeof part)) > 0;) out.append(part, static_cast<std::size_t>(count));
    return out;
  }

  std::filesystem::path folder;
  DisplaySetting setting;
  const std::vector<std::byte> frame = std::vector<std::byte>(3 * kWidth * kHeight, std::byte{0x40});
};

TEST_F(FrameFiles, WithoutAReaderNobodyWaits) {
  FrameFile file(setting, 60000);
  EXPECT_LT(seconds([&] {
              for (int i = 0; i < 20; ++i) file.add(frame);
            }),
            0.9);
  const int late = reader();
  std::thread frames([&] { file.add(frame); });
  std::string got;
  for (const auto end = Clock::now() + std::chrono::seconds(5); got.size() < kFrame && Clock::now() < end;)
    got += take(late);
  frames.join();
  EXPECT_TRUE(got.starts_with("YUV4MPEG2 W320 H200 F60000:1000 ")) << "the stream begins with the reader";
  close(late);
}

TEST_F(FrameFiles, ReadersThatStopCostASecondOnce) {
  const int slow = reader();
  FrameFile file(setting, 60000);
  EXPECT_GE(seconds([&] { file.add(frame); }), 0.9) << "it has that long to read";
  EXPECT_LT(seconds([&] {
              for (int i = 0; i < 20; ++i) file.add(frame);
            }),
            0.9);
  std::string got;
  std::atomic<bool> enough = false;
  std::thread frames([&] {
    for (int i = 0; i < 200 && !enough; ++i) {
      file.add(frame);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  for (const auto end = Clock::now() + std::chrono::seconds(5); got.size() < 3 * kFrame && Clock::now() < end;)
    got += take(slow);
  enough = true;
  frames.join();
  const std::size_t first = got.find('\n') + 1;
  ASSERT_GE(got.size(), first + 2 * kFrame);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(got.substr(first + i * kFrame, 6), "FRAME\n") << "frames are whole";
  close(slow);
}

TEST_F(FrameFiles, ReadersMayGo) {
  FrameFile file(setting, 60000);
  int gone = reader();
  std::thread first([&] { file.add(frame); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  close(gone);
  first.join();
  EXPECT_LT(seconds([&] { file.add(frame); }), 0.9) << "and no signal has ended the process";
}

/// DEFLATE with one block of fixed codes, distances of 1.
class Inflater {
 public:
  explicit Inflater(std::span<const std::byte> data) : data_(data) {}

  std::vector<std::byte> all() {
    EXPECT_EQ(bits(3), 3u) << "the last block, with fixed codes";
    std::vector<std::byte> out;
    for (std::uint32_t symbol; (symbol = next_symbol()) != 256;) {
      if (symbol < 256) {
        out.push_back(static_cast<std::byte>(symbol));
        continue;
      }
      static constexpr std::array<std::uint32_t, 29> kBase{3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                                           15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                                           67, 83, 99, 115, 131, 163, 195, 227, 258};
      static constexpr std::array<std::uint32_t, 29> kExtra{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                            2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
      const std::uint32_t length = kBase.at(symbol - 257) + bits(kExtra.at(symbol - 257));
      EXPECT_EQ(code(5), 0u);
      out.insert(out.end(), length, out.at(out.size() - 1));
    }
    return out;
  }

 private:
  std::uint32_t bits(std::uint32_t count) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < count; ++i, ++at_)
      value |= (static_cast<std::uint32_t>(data_[at_ / 8]) >> at_ % 8 & 1) << i;
    return value;
  }
  std::uint32_t code(std::uint32_t count, std::uint32_t value = 0) {
    for (std::uint32_t i = 0; i < count; ++i) value = value << 1 | bits(1);
    return value;
  }
  std::uint32_t next_symbol() {
    std::uint32_t value = code(7);
    if (value < 24) return value + 256;
    value = code(1, value);
    if (value >= 0x30 && value < 0xC0) return value - 0x30;
    if (value >= 0xC0 && value < 0xC8) return value - 0xC0 + 280;
    return code(1, value) - 0x190 + 144;
  }

  std::span<const std::byte> data_;
  std::size_t at_ = 0;
};

std::uint32_t word_at(const std::vector<std::byte>& file, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint32_t>(file[at + i]);
  return value;
}

TEST(Png, HoldsEveryPixel) {
  std::mt19937 random(1);
  for (const std::uint32_t width : {1u, 5u, 90u, 300u}) {
    for (const std::uint32_t kinds : {1u, 2u, 1000u}) {
      const std::uint32_t height = 4;
      std::vector<std::byte> rgb(std::size_t{width} * height * 3);
      for (std::byte& b : rgb) b = static_cast<std::byte>(random() % kinds == 0 ? random() % 256 : 7);
      const std::vector<std::byte> file = encode_png(rgb, width, height);
      EXPECT_EQ(word_at(file, 8), 13u);
      EXPECT_EQ(word_at(file, 16), width);
      EXPECT_EQ(word_at(file, 20), height);
      const std::size_t body = 33 + 8, bytes = word_at(file, 33);
      const std::vector<std::byte> rows = Inflater(std::span(file).subspan(body + 2, bytes - 6)).all();
      ASSERT_EQ(rows.size(), std::size_t{width * 3 + 1} * height);
      for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width * 3; ++x) {
          const std::size_t pitch = width * 3, at = y * pitch + x;
          const auto above = y > 0 ? static_cast<std::uint32_t>(rgb[at - pitch]) : 0u;
          ASSERT_EQ(static_cast<std::byte>(static_cast<std::uint32_t>(rows[y * (pitch + 1) + 1 + x]) + above), rgb[at]);
        }
    }
  }
}

/// CRC and Adler of a file that other programs made.
TEST(Png, HasTheChecksumsOfTheStandards) {
  const std::vector<std::byte> file = encode_png(std::vector<std::byte>(3), 1, 1);
  EXPECT_EQ(word_at(file, 29), 0x907753DEu) << "of the header of a picture of one pixel";
  EXPECT_EQ(word_at(file, file.size() - 4), 0xAE426082u) << "of IEND";
  EXPECT_EQ(word_at(file, file.size() - 20), 0x000C0003u) << "of the filtered row";
}

}  // namespace
}  // namespace vitrine::icd::wsi
