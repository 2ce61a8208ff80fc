// Entry point of the test executables that use MPI, PETSc or SLEPc. Runs on any number of ranks.
#include <gtest/gtest.h>
#include <slepcsys.h>

#include <cstdio>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  // Listing happens before every ctest run; it needs no MPI.
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();
  if (SlepcInitialize(&argc, &argv, nullptr, nullptr) != 0) return 1;
  // Failures are to surface as exceptions and return codes, not as PETSc's own handling of signals.
  PetscPopSignalHandler();
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  // One report is enough; a failure on another rank still prints its own assertion below.
  if (rank != 0) delete listeners.Release(listeners.default_result_printer());
  struct FailurePrinter : testing::EmptyTestEventListener {
    int rank = 0;
    void OnTestPartResult(const testing::TestPartResult& part) override {
      if (!part.failed() || rank == 0) return;
      std::fprintf(stderr, "rank %d: %s:%d: %s\n", rank, part.file_name() ? part.file_name() : "?",
                   part.line_number(), part.message());
    }
  };
  auto* printer = new FailurePrinter; // owned by the listeners
  printer->rank = rank;
  listeners.Append(printer);
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  SlepcFinalize();
  return failed;
}
