// The two kinds of failure a user meets, and the exit codes that belong to them.
#pragma once

#include <stdexcept>
#include <string>

namespace undula {

/// Wrong input (scene, profile, mesh, data or model file). Exit code 2.
/// The message has four parts: what is wrong, the value seen, what is allowed, where to change it.
class InputError : public std::runtime_error {
public:
  InputError(const std::string& what_is_wrong, const std::string& value_seen, const std::string& allowed,
             const std::string& where)
      : std::runtime_error(what_is_wrong + "\n  seen:    " + value_seen + "\n  allowed: " + allowed +
                           "\n  where:   " + where) {}
};

/// The numerics failed (singular system, divergence, non-finite state). Exit code 1.
/// States what failed, at which step, time and place, and what to try.
class NumericsError : public std::runtime_error {
public:
  NumericsError(const std::string& what_failed, const std::string& step_time_place,
                const std::string& what_to_try)
      : std::runtime_error(what_failed + "\n  at:  " + step_time_place + "\n  try: " + what_to_try) {}
};

} // namespace undula
