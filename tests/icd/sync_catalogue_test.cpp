// The catalogue of planted hazards of buffers, shaders and the host, each with its correct twin (sync_scene.h has the
// language).
#include "tests/icd/sync_scene.h"

namespace vitrine::icd::test {
namespace {

constexpr PlantedHazard kPlanted[] = {
    // ---- transfers
    {"fill_and_copy", "sync-read-after-write", "fill A; copy A B", "fill A; barrier CLEAR.TW>COPY.TR; copy A B"},
    {"update_and_copy", "sync-read-after-write", "update A; copy A B",
     "update A; barrier TRANSFER.TW>TRANSFER.TR; copy A B"},
    {"two_fills", "sync-write-after-write", "fill A; fill A", "fill A; barrier CLEAR.TW>CLEAR.TW; fill A"},
    {"two_fills_of_a_part", "sync-write-after-write", "fill A:0+64; fill A:60+64", "fill A:0+64; fill A:64+64"},
    {"copy_and_fill_of_its_source", "sync-write-after-read", "copy A B; fill A",
     "copy A B; barrier COPY.0>CLEAR.0; fill A"},
    {"copy_chain", "sync-read-after-write", "copy A B; copy B C", "copy A B; barrier COPY.TW>COPY.TR; copy B C"},
    {"copy_of_the_next_bytes", "sync-read-after-write", "copy A:0+64 B; copy B:32+64 C",
     "copy A:0+64 B; copy B:64+64 C"},
    {"copies_to_one_target", "sync-write-after-write", "copy A B; copy C B",
     "copy A B; barrier COPY.TW>COPY.TW; copy C B"},
    {"execution_alone_for_a_write", "sync-write-after-write", "fill A; barrier CLEAR.0>CLEAR.0; fill A",
     "fill A; barrier CLEAR.TW>CLEAR.TW; fill A"},
    {"query_results", "sync-read-after-write", "queries A; copy A B", "queries A; barrier COPY.TW>COPY.TR; copy A B"},
    // ---- masks
    {"wrong_first_stage", "sync-read-after-write", "fill A; barrier COPY.TW>COPY.TR; copy A B",
     "fill A; barrier TRANSFER.TW>COPY.TR; copy A B"},
    {"wrong_second_stage", "sync-read-after-write", "fill A; barrier CLEAR.TW>BLIT.TR; copy A B",
     "fill A; barrier CLEAR.TW>BLIT|COPY.TR; copy A B"},
    {"wrong_first_access", "sync-read-after-write", "fill A; barrier CLEAR.TR>COPY.TR; copy A B",
     "fill A; barrier CLEAR.W>COPY.TR; copy A B"},
    {"wrong_second_access", "sync-read-after-write", "fill A; barrier CLEAR.TW>COPY.TW; copy A B",
     "fill A; barrier CLEAR.TW>COPY.R; copy A B"},
    {"nothing_made_available", "sync-read-after-write", "store A; barrier COMPUTE.0>COMPUTE.SR; load A",
     "store A; barrier COMPUTE.SW>COMPUTE.SR; load A"},
    {"nothing_made_visible", "sync-read-after-write", "store A; barrier COMPUTE.SW>COMPUTE.0; load A",
     "store A; barrier COMPUTE.SW>COMPUTE.STORAGE; load A"},
    {"top_of_pipe_waits_for_nobody", "sync-read-after-write", "store A; barrier TOP.0>COMPUTE.SR; load A",
     "store A; barrier ALL.W>ALL.R; load A"},
    {"nobody_waits_at_the_bottom", "sync-read-after-write", "store A; barrier COMPUTE.SW>BOTTOM.0; load A",
     "store A; barrier COMPUTE.SW>BOTTOM|COMPUTE.SR; load A"},
    {"old_barrier", "sync-read-after-write", "store A; old COMPUTE.SW>TRANSFER.TR; load A",
     "store A; old COMPUTE.SW>COMPUTE.SR; load A"},
    {"old_barrier_without_access", "sync-read-after-write", "store A; old COMPUTE.0>COMPUTE.0; load A",
     "store A; old ALL.W>ALL.R; load A"},
    {"sampled_is_not_storage", "sync-read-after-write", "store A; barrier COMPUTE.SW>COMPUTE.SAMPLED; load A",
     "store A; barrier COMPUTE.SW>COMPUTE.STORAGE|SAMPLED; load A"},
    // ---- ranges
    {"wrong_buffer", "sync-read-after-write", "store A; barrier COMPUTE.SW>COMPUTE.SR B; load A",
     "store A; barrier COMPUTE.SW>COMPUTE.SR A; load A"},
    {"wrong_range", "sync-read-after-write", "store A; barrier COMPUTE.SW>COMPUTE.SR A:0+128; load A",
     "store A; barrier COMPUTE.SW>COMPUTE.SR A:0+128; barrier COMPUTE.SW>COMPUTE.SR A:128+128; load A"},
    {"range_without_availability", "sync-read-after-write", "store A; barrier COMPUTE.0>COMPUTE.SR A; load A",
     "store A; barrier COMPUTE.SW>COMPUTE.SR A; load A"},
    {"other_words", "sync-write-after-write", "fill A:0+64; barrier CLEAR.TW>CLEAR.TW A:64+64; fill A:0+64",
     "fill A:0+64; fill A:64+64; fill A:128+64"},
    // ---- chains
    {"broken_chain", "sync-read-after-write",
     "store A; barrier COMPUTE.SW>COPY.0; barrier FRAGMENT.0>COMPUTE.SR; load A",
     "store A; barrier COMPUTE.SW>COPY.0; barrier COPY.0>COMPUTE.SR; load A"},
    {"chain_that_makes_nothing_available", "sync-read-after-write",
     "store A; barrier COMPUTE.0>COPY.0; barrier COPY.SW>COMPUTE.SR; load A",
     "store A; barrier COMPUTE.0>COPY.0; barrier COPY|COMPUTE.SW>COMPUTE.SR; load A"},
    {"chain_of_ranges", "sync-read-after-write",
     "store A; barrier COMPUTE.SW>COPY.0 A; barrier CLEAR.0>COMPUTE.SR; load A",
     "store A; barrier COMPUTE.SW>COPY.0 A; barrier COPY.0>COMPUTE.SR; load A"},
    {"chain_to_a_range", "sync-read-after-write",
     "store A; barrier COMPUTE.SW>COPY.0 A; barrier CLEAR.0>COMPUTE.SR A; load A",
     "store A; barrier COMPUTE.SW>COPY.0 A; barrier COPY.0>COMPUTE.SR A; load A"},
    {"chain_for_a_read", "sync-write-after-read",
     "load A; barrier COMPUTE.0>COPY.0; barrier CLEAR.0>COMPUTE.0; store A",
     "load A; barrier COMPUTE.0>COPY.0; barrier COPY.0>COMPUTE.0; store A"},
    // ---- dispatches
    {"two_dispatches", "sync-read-after-write", "store A; load A", "store A; barrier COMPUTE.SW>COMPUTE.SR; load A"},
    {"two_dispatches_write", "sync-write-after-write", "store A; store A",
     "store A; barrier COMPUTE.SW>COMPUTE.SW; store A"},
    {"dispatch_reads_then_writes", "sync-write-after-read", "load A; store A",
     "load A; barrier COMPUTE.0>COMPUTE.0; store A"},
    {"atomic_and_plain", "sync-read-after-write", "add A; load A",
     "add A; add A; barrier COMPUTE.SW>COMPUTE.SR; load A"},
    {"store_and_atomic", "sync-read-after-write", "store A; add A",
     "store A; barrier COMPUTE.SW>COMPUTE.SR|SW; add A; add A"},
    {"load_and_atomic", "sync-write-after-read", "load A; add A", "load A; barrier COMPUTE.0>COMPUTE.0; add A"},
    {"dispatch_and_copy", "sync-read-after-write", "store A; copy A B",
     "store A; barrier COMPUTE.SW>COPY.TR; copy A B"},
    {"copy_and_dispatch", "sync-read-after-write", "copy B A; load A", "copy B A; barrier COPY.TW>COMPUTE.SR; load A"},
    {"copy_and_uniform", "sync-read-after-write", "copy B A; barrier COPY.TW>COMPUTE.SAMPLED; uniform A",
     "copy B A; barrier COPY.TW>COMPUTE.UR; uniform A"},
    {"fill_and_indirect_dispatch", "sync-read-after-write", "fill A:0+12; barrier CLEAR.TW>COMPUTE.SR; dispatch A",
     "fill A:0+12; barrier CLEAR.TW>INDIRECT.IR; dispatch A"},
    {"fill_behind_the_arguments", "sync-read-after-write", "fill A:8+12; dispatch A", "fill A:12+12; dispatch A"},
    {"arguments_are_read_before_they_change", "sync-write-after-read", "dispatch A; fill A:0+12",
     "dispatch A; barrier INDIRECT.0>CLEAR.0; fill A:0+12"},
    // ---- events
    {"event_not_waited_for", "sync-read-after-write", "store A; set COMPUTE.SW>COMPUTE.SR; load A",
     "store A; set COMPUTE.SW>COMPUTE.SR; wait COMPUTE.SW>COMPUTE.SR; load A"},
    {"event_set_too_early", "sync-read-after-write",
     "set COMPUTE.SW>COMPUTE.SR; store A; wait COMPUTE.SW>COMPUTE.SR; load A",
     "store A; set COMPUTE.SW>COMPUTE.SR; wait COMPUTE.SW>COMPUTE.SR; load A"},
    {"event_of_another_stage", "sync-read-after-write",
     "store A; set COPY.TW>COMPUTE.SR; wait COPY.TW>COMPUTE.SR; load A",
     "store A; set ALL.W>COMPUTE.SR; wait ALL.W>COMPUTE.SR; load A"},
    {"event_without_availability", "sync-read-after-write",
     "store A; set COMPUTE.0>COMPUTE.SR; wait COMPUTE.0>COMPUTE.SR; load A",
     "store A; set COMPUTE.SW>COMPUTE.SR; wait COMPUTE.SW>COMPUTE.SR; load A"},
    // ---- submissions
    {"two_submissions", "sync-read-after-write", "store A; submit; load A", "store A; idle; load A"},
    {"submissions_with_a_barrier", "sync-read-after-write", "store A; submit; barrier COPY.TW>COMPUTE.SR; load A",
     "store A; submit; barrier COMPUTE.SW>COMPUTE.SR; load A"},
    {"semaphore_of_another_stage", "sync-read-after-write", "store A; semaphore FRAGMENT; load A",
     "store A; semaphore COMPUTE; load A"},
    {"semaphore_and_copy", "sync-read-after-write", "store A; semaphore COMPUTE; copy A B",
     "store A; semaphore TRANSFER; copy A B"},
    {"semaphore_two_submissions_on", "sync-write-after-read", "load A; submit; store A",
     "load A; semaphore ALL; fill B; submit; store A"},
    {"timeline_of_another_stage", "sync-read-after-write", "store A; timeline TRANSFER; load A",
     "store A; timeline COMPUTE; load A"},
    {"fence_not_waited_for", "sync-write-after-write", "store A; submit; store A", "store A; fence; store A"},
    {"read_across_submissions", "sync-write-after-read", "load A; submit; fill A", "load A; fence; fill A"},
    // ---- host
    {"host_reads_without_a_barrier", "sync-host", "store A; fence; invalidate A",
     "store A; barrier COMPUTE.SW>HOST.HR; fence; invalidate A"},
    {"host_reads_before_the_fence", "sync-host", "store A; barrier COMPUTE.SW>HOST.HR; submit; invalidate A",
     "store A; barrier COMPUTE.SW>HOST.HR; fence; invalidate A"},
    {"host_reads_what_another_stage_wrote", "sync-host", "fill A; barrier COMPUTE.SW>HOST.HR; fence; invalidate A",
     "fill A; barrier TRANSFER.TW>HOST.HR; fence; invalidate A"},
    {"host_writes_what_is_read", "sync-host", "load A; submit; flush A", "load A; fence; flush A"},
    {"host_writes_what_is_written", "sync-host", "copy B A; submit; flush A", "copy B A; idle; flush A"},
};

class Hazards : public ::testing::TestWithParam<PlantedHazard> {};

TEST_P(Hazards, IsFoundAndItsTwinIsNot) {
  if (!std::getenv("VITRINE_TOOLS")) GTEST_SKIP() << "needs VITRINE_TOOLS=sync";
  expect_hazard(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Sync, Hazards, ::testing::ValuesIn(kPlanted),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace vitrine::icd::test
