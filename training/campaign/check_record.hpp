// Whether a record fits the discretisation that it is read for: a file put in the place of another may not.
#pragma once

#include <initializer_list>
#include <string>

#include "training/campaign/campaign_store.hpp"

namespace undula::training {

[[noreturn]] void refuse_record(const std::string& what, const std::string& seen, const std::string& allowed,
                                const std::string& file);

struct RecordField {
  const char* name;
  std::size_t rows;
};

/// Throws InputError unless the record has every field, with so many rows and finite numbers.
void check_fields(const RunRecord& record, std::initializer_list<RecordField> fields,
                  const std::string& file);

} // namespace undula::training
