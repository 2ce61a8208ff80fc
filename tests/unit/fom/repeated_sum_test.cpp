// Sums of triplets into one matrix, again and again.
#include <gtest/gtest.h>

#include <random>

#include "fom/assembly/sparse.hpp"

namespace undula::fom {
namespace {

Triplets random_entries(int size, int count, int seed, double scale) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(0, size - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  Triplets entries;
  for (int k = 0; k < count; ++k) {
    const int row = place(random), column = place(random);
    entries.emplace_back(row, column, scale * value(random));
  }
  return entries;
}

bool same(const SparseMatrix& a, const SparseMatrix& b) {
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

TEST(RepeatedSum, IsTheSumBitForBit) {
  RepeatedSum repeated;
  SparseMatrix matrix;
  for (const double scale : {1.0, 0.3, -1e7}) { // the same places
    const auto entries = random_entries(20, 900, 1, scale);
    repeated.sum(20, entries, matrix);
    EXPECT_TRUE(same(matrix, compress(20, entries)));
  }
  for (const int seed : {2, 3}) { // other places, and other sizes
    const auto entries = random_entries(18 + seed, 900, seed, 1.0);
    repeated.sum(18 + seed, entries, matrix);
    EXPECT_TRUE(same(matrix, compress(18 + seed, entries)));
  }
  repeated.sum(21, {}, matrix);
  EXPECT_EQ(matrix.nonZeros(), 0);
}

} // namespace
} // namespace undula::fom
