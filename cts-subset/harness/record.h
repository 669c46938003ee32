// The recorded reference: what the reference put out in every case, as hashes in one file, by which this device is
// judged where the reference is not installed (docs/recorded-reference.md tells of the format and of its use).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/output.h"

namespace vitrine::cts {

struct RecordedOutput {
  uint64_t hash = 0;                 ///< of the bytes, with one NaN for all where their bits are free
  uint32_t raw = 0;                  ///< of the bytes as they are
  bool has_deviation = false;        ///< rows of deviations.md allow the device another result
  std::vector<unsigned char> bytes;  ///< all of them, in cases that assert a deviation; else empty
};

struct RecordedCase {
  bool unsupported = false, blank = false;
  uint32_t inputs = 0, modules = 0;  ///< what the device was given (inputs.h)
  std::vector<RecordedOutput> outputs;
};

/// The file: what was recorded, where, and a line of text for each case.
struct Record {
  std::string driver;    ///< of the reference: "Mesa 22.3.6 (LLVM 15.0.6)"
  std::string device;    ///< its name
  std::string compiler;  ///< of the shaders
  uint64_t seed = 1;
  uint32_t revision = 0;                ///< of the suite
  std::vector<uint32_t> float_to_uint;  ///< the CPU's part (ReferenceCpu)
  uint64_t srgb_hash = 0, rsqrt_hash = 0;
  std::vector<std::string> claims;          ///< lines of claims.h
  std::map<std::string, uint32_t> sources;  ///< hashes of the files that define cases
  std::map<std::string, std::string> cases;
};

/// Throws if the file cannot be read or is none.
Record read_record(const std::string& path);
void write_record(const std::string& path, const Record& record);

/// One output; `keep`: with its bytes.
RecordedOutput record_output(const Output& output, bool keep);
std::string case_line(const RecordedCase& recorded);
RecordedCase parse_case_line(const std::string& line);

}  // namespace vitrine::cts
