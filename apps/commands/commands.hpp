// The subcommands of undula. Each function adds one to the command line; its work is done when the line is
// parsed.
#pragma once

#include <CLI/CLI.hpp>

namespace undula::apps {

void add_check_command(CLI::App& app);
void add_solve_command(CLI::App& app);
void add_train_command(CLI::App& app);
void add_hq_command(CLI::App& app);
void add_period_command(CLI::App& app);
void add_validate_command(CLI::App& app);
void add_calibrate_command(CLI::App& app);
void add_report_command(CLI::App& app);
void add_show_command(CLI::App& app);
void add_study_command(CLI::App& app);
/// Where the program is built with cpp-httplib.
void add_explore_command(CLI::App& app);
void add_new_command(CLI::App& app);
void add_schema_command(CLI::App& app);
void add_completion_command(CLI::App& app);

} // namespace undula::apps
