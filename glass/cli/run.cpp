// vitrine run: the application on this driver, nothing else.
#include "glass/cli/application.h"
#include "glass/cli/commands.h"

namespace vitrine::glass::cli {

int run(const CommandLine& application) { return run_application(application).code; }

}  // namespace vitrine::glass::cli
