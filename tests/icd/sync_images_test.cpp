// The catalogue of planted hazards of images, draws and passes, each with its correct twin (sync_scene.h has the
// language).
#include "tests/icd/sync_scene.h"

namespace vitrine::icd::test {
namespace {

constexpr PlantedHazard kPlanted[] = {
    // ---- transfers of images
    {"clear_and_copy", "sync-read-after-write", "clear M; copy M A", "clear M; barrier CLEAR.TW>COPY.TR; copy M A"},
    {"clear_twice", "sync-write-after-write", "clear M; clear M", "clear M; barrier CLEAR.TW>CLEAR.TW M; clear M"},
    {"copy_to_an_image_and_blit", "sync-read-after-write", "copy A M; barrier COPY.TW>COPY.TR; blit M N",
     "copy A M; barrier COPY.TW>BLIT.TR; blit M N"},
    {"blit_and_copy", "sync-read-after-write", "blit M N; copy N A", "blit M N; barrier BLIT.TW>COPY.TR N; copy N A"},
    {"copy_of_images", "sync-read-after-write", "copy M N; copy N A", "copy M N; barrier COPY.TW>COPY.TR; copy N A"},
    {"resolve_and_copy", "sync-read-after-write", "resolve S M; barrier COPY.TW>COPY.TR; copy M A",
     "resolve S M; barrier RESOLVE.TW>COPY.TR; copy M A"},
    {"clear_and_resolve", "sync-read-after-write", "clear S; resolve S M",
     "clear S; barrier CLEAR.TW>RESOLVE.TR; resolve S M"},
    {"buffer_of_an_image", "sync-read-after-write", "copy M A; copy A N",
     "copy M A; barrier COPY.TW>COPY.TR; copy A N"},
    {"clear_of_depth", "sync-read-after-write", "clear D; copy D A", "clear D; barrier CLEAR.TW>COPY.TR D; copy D A"},
    {"barrier_of_another_image", "sync-read-after-write", "clear M; barrier CLEAR.TW>COPY.TR N; copy M A",
     "clear M; barrier CLEAR.TW>COPY.TR M; copy M A"},
    // ---- shaders
    {"store_and_sample", "sync-read-after-write", "store M; sample M",
     "store M; barrier COMPUTE.SW>COMPUTE.SAMPLED; sample M"},
    {"store_and_load", "sync-read-after-write", "store M; load M", "store M; barrier COMPUTE.SW>COMPUTE.SR M; load M"},
    {"sample_and_store", "sync-write-after-read", "sample M; store M",
     "sample M; barrier COMPUTE.0>COMPUTE.0; store M"},
    {"upload_and_sample", "sync-read-after-write", "copy A M; barrier COPY.TW>FRAGMENT.SR; sample M",
     "copy A M; barrier COPY.TW>COMPUTE.SR; sample M"},
    {"sample_and_upload", "sync-write-after-read", "sample M; copy A M",
     "sample M; barrier COMPUTE.0>COPY.0; copy A M"},
    // ---- transitions
    {"transition_before_a_write_is_done", "sync-layout", "clear M; to M GENERAL>SOURCE COPY.0>COPY.TR",
     "clear M; to M GENERAL>SOURCE CLEAR.TW>COPY.TR"},
    {"transition_before_a_write_is_available", "sync-layout", "clear M; to M GENERAL>SOURCE CLEAR.0>COPY.TR",
     "clear M; to M GENERAL>SOURCE CLEAR.TW>COPY.TR"},
    {"transition_before_a_read_is_done", "sync-layout", "sample M; to M GENERAL>TARGET COPY.0>COPY.TW",
     "sample M; to M GENERAL>TARGET COMPUTE.0>COPY.TW"},
    {"transition_that_nobody_waits_for", "sync-layout", "to M UNDEFINED>GENERAL TOP.0>FRAGMENT.SR; copy M A",
     "to M UNDEFINED>GENERAL TOP.0>COPY.TR; copy M A"},
    {"transition_that_is_not_visible", "sync-layout", "to M UNDEFINED>GENERAL TOP.0>COPY.TW; copy M A",
     "to M UNDEFINED>GENERAL TOP.0>COPY.TW|TR; copy M A"},
    {"two_transitions", "sync-layout", "to M UNDEFINED>TARGET TOP.0>COPY.TW; to M TARGET>GENERAL CLEAR.TW>COPY.TR",
     "to M UNDEFINED>TARGET TOP.0>COPY.TW; to M TARGET>GENERAL COPY.TW>COPY.TR"},
    {"transition_and_semaphore", "sync-layout", "to M UNDEFINED>GENERAL TOP.0>BOTTOM.0; copy M A",
     "to M UNDEFINED>GENERAL TOP.0>BOTTOM.0; semaphore ALL; copy M A"},
    {"transition_in_a_chain", "sync-layout", "to M UNDEFINED>GENERAL TOP.0>BLIT.0; barrier CLEAR.0>COPY.TR; copy M A",
     "to M UNDEFINED>GENERAL TOP.0>BLIT.0; barrier BLIT.0>COPY.TR; copy M A"},
#ifdef VK_EXT_host_image_copy
    // ---- copies by the host
    {"host_copies_into_what_is_read", "sync-host", "copy M A; submit; put M", "copy M A; fence; put M"},
    {"host_copies_out_of_what_is_written", "sync-host", "clear M; barrier CLEAR.TW>HOST.HR; submit; get M",
     "clear M; barrier CLEAR.TW>HOST.HR; fence; get M"},
    {"host_copies_without_a_barrier", "sync-host", "clear M; fence; get M",
     "clear M; barrier CLEAR.TW>HOST.HR; fence; get M"},
    {"host_turns_to_another_layout", "sync-wrong-layout", "turn M GENERAL>READ; copy M A",
     "turn M GENERAL>READ; turn M READ>GENERAL; put M; copy M A"},
#endif
    // ---- layouts that images do not have
    {"copy_from_another_layout", "sync-wrong-layout", "to M GENERAL>TARGET TOP.0>ALL.RW; copy M A",
     "to M GENERAL>TARGET TOP.0>ALL.RW; to M TARGET>GENERAL ALL.W>ALL.RW; copy M A"},
    {"copy_to_another_layout", "sync-wrong-layout", "to M GENERAL>READ TOP.0>ALL.RW; copy A M",
     "to N GENERAL>READ TOP.0>ALL.RW; copy A M"},
    {"clear_in_another_layout", "sync-wrong-layout", "to M GENERAL>READ TOP.0>ALL.RW; clear M",
     "clear M; to M GENERAL>READ ALL.W>ALL.RW"},
    {"transition_from_another_layout", "sync-wrong-layout", "to M TARGET>GENERAL TOP.0>ALL.RW",
     "to M UNDEFINED>GENERAL TOP.0>ALL.RW"},
    {"rendering_in_another_layout", "sync-wrong-layout", "to M GENERAL>READ TOP.0>ALL.RW; render M; draw; end",
     "to M GENERAL>READ TOP.0>ALL.RW; to M READ>GENERAL ALL.W>ALL.RW; render M; draw; end"},
    {"pass_from_another_layout", "sync-wrong-layout", "pass M CLEAR READ>GENERAL ALL.W>COLOR.CRW -",
     "pass M CLEAR UNDEFINED>GENERAL ALL.W>COLOR.CRW -"},
    {"layout_behind_no_transition", "sync-wrong-layout",
     "to M GENERAL>TARGET TOP.0>ALL.RW; to M UNDEFINED>UNDEFINED ALL.W>ALL.RW; copy M A",
     "to M UNDEFINED>UNDEFINED TOP.0>ALL.RW; copy M A"},
    {"layout_that_others_may_give", "sync-read-after-write", "to X READ>GENERAL TOP.0>CLEAR.TW; clear X; copy X A",
     "to X READ>GENERAL TOP.0>CLEAR.TW; clear X; barrier CLEAR.TW>COPY.TR X; copy X A"},
    // ---- draws
    {"draw_and_copy", "sync-read-after-write", "render M; draw; end; copy M A",
     "render M; draw; end; barrier COLOR.CW>COPY.TR; copy M A"},
    {"draw_and_sample", "sync-read-after-write", "render M; draw; end; sample M",
     "render M; draw; end; barrier COLOR.CW>COMPUTE.SR; sample M"},
    {"clear_and_render", "sync-write-after-write", "clear M; render M; draw; end",
     "clear M; barrier CLEAR.TW>COLOR.CW; render M; draw; end"},
    {"clear_and_load", "sync-read-after-write", "clear M; barrier CLEAR.TW>COLOR.CW; render M LOAD; draw; end",
     "clear M; barrier CLEAR.TW>COLOR.CRW; render M LOAD; draw; end"},
    {"rendering_twice", "sync-write-after-write", "render M; draw; end; render M; draw; end",
     "render M; draw; end; barrier COLOR.CW>COLOR.CW; render M; draw; draw; end"},
    {"rendering_twice_with_load", "sync-read-after-write", "render M; draw; end; render M LOAD; draw; end",
     "render M; draw; end; barrier COLOR.CW>COLOR.CRW; render M LOAD; draw; draw; end"},
    {"contents_given_up", "sync-write-after-read", "copy M A; render M DONT_CARE; draw; end",
     "copy M A; barrier COPY.0>COLOR.0; render M DONT_CARE; draw; end"},
    {"depth_twice", "sync-write-after-write", "depth D; draw; end; depth D; draw; end",
     "depth D; draw; end; barrier TESTS.DW>TESTS.DRW; depth D; draw; end"},
    {"depth_of_late_tests", "sync-write-after-write",
     "depth D; draw; end; barrier EARLY.DW>TESTS.DRW; depth D; draw; end",
     "depth D; draw; end; barrier LATE.DW>TESTS.DRW; depth D; draw; end"},
    {"depth_and_copy", "sync-read-after-write", "depth D; draw; end; barrier COLOR.CW>COPY.TR; copy D A",
     "depth D; draw; end; barrier LATE.DW>COPY.TR; copy D A"},
    {"draw_samples_what_was_drawn", "sync-read-after-write",
     "render M; draw; end; barrier COLOR.CW>VERTEX.0; render N; draw sample M; end",
     "render M; draw; end; barrier COLOR.CW>FRAGMENT.SR; render N; draw sample M; end"},
    {"draw_over_what_is_sampled", "sync-write-after-read", "render N; draw sample M; end; render M; draw; end",
     "render N; draw sample M; end; barrier FRAGMENT.0>COLOR.0; render M; draw; end"},
    {"fragment_store_and_load", "sync-read-after-write", "render M; draw store A; draw load A; end",
     "render M; draw store A; end; barrier FRAGMENT.SW>FRAGMENT.SR; barrier COLOR.CW>COLOR.CRW; render M LOAD; draw "
     "load "
     "A; end"},
    {"vertex_load", "sync-read-after-write", "fill A; barrier CLEAR.TW>FRAGMENT.SR; render M; vertex load A; end",
     "fill A; barrier CLEAR.TW>VERTEX.SR; render M; vertex load A; end"},
    {"vertex_attributes", "sync-read-after-write", "fill A; barrier CLEAR.TW>VERTEX.SR; render M; vertices A; end",
     "fill A; barrier CLEAR.TW>ATTRIBUTE.VR; render M; vertices A; end"},
    {"vertex_attributes_of_other_vertices", "sync-read-after-write", "fill A:8+4; render M; vertices A; end",
     "fill A:12+4; render M; vertices A; end"},
    {"indices", "sync-read-after-write", "fill A:0+12; barrier CLEAR.TW>ATTRIBUTE.VR; render M; indices A; end",
     "fill A:0+12; barrier CLEAR.TW>INPUT.XR; render M; indices A; end"},
    {"indices_that_change", "sync-write-after-read", "render M; indices A; end; fill A",
     "render M; indices A; end; barrier INDEX.0>CLEAR.0; fill A"},
    {"arguments_of_a_draw", "sync-read-after-write",
     "update A:0+16; barrier CLEAR.TW>VERTEX.SR; render M; draws A; end",
     "update A:0+16; barrier CLEAR.TW>INDIRECT.IR; render M; draws A; end"},
    {"attributes_that_change", "sync-write-after-read", "render M; vertices A; end; barrier INDIRECT.0>CLEAR.0; fill A",
     "render M; vertices A; end; barrier VERTEX.0>CLEAR.0; fill A"},
    {"lookup_in_some_level", "sync-read-after-write", "clear L; render M; draw lookup L; end",
     "clear L; barrier CLEAR.TW>FRAGMENT.SR; render M; draw lookup L; end"},
    {"lookup_in_a_level_that_may_be_another", "sync-read-after-write",
     "clear L; barrier CLEAR.TW>COPY.TR; render M; draw lookup L; end", "clear L:1; render M; draw lookup L; end"},
    // ---- rates
    {"rates_are_read", "sync-read-after-write", "clear R; rates M R; draw; end",
     "clear R; barrier CLEAR.TW>RATES.RR; rates M R; draw; draw; end"},
    {"rates_that_no_draw_looks_at", "sync-read-after-write", "clear R; rates M R; draws A; end",
     "clear R; kept M R; draws A; end"},
    {"rates_are_read_before_tests", "sync-read-after-write", "clear R; barrier CLEAR.TW>EARLY.R; rates M R; draw; end",
     "clear R; barrier CLEAR.TW>GRAPHICS.R; rates M R; draw; end"},
    {"rates_that_change", "sync-write-after-read", "rates M R; draw; end; barrier VERTEX.0>CLEAR.0; clear R",
     "rates M R; draw; end; barrier EARLY.0>CLEAR.0; clear R"},
    // ---- render passes
    {"no_dependency_in_front", "sync-layout", "clear M; pass M CLEAR GENERAL>GENERAL - -",
     "clear M; pass M CLEAR GENERAL>GENERAL TRANSFER.TW>COLOR.CW -"},
    {"dependency_of_another_stage", "sync-layout", "clear M; pass M CLEAR UNDEFINED>GENERAL COPY.TW>COLOR.CW -",
     "clear M; pass M CLEAR UNDEFINED>GENERAL TRANSFER.TW>COLOR.CW -"},
    {"no_dependency_behind", "sync-layout", "pass M CLEAR UNDEFINED>GENERAL - -; barrier COLOR.CW>COPY.TR; copy M A",
     "pass M CLEAR UNDEFINED>GENERAL - COLOR.CW>TRANSFER.TR; copy M A"},
    {"dependency_to_another_stage", "sync-layout", "pass M CLEAR UNDEFINED>GENERAL - COLOR.CW>FRAGMENT.SR; copy M A",
     "pass M CLEAR UNDEFINED>GENERAL - COLOR.CW>TRANSFER.TR; copy M A"},
    {"pass_and_load", "sync-read-after-write",
     "render M; end; barrier COLOR.CW>COLOR.CW; pass M LOAD GENERAL>GENERAL - -",
     "render M; end; barrier COLOR.CW>COLOR.CRW; pass M LOAD GENERAL>GENERAL - -"},
    {"semaphore_and_pass", "sync-layout", "clear M; semaphore COLOR; pass M CLEAR UNDEFINED>GENERAL - -",
     "clear M; semaphore COLOR; pass M CLEAR UNDEFINED>GENERAL COLOR.0>COLOR.CW -"},
    {"no_dependency_of_subpasses", "sync-write-after-write", "pass M two", "pass M two COLOR.CW>COLOR.CRW"},
    {"wrong_dependency_of_subpasses", "sync-write-after-write", "pass M two COLOR.CW>FRAGMENT.AR",
     "pass M two COLOR.CW>COLOR|FRAGMENT.CRW|AR"},
};

class ImageHazards : public ::testing::TestWithParam<PlantedHazard> {};

TEST_P(ImageHazards, IsFoundAndItsTwinIsNot) {
  if (!std::getenv("VITRINE_TOOLS")) GTEST_SKIP() << "needs VITRINE_TOOLS=sync";
  expect_hazard(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Sync, ImageHazards, ::testing::ValuesIn(kPlanted),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace vitrine::icd::test
