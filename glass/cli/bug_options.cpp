// See bug_options.h.
#include "glass/cli/bug_options.h"

namespace vitrine::glass::cli {
namespace {

/// Usage lines end with what the subcommand takes.
class Usage : public CLI::Formatter {
 public:
  explicit Usage(std::string operands) : operands_(std::move(operands)) {}
  std::string make_usage(const CLI::App*, std::string name) const override {
    return "Usage: " + name + " [OPTIONS] " + operands_ + "\n";
  }

 private:
  std::string operands_;
};

void add_replay(CLI::App& app, ReplayOptions& options, Main main, int& code) {
  CLI::App* command = app.add_subcommand("replay", "Run the draw or dispatch of a bug file, under any other command");
  command->formatter(std::make_shared<Usage>("FILE [COMMAND [OPTIONS]]"));
  command->prefix_command();
  command->add_option("FILE", options.file, "Bug file")->required()->type_name("FILE");
  command
      ->add_option("--driver", options.driver, "On another driver: its manifest, as /usr/share/vulkan/icd.d has them")
      ->type_name("FILE");
  command->callback([=, &options, &code] {
    options.words = command->remaining();
    code = options.driver.empty() ? main(replay_words(options)) : replay_elsewhere(options);
  });
}

void add_reduce(CLI::App& app, ReduceOptions& options, int& code) {
  CLI::App* command = app.add_subcommand("reduce", "Make a bug file smaller, as long as what was found stays");
  command->formatter(std::make_shared<Usage>("FILE -o SMALLER"));
  command->add_option("FILE", options.file, "Bug file")->required()->type_name("FILE");
  command->add_option("-o,--output", options.output, "The smaller one")->type_name("FILE");
  command->add_option("--tools", options.tools, "Tools that find it, comma-separated")
      ->type_name("LIST")
      ->capture_default_str();
  command->add_option("--rule", options.rule, "What is to stay (default: the first finding of the file)")
      ->type_name("RULE");
  command->add_flag("--any-place", options.any_place, "The rule may move to another place in the source");
  command->add_option("--runs", options.runs, "At most so many replays, and as many of each shader")
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_flag_callback(
      "--keep-shaders", [&options] { options.shaders = false; }, "Leave shaders as they are");
  command->add_option("--stage", options.stage)->group("");
  command->add_option("WORDS", options.words)->group("");
  command->callback([&options, &code] { code = reduce(options); });
}

void add_export(CLI::App& app, ExportOptions& options, int& code) {
  CLI::App* command = app.add_subcommand("export", "Write a bug file for other programs");
  command->formatter(std::make_shared<Usage>("FILE"));
  command->add_option("FILE", options.file, "Bug file")->required()->type_name("FILE");
  command->add_option("--amber", options.amber, "As AmberScript, with its data")->type_name("FILE");
  command->add_option("--files", options.files, "State as JSON, shaders, bytes of buffers")->type_name("FOLDER");
  command->add_option("-o,--output", options.output, "As a bug file")->type_name("FILE");
  command->add_flag_callback(
      "--no-names", [&options] { options.names = false; },
      "Without names of objects, labels, and names and sources in shaders");
  command->callback([&options, &code] { code = export_bug(options); });
}

}  // namespace

void add_bug_commands(CLI::App& app, BugOptions& options, Main main, int& code) {
  add_replay(app, options.replay, main, code);
  add_reduce(app, options.reduce, code);
  add_export(app, options.exported, code);
}

}  // namespace vitrine::glass::cli
