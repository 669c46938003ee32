// Reads and writes the file of the recorded reference.
#include "harness/record.h"

#include <zlib.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "harness/hash.h"

namespace vitrine::cts {
namespace {

constexpr char kTitle[] = "# The recorded reference: docs/recorded-reference.md. Written by cts_subset --record.";
constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

template <typename T>
std::string hex(T value) {
  char text[20];
  std::snprintf(text, sizeof text, "%0*" PRIx64, static_cast<int>(sizeof(T) * 2), static_cast<uint64_t>(value));
  return text;
}

uint64_t from_hex(const std::string& text) { return std::strtoull(text.c_str(), nullptr, 16); }

/// Base 64 without padding: three bytes are four characters.
std::string letters_of(const std::vector<unsigned char>& bytes) {
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0u);
    for (size_t k = 0; k <= count; ++k) text += kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

std::vector<unsigned char> bytes_of(const std::string& text) {
  std::vector<unsigned char> bytes;
  uint32_t word = 0, bits = 0;
  for (const char c : text) {
    const char* digit = std::strchr(kDigits, c);
    if (!digit) throw std::runtime_error("the record has a letter that stands for no bits");
    word = word << 6 | static_cast<uint32_t>(digit - kDigits);
    bits += 6;
    if (bits >= 8) bytes.push_back(static_cast<unsigned char>(word >> (bits -= 8)));
  }
  return bytes;
}

std::string packed(const std::vector<unsigned char>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<unsigned char> small(size);
  if (compress2(small.data(), &size, bytes.data(), bytes.size(), 9) != Z_OK) throw std::bad_alloc();
  small.resize(size);
  return std::to_string(bytes.size()) + ":" + letters_of(small);
}

std::vector<unsigned char> unpacked(const std::string& text) {
  std::vector<unsigned char> bytes(std::strtoull(text.c_str(), nullptr, 10));
  const std::vector<unsigned char> small = bytes_of(text.substr(text.find(':') + 1));
  uLongf size = bytes.size();
  if (uncompress(bytes.data(), &size, small.data(), small.size()) != Z_OK || size != bytes.size())
    throw std::runtime_error("the record holds bytes that cannot be unpacked");
  return bytes;
}

void replace_nans(std::vector<unsigned char>& bytes) {
  constexpr uint32_t kNan = 0x7fc00000;
  for (size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    uint32_t word;
    std::memcpy(&word, bytes.data() + i, 4);
    if ((word & 0x7fffffff) > 0x7f800000) std::memcpy(bytes.data() + i, &kNan, 4);
  }
}

/// "HASH", then what is not as in most outputs: "~RAW", "!" for a deviation, "=BYTES".
std::string output_text(const RecordedOutput& output) {
  std::string text = hex(output.hash);
  if (output.raw != static_cast<uint32_t>(output.hash)) text += "~" + hex(output.raw);
  if (output.has_deviation) text += "!";
  if (!output.bytes.empty()) text += "=" + packed(output.bytes);
  return text;
}

RecordedOutput parse_output(const std::string& text) {
  RecordedOutput output;
  output.hash = from_hex(text);
  const size_t bytes = text.find('='), raw = text.find('~');
  output.raw = static_cast<uint32_t>(raw < bytes ? from_hex(text.substr(raw + 1)) : output.hash);
  output.has_deviation = text.find('!') < bytes;
  if (bytes != std::string::npos) output.bytes = unpacked(text.substr(bytes + 1));
  return output;
}

void read_head_line(Record& record, const std::string& line) {
  const size_t space = line.find(' ');
  const std::string key = line.substr(0, space), value = space == std::string::npos ? "" : line.substr(space + 1);
  if (key == "driver") record.driver = value;
  if (key == "device") record.device = value;
  if (key == "compiler") record.compiler = value;
  if (key == "seed") record.seed = std::strtoull(value.c_str(), nullptr, 10);
  if (key == "revision") record.revision = static_cast<uint32_t>(from_hex(value));
  if (key == "srgb") record.srgb_hash = from_hex(value);
  if (key == "rsqrt") record.rsqrt_hash = from_hex(value);
  if (key == "float-to-uint") {
    std::istringstream words(value);
    for (std::string word; words >> word;) record.float_to_uint.push_back(static_cast<uint32_t>(from_hex(word)));
  }
  if (key == "claim") record.claims.push_back(value);
  if (key == "source") {
    const size_t end = value.rfind(' ');
    record.sources[value.substr(0, end)] = static_cast<uint32_t>(from_hex(value.substr(end + 1)));
  }
}

}  // namespace

Record read_record(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line) || line != kTitle)
    throw std::runtime_error(path + " is no record of the reference");
  Record record;
  while (std::getline(file, line) && line != "cases") read_head_line(record, line);
  while (std::getline(file, line)) {
    const size_t space = line.find(' ');
    record.cases[line.substr(0, space)] = line.substr(space + 1);
  }
  return record;
}

void write_record(const std::string& path, const Record& record) {
  std::ofstream file(path);
  file << kTitle << "\ndriver " << record.driver << "\ndevice " << record.device << "\ncompiler " << record.compiler
       << "\nseed " << record.seed << "\nrevision " << hex(record.revision) << "\nfloat-to-uint";
  for (const uint32_t word : record.float_to_uint) file << " " << hex(word);
  file << "\nsrgb " << hex(record.srgb_hash) << "\nrsqrt " << hex(record.rsqrt_hash) << "\n";
  for (const std::string& claim : record.claims) file << "claim " << claim << "\n";
  for (const auto& [source, hash] : record.sources) file << "source " << source << " " << hex(hash) << "\n";
  file << "cases\n";
  for (const auto& [name, line] : record.cases) file << name << " " << line << "\n";
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

RecordedOutput record_output(const Output& output, bool keep) {
  RecordedOutput result;
  Hash raw;
  raw.bytes(output.bytes.data(), output.bytes.size());
  result.hash = raw.value();
  result.raw = static_cast<uint32_t>(raw.value());
  result.has_deviation = !output.deviation.empty();
  if (output.nan_bits_free && output.format.bits[0] == 32) {
    std::vector<unsigned char> bytes = output.bytes;
    replace_nans(bytes);
    Hash hash;
    hash.bytes(bytes.data(), bytes.size());
    result.hash = hash.value();
  }
  if (keep) result.bytes = output.bytes;
  return result;
}

std::string case_line(const RecordedCase& recorded) {
  std::string line = recorded.unsupported ? "unsupported" : recorded.blank ? "blank" : "-";
  line += " " + hex(recorded.inputs) + " " + hex(recorded.modules);
  for (const RecordedOutput& output : recorded.outputs) line += " " + output_text(output);
  return line;
}

RecordedCase parse_case_line(const std::string& line) {
  std::istringstream words(line);
  RecordedCase result;
  std::string kind, inputs, modules;
  words >> kind >> inputs >> modules;
  result.unsupported = kind == "unsupported";
  result.blank = kind == "blank";
  result.inputs = static_cast<uint32_t>(from_hex(inputs));
  result.modules = static_cast<uint32_t>(from_hex(modules));
  for (std::string word; words >> word;) result.outputs.push_back(parse_output(word));
  return result;
}

}  // namespace vitrine::cts
