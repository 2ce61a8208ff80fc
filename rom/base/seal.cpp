#include "rom/base/seal.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>
#include <vector>

#include "rom/base/error.hpp"

namespace undula {
namespace {

constexpr std::string_view first_words = "Undula file, sealed: ";

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

std::string seal_text(std::uint64_t length, std::uint64_t digest) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(),
                "%s%llu bytes follow, digest %016llx\nHDF5; docs/data.md explains\n", first_words.data(),
                static_cast<unsigned long long>(length), static_cast<unsigned long long>(digest));
  std::string seal = text.data();
  seal.resize(seal_size, '\0');
  return seal;
}

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
  state = (state ^ word) * 0x9e3779b97f4a7c15ULL;
  return state ^ (state >> 32);
}

} // namespace

void Digest::add(std::span<const std::byte> bytes) {
  length_ += bytes.size();
  while (!bytes.empty()) {
    const auto count = std::min<std::size_t>(8, bytes.size());
    std::uint64_t word = 0;
    if (count == 8 && std::endian::native == std::endian::little)
      std::memcpy(&word, bytes.data(), 8);
    else
      for (std::size_t i = 0; i < count; ++i) word |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    state_ = mixed(state_, word);
    bytes = bytes.subspan(count);
  }
}

std::uint64_t Digest::value() const { return mixed(state_, length_); }

std::string seal_of(std::span<const std::byte> content) {
  Digest digest;
  digest.add(content);
  return seal_text(content.size(), digest.value());
}

Seal check_seal(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string seal(seal_size, '\0');
  in.read(seal.data(), static_cast<std::streamsize>(seal.size()));
  if (!seal.starts_with(first_words)) {
    std::string signature(hdf5_signature.size(), '\0');
    in.read(signature.data(), static_cast<std::streamsize>(signature.size()));
    if (in && signature == hdf5_signature)
      throw InputError("the file is damaged: it has lost its seal", "an HDF5 file behind 512 other bytes",
                       "an undamaged copy; other programs may read the file but not write it", file.string());
    return Seal::missing;
  }
  Digest digest;
  std::uint64_t length = 0;
  std::vector<std::byte> piece(1 << 20);
  while (in) {
    in.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(in.gcount());
    digest.add({piece.data(), count});
    length += count;
  }
  if (in.bad())
    throw InputError("cannot read file", "an error of the disk", "a readable file", file.string());
  if (seal == seal_text(length, digest.value())) return Seal::intact;
  const std::string words = seal.c_str(); // up to the first zero
  throw InputError("the file is damaged: it is not as it was written",
                   std::to_string(seal_size + length) + " bytes that do not fit their seal, " +
                       words.substr(0, words.find('\n')),
                   "an undamaged copy (truncated files and flipped bits break the seal)", file.string());
}

} // namespace undula
