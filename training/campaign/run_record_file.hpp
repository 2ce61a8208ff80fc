// One run record as an HDF5 file.
#pragma once

#include <filesystem>
#include <string>

#include "training/campaign/campaign_store.hpp"

namespace undula::training {

/// Writes the file in one step. Throws InputError for a record whose shapes disagree.
void write_run_record(const RunRecord& record, const std::string& campaign_hash,
                      const std::filesystem::path& file);

/// Throws InputError for a missing, truncated or foreign file, and for one of another campaign.
RunRecord read_run_record(const std::filesystem::path& file, const std::string& campaign_hash);

/// Checks everything but the numbers. Throws as read_run_record does.
void check_run_record(const std::filesystem::path& file, const std::string& campaign_hash);

} // namespace undula::training
