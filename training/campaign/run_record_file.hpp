// One run record as an HDF5 file.
#pragma once

#include <filesystem>
#include <string>

#include "training/campaign/campaign_store.hpp"

namespace undula::training {

/// Writes the file in one step. Throws InputError for a record whose shapes disagree.
void write_run_record(const RunRecord& record, const std::string& campaign_hash,
                      const std::filesystem::path& file);

/// Throws InputError for a missing, damaged or foreign file, for one of another campaign and for a record of
/// another point or whose shapes disagree.
RunRecord read_run_record(const std::filesystem::path& file, const std::string& campaign_hash,
                          const OperatingPoint& point, RecordParts parts = RecordParts::all);

/// Checks everything but the shapes of the snapshots. Throws as read_run_record does.
void check_run_record(const std::filesystem::path& file, const std::string& campaign_hash,
                      const OperatingPoint& point);

/// The point of a record. Throws InputError for a missing, damaged or foreign file.
OperatingPoint point_of_record(const std::filesystem::path& file, const std::string& campaign_hash);

/// Whether both are the same point, bit for bit.
bool same_point(const OperatingPoint& a, const OperatingPoint& b);

} // namespace undula::training
