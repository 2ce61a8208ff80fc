# Writes the header OUTPUT with the version and the commit of the checkout SOURCE; run by every build.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once
namespace undula {
inline constexpr const char* build_version = "@VERSION@";
inline constexpr const char* build_commit = "@commit@";
} // namespace undula
]])
