// The seal in front of every HDF5 file: how long the rest is, and a digest of it. Whatever changes a file
// after it was written (a flipped bit, lost or exchanged blocks, another program) breaks it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace undula {

/// 64-bit digest of a sequence of bytes, fixed by its definition on every machine: every word of eight bytes
/// (little-endian, the last one filled up with zeros) is joined by h = (h xor word) * golden ratio, h = h xor
/// (h >> 32), and so is the length at the end. Every step is invertible, so that one changed word always
/// changes it. It finds accidents, not forgery.
class Digest {
public:
  /// All calls but the last need a multiple of eight bytes.
  void add(std::span<const std::byte> bytes);
  std::uint64_t value() const;

private:
  std::uint64_t state_ = 0x9ae16a3b2f90404fULL, length_ = 0;
};

/// Length of the seal in bytes: the smallest user block of an HDF5 file, which readers skip.
inline constexpr std::size_t seal_size = 512;

/// Two lines of text that name length and digest of `content`, filled up with zeros to seal_size.
std::string seal_of(std::span<const std::byte> content);

enum class Seal {
  intact,
  missing ///< the file does not begin with a seal: made by another program or an older version
};

/// Compares a file with its seal, bit for bit. Throws InputError where they differ, where room for a seal is
/// left and none is in it, and where the file cannot be read.
Seal check_seal(const std::filesystem::path& file);

} // namespace undula
