// Replaces the cases by ones that must fail in known ways.
#pragma once

namespace vitrine::cts {

void register_self_test();

}  // namespace vitrine::cts
