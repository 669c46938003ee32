// Runs one case on both devices and judges it.
#pragma once

#include <string>

#include "harness/case.h"

namespace vitrine::cts {

/// The last two are of a recorded reference: it has no result of the case, or one of what the case was before.
enum class Verdict { kIdentical, kDeviation, kUnsupported, kKnown, kDiffering, kCrashed, kUnrecorded, kChanged };

/// Whether it fails a run and has a message that says why.
inline bool is_failure(Verdict verdict) {
  return verdict == Verdict::kDiffering || verdict == Verdict::kUnrecorded || verdict == Verdict::kChanged;
}

struct Judgement {
  Verdict verdict = Verdict::kIdentical;
  std::string message;    ///< empty unless something is to be told
  bool nan_bits = false;  ///< identical but for bits of NaNs, where they are free
  bool blank = false;     ///< every output had one value everywhere (allowed)
};

/// The case's full name: group.name.
std::string full_name(const Case& c);
/// The case's seed, from the suite's seed and its name.
uint64_t case_seed(const Case& c);
Judgement execute(const Case& c);
/// Whether VITRINE_AS_REFERENCE asks the device for the reference's way in all of these rows of deviations.md, which
/// blanks separate: there is no difference to be expected then.
bool is_asked(const std::string& rows);
/// Reads the lists of known differences and of expected findings that the options name. Throws when one cannot be read.
void load_lists();
/// What the reference does where its bits depend on the CPU (design.md section 8).
struct ReferenceCpu {
  std::vector<uint32_t> float_to_uint;  ///< of -1, -0.5, 3e9, 5e9 and NaN
  uint64_t srgb_hash = 0;               ///< of the bytes that 65536 ramp values become in an sRGB attachment
  bool float_to_uint_as_recorded = false, srgb_as_recorded = false;
  bool uint_comparable = false;  ///< as recorded, or this device can follow the CPU (VITRINE_REFERENCE_CPU)
  bool srgb_comparable = false;  ///< as recorded, or this device can follow the CPU (VITRINE_RSQRT)
};

/// What this device must do to follow the reference, or the CPU that it was recorded on.
struct CpuSettings {
  bool own_rsqrt;  ///< encode sRGB with this CPU's instruction (VITRINE_RSQRT)
  bool avx2;       ///< convert as without AVX-512 (VITRINE_REFERENCE_CPU)
};
CpuSettings cpu_settings();
/// Tells CPUs apart by their RSQRTPS; 0 where there is no such instruction.
uint64_t rsqrt_hash();

/// Asks the reference, or its record, once per process.
const ReferenceCpu& reference_cpu();
void print_reference_cpu();

}  // namespace vitrine::cts
