// The command `vitrine`: its options, through CLI11.
#include <CLI/CLI.hpp>

#include <exception>

#include "glass/cli/application.h"
#include "glass/cli/bug_options.h"
#include "glass/cli/commands.h"
#include "glass/cli/say.h"
#include "glass/version.h"

namespace vitrine::glass::cli {
namespace {

constexpr char kApplication[] = "[--] APPLICATION [ARGUMENTS...]";
/// Tools that find faults: what `check` asks for without further words, as far as they are there.
constexpr const char* kFinders[] = {"sanitize", "race", "sync"};

/// Usage lines end with what the subcommand takes.
class Help : public CLI::Formatter {
 public:
  explicit Help(std::string operands) : operands_(std::move(operands)) {}
  std::string make_usage(const CLI::App* app, std::string name) const override {
    return "Usage: " + name + " [OPTIONS] " + (app->get_subcommands({}).empty() ? operands_ : "COMMAND ...") + "\n";
  }

 private:
  std::string operands_;
};

/// A subcommand that runs an application: whatever follows its options belongs to that.
CLI::App* add_runner(CLI::App& app, const char* name, const char* text) {
  CLI::App* command = app.add_subcommand(name, text);
  command->prefix_command();
  command->formatter(std::make_shared<Help>(kApplication));
  return command;
}

/// The command line in two: CLI11 does not hand on what stands behind "--".
struct Words {
  std::vector<std::string> ours, behind;
  bool divided = false;  ///< there is a "--"
};

Words split(const std::vector<std::string>& line) {
  Words words;
  for (const std::string& word : line) {
    if (words.divided)
      words.behind.push_back(word);
    else if (word == "--")
      words.divided = true;
    else
      words.ours.push_back(word);
  }
  return words;
}

/// What stands behind the options, with or without "--"; a later "--" belongs to the application.
CommandLine application_of(const CLI::App& command, const Words& words) {
  CommandLine application = command.remaining();
  if (!application.empty() && words.divided) application.emplace_back("--");
  application.insert(application.end(), words.behind.begin(), words.behind.end());
  if (application.empty()) throw CLI::RequiredError("APPLICATION");
  return application;
}

void add_run(CLI::App& app, const Words& words, int& code) {
  CLI::App* command = add_runner(app, "run", "Run an application on this driver");
  command->callback([=, &words, &code] { code = run(application_of(*command, words)); });
}

void add_tools(CheckOptions& options, const std::string& list) {
  for (const std::string& tool : CLI::detail::split(list, ',')) options.tools.push_back(tool);
}

void add_check(CLI::App& app, const Words& words, CheckOptions& options, int& code) {
  CLI::App* command = add_runner(app, "check", "Run it with tools that find faults; exit code 1 if there are any");
  for (const char* const tool : kFinders) {
    command->add_flag_callback(
        "--" + std::string(tool), [&options, tool] { options.tools.push_back(tool); },
        "With this tool (none named: all that are there)");
  }
  command
      ->add_option_function<std::string>(
          "--tools", [&options](const std::string& list) { add_tools(options, list); }, "With these, comma-separated")
      ->type_name("LIST");
  command
      ->add_option_function<std::string>(
          "--invocation", [&options](const std::string& one) { options.invocations += one + ";"; },
          "Messages of this invocation alone, as compute:5,0,0, fragment:3,7 or vertex:2; may be repeated")
      ->type_name("STAGE:NUMBERS")
      ->trigger_on_parse();
  command->add_option("--sarif", options.sarif, "Write the findings as SARIF 2.1.0")->type_name("FILE");
  command->add_option("--json", options.json, "Write the findings as JSON")->type_name("FILE");
  command->add_option("--code-quality", options.code_quality, "Write the findings as GitLab's report of code quality")
      ->type_name("FILE");
  command->add_option("--bugs", options.bugs, "Write the draws and dispatches in which something is found as bug files")
      ->type_name("FOLDER");
  command->add_flag("--annotations", options.annotations, "Print the findings as commands for GitHub's runners, too");
  command->add_flag("-q,--quiet", options.quiet, "Print the summary alone");
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    for (const char* const tool : kFinders) {
      if (command->count("--tools") == 0 && options.tools.empty() && is_tool(tool)) options.tools.push_back(tool);
    }
    code = check(options);
  });
}

/// A number of percent, with or without the sign.
std::string without_sign(std::string text) {
  if (text.ends_with('%')) text.pop_back();
  return text;
}

void add_coverage(CLI::App& app, const Words& words, CoverageOptions& options, int& code) {
  CLI::App* command = add_runner(app, "coverage", "Run it and write which lines of its shaders ran");
  command->add_option("-o,--output", options.output, "lcov tracefile")->type_name("FILE")->capture_default_str();
  command->add_flag("-a,--append", options.append, "Add to what the file has");
  command->add_option("--sources", options.sources, "Folder for sources that are in the modules alone")
      ->type_name("FOLDER");
  command->add_option("--min-lines", options.least_lines, "Exit code 1 if fewer lines have run")
      ->transform(without_sign)
      ->type_name("PERCENT");
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    code = coverage(options);
  });
}

void add_count(CLI::App& app, const Words& words, CountOptions& options, int& code) {
  CLI::App* command = add_runner(app, "count", "Run it and write what its shaders cost, in numbers that do not move");
  command->add_option("-o,--output", options.output, "Counters as JSON")->type_name("FILE");
  command->add_flag("--lines", options.lines, "Print the sources, with the instructions that each line ran");
  command->add_flag("--draws", options.draws, "Write what became of each draw's primitives and fragments to the file");
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    code = count(options);
  });
}

void add_timeline(CLI::App& app, const Words& words, TimelineOptions& options, int& code) {
  CLI::App* command = add_runner(app, "timeline", "Run it and write when what ran, for Perfetto");
  command->add_option("-o,--output", options.output, "Chrome trace events")->type_name("FILE")->capture_default_str();
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    code = timeline(options);
  });
}

void add_shake(CLI::App& app, const Words& words, ShakeOptions& options, int& code) {
  CLI::App* command =
      add_runner(app, "shake", "Run it several times, in other orders that are legal, and say where the results part");
  command->add_option("--seed", options.seed, "Run it once, with the choices that follow from this")
      ->type_name("NUMBER");
  command->add_option("--runs", options.runs, "How many seeds to try")->type_name("NUMBER")->capture_default_str();
  command->add_option("--kinds", options.kinds, "What to shake, comma-separated: order, delays, poison, errors")
      ->type_name("LIST");
  command->add_option("--sarif", options.sarif, "Write what was found as SARIF 2.1.0")->type_name("FILE");
  command->add_option("--json", options.json, "Write what was found as JSON")->type_name("FILE");
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    code = shake(options);
  });
}

void add_pixel(CLI::App& app, const Words& words, PixelOptions& options, int& code) {
  CLI::App* command =
      add_runner(app, "pixel", "Run it and tell everything that touched a pixel, backwards to its sources");
  command->formatter(std::make_shared<Help>("X,Y " + std::string(kApplication)));
  command->add_option("PIXEL", options.position, "Column and row, counted from 0")->required()->type_name("X,Y");
  command->add_option("--image", options.image, "Image: swapchain, its debug name, or #N: the N-th that was made")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--frame", options.frame, "As presented in this frame, counted from 1 (default: the last one)")
      ->type_name("N");
  command->add_option("--submission", options.submission, "As this submission leaves it")->type_name("N");
  command->add_option("--layer", options.layer, "Array layer")->type_name("N");
  command->add_option("--level", options.level, "Mip level")->type_name("N");
  command->add_option("--slice", options.slice, "Slice of a 3D image")->type_name("N");
  command->add_option("--sample", options.sample, "Sample (default: all)")->type_name("N");
  command->add_option("--aspect", options.aspect, "color, depth, stencil, plane0, plane1 or plane2")->type_name("NAME");
  command->add_option("--depth", options.depth, "How far sources of sources are followed, a run each")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--why-not", options.primitive,
                   "What became of the primitives with this gl_PrimitiveID (of all instances, or one)")
      ->type_name("N[@INSTANCE]");
  command->add_option("--json", options.json, "Write what the driver recorded")->type_name("FILE");
  command->add_option("--html", options.html, "Write the histories as a page")->type_name("FILE");
  command->add_option("--bug", options.bug, "Write the draw or dispatch that made the value as a bug file")
      ->type_name("FILE");
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    code = pixel(options);
  });
}

void add_debug(CLI::App& app, const Words& words, DebugOptions& options, int& code) {
  CLI::App* command = add_runner(app, "debug", "Run it and stop its shaders: a prompt, or a server for an editor");
  command->add_option("-x,--script", options.script, "Commands, before those that are typed")->type_name("FILE");
  command->add_flag("--json", options.json, "Print stops and answers as lines of JSON");
  command->add_flag("--exact", options.exact, "Show the shader as it always runs, not one that keeps all variables");
  command->add_option("--dap", options.port, "Wait for an editor at this port of the loopback interface (0: any)")
      ->type_name("PORT");
  command->callback([=, &words, &options, &code] {
    options.application = application_of(*command, words);
    code = debug(options);
  });
}

void add_diff(CLI::App& app, DiffOptions& options, int& code) {
  CLI::App* command = app.add_subcommand("diff", "Compare two files of counters");
  command->formatter(std::make_shared<Help>("BEFORE AFTER"));
  command->add_option("BEFORE", options.before, "Counters as JSON")->required()->type_name("FILE");
  command->add_option("AFTER", options.after, "Counters as JSON")->required()->type_name("FILE");
  command->add_option("--max", options.most_growth, "Exit code 1 if a counter has grown by more")
      ->transform(without_sign)
      ->type_name("PERCENT");
  command->add_option("--counters", options.pattern, "Only counters whose names match, as the shell matches files")
      ->type_name("PATTERN")
      ->capture_default_str();
  command->callback([&] { code = diff(options); });
}

/// CLI11 says of a word that is no command that a command is missing.
void check_command(const CLI::App& app, const Words& words) {
  if (words.ours.empty() || words.ours[0].starts_with('-')) return;
  if (app.get_subcommands([&](const CLI::App* command) { return command->get_name() == words.ours[0]; }).empty())
    throw CLI::ValidationError("vitrine", "there is no command '" + words.ours[0] + "'");
}

int main_of(const std::vector<std::string>& line) {
  CLI::App app{"Runs applications on the Vulkan driver Vitrine, and tells what their shaders do.", "vitrine"};
  app.formatter(std::make_shared<Help>("COMMAND ..."));
  app.set_version_flag("--version", std::string("vitrine ") + kVersion);
  app.require_subcommand(1);
  const Words words = split(line);
  int code = 0;
  CheckOptions check_options;
  CoverageOptions coverage_options;
  CountOptions count_options;
  TimelineOptions timeline_options;
  ShakeOptions shake_options;
  PixelOptions pixel_options;
  DebugOptions debug_options;
  DiffOptions diff_options;
  BugOptions bug_options;
  add_run(app, words, code);
  add_check(app, words, check_options, code);
  add_coverage(app, words, coverage_options, code);
  add_count(app, words, count_options, code);
  add_timeline(app, words, timeline_options, code);
  add_shake(app, words, shake_options, code);
  add_pixel(app, words, pixel_options, code);
  add_debug(app, words, debug_options, code);
  add_diff(app, diff_options, code);
  add_bug_commands(app, bug_options, main_of, code);
  try {
    check_command(app, words);
    app.parse(std::vector<std::string>(words.ours.rbegin(), words.ours.rend()));  // the last one first
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kCouldNotRun;
  }
  return code;
}

}  // namespace
}  // namespace vitrine::glass::cli

int main(int argc, char** argv) try {
  return vitrine::glass::cli::main_of({argv + 1, argv + argc});
} catch (const std::exception& error) {  // the system gives no memory, or no thread
  vitrine::glass::cli::say(error.what());
  return vitrine::glass::cli::kCouldNotRun;
}
