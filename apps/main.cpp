// undula: head-flow curves of pumps with moving walls. Exit codes: 0 done, 1 the numerics or the
// disk failed, or it was stopped, 2 wrong input.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <new>

#include "apps/commands/commands.hpp"
#include "apps/output/version_text.hpp"
#include "apps/standard_streams.hpp"
#include "rom/base/error.hpp"

namespace {

constexpr int numerics_failed = 1;
constexpr int wrong_input = 2;

int fail(const std::exception& error, int exit_code) {
  std::fprintf(stderr, "undula: %s\n", error.what());
  return exit_code;
}

} // namespace

int main(int argc, char** argv) {
  undula::apps::open_standard_streams();

  // 1. Logs go to stderr: stdout is for results.
  spdlog::set_default_logger(spdlog::stderr_color_mt("undula"));
  spdlog::set_pattern("%^%l%$: %v");

  // 2. The command line.
  CLI::App app("Undula predicts the head-flow curve of pumps with moving walls.", "undula");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::function<std::string()>(undula::apps::version_text),
                       "print the version, the commit and those of libraries");
  undula::apps::add_check_command(app);
  undula::apps::add_solve_command(app);
  undula::apps::add_train_command(app);
  undula::apps::add_hq_command(app);
  undula::apps::add_period_command(app);
  undula::apps::add_validate_command(app);
  undula::apps::add_calibrate_command(app);
  undula::apps::add_report_command(app);
  undula::apps::add_study_command(app);
  undula::apps::add_show_command(app);
#ifdef UNDULA_WITH_EXPLORER
  undula::apps::add_explore_command(app);
#endif
  undula::apps::add_new_command(app);
  undula::apps::add_schema_command(app);
  undula::apps::add_completion_command(app);

  // 3. Run; every failure becomes one message and an exit code.
  try {
    try {
      app.parse(argc, argv);
    } catch (const CLI::RuntimeError& told_elsewhere) {
      return told_elsewhere.get_exit_code(); // rank 0 prints the message
    } catch (const CLI::ParseError& error) {
      if (app.exit(error) != 0) return wrong_input; // --help ends here with 0
    }
    undula::apps::check_stdout();
  } catch (const undula::InputError& error) {
    return fail(error, wrong_input);
  } catch (const std::bad_alloc&) {
    std::fprintf(
        stderr,
        "undula: the memory is not enough\n  at:  this computation\n  try: larger element sizes (undula "
        "check says how many cells they give), or a machine with more memory\n");
    return numerics_failed;
  } catch (const std::exception& error) {
    return fail(error, numerics_failed);
  }
  return 0;
}
