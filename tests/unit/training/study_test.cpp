// Plans and records of studies.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>

#include "fom/scene/scene_file.hpp"
#include "rom/base/error.hpp"
#include "training/study/run_study.hpp"

namespace undula::training {
namespace {

Scene hose() { return read_scene(UNDULA_SOURCE_DIR "/data/scenes/peristaltic_pump.toml", {}); }

std::string refusal(const std::vector<StudyRange>& ranges, int points = 10) {
  try {
    plan_study(hose(), ranges, points);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StudyPlan, AFullPlanHasEveryValueWithEveryOther) {
  const auto plan = plan_study(
      hose(), std::vector<StudyRange>{{"rollers.occlusion", 0.6, 0.9, 4}, {"rollers.count", 1, 3, 3}}, 0);
  EXPECT_TRUE(plan.full);
  ASSERT_EQ(plan.points.size(), 12u);
  EXPECT_EQ(plan.points.front(), (std::vector<double>{0.6, 1}));
  EXPECT_EQ(plan.points.back(), (std::vector<double>{0.9, 3})); // to the last bit
  EXPECT_EQ(std::set<std::vector<double>>(plan.points.begin(), plan.points.end()).size(), 12u);
}

TEST(StudyPlan, MorePointsKeepTheEarlierOnes) {
  const std::vector<StudyRange> ranges = {{"rollers.occlusion", 0.6, 0.9}, {"hose.bore_mm", 24, 40}};
  const auto few = plan_study(hose(), ranges, 8), many = plan_study(hose(), ranges, 64);
  EXPECT_FALSE(few.full);
  EXPECT_TRUE(std::equal(few.points.begin(), few.points.end(), many.points.begin()));
  // Space-filling: every quarter of either range holds about a quarter of the points.
  for (std::size_t key = 0; key < 2; ++key)
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto& range = ranges[key];
      const auto inside = std::ranges::count_if(many.points, [&](const auto& point) {
        const double part = (point[key] - range.low) / (range.high - range.low);
        return part > quarter / 4.0 && part <= (quarter + 1) / 4.0;
      });
      EXPECT_NEAR(static_cast<double>(inside), 16, 3);
    }
}

TEST(StudyPlan, WrongRangesAreRefused) {
  EXPECT_NE(refusal({}).find("too few or too many keys"), std::string::npos);
  EXPECT_NE(refusal({{"rollers.occlusion", 0.9, 0.6}}).find("low < high"), std::string::npos);
  EXPECT_NE(refusal({{"rollers.oclusion", 0.6, 0.9}}).find("\"rollers.occlusion\""), std::string::npos);
  EXPECT_NE(refusal({{"hose.bore_cm", 2, 3}}).find("\"hose.bore_mm\""), std::string::npos);
  EXPECT_NE(refusal({{"rollers.occlusion", 0.6, 1.5}}).find("a number in (0, 1]"), std::string::npos);
  EXPECT_NE(refusal({{"membrane.young_dyn_per_cm2", 1e6, 1e7}}).find("wave pump"), std::string::npos);
  EXPECT_NE(refusal({{"model.space", 0, 1}}).find("no number"), std::string::npos);
  EXPECT_NE(refusal({{"rollers.count", 1, 3}}).find("full plan"), std::string::npos);
  EXPECT_NE(refusal({{"rollers.count", 1, 4, 3}}).find("2.5"), std::string::npos);
  EXPECT_NE(refusal({{"rollers.occlusion", 0.6, 0.9, 3}, {"hose.bore_mm", 24, 40}}).find("neither full"),
            std::string::npos);
  EXPECT_NE(refusal({{"rollers.occlusion", 0.6, 0.9}, {"rollers.occlusion", 0.6, 0.8}}).find("twice"),
            std::string::npos);
  EXPECT_NE(refusal({{"rollers.occlusion", 0.6, 0.9}}, 0).find("--points"), std::string::npos);
  EXPECT_NE(
      refusal({{"rollers.occlusion", 0.6, 0.9, 1000}, {"hose.bore_mm", 24, 40, 1000}}).find("too many runs"),
      std::string::npos);
}

class Study : public testing::Test {
protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() / ("undula_study_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static Scene at(const std::vector<double>& values) {
    return read_scene(UNDULA_SOURCE_DIR "/data/scenes/peristaltic_pump.toml",
                      std::vector<std::string>{"rollers.occlusion=" + std::to_string(values[0]),
                                               "time.steps_per_period=24", "time.periods=3"});
  }

  std::filesystem::path folder;
  const StudyPlan plan = plan_study(hose(), std::vector<StudyRange>{{"rollers.occlusion", 0.5, 0.9, 5}}, 0);
  const SceneStamp stamp = stamp_study(hose(), plan.keys);
};

TEST_F(Study, GoesOnWithWhatIsMissingAndComputesNothingTwice) {
  const StudyStore store(folder, stamp);
  int started = 0;
  const auto counted = [&](const std::vector<double>& values) {
    ++started;
    return at(values);
  };
  // Stopped in the third run.
  struct Stop {};
  EXPECT_THROW(run_study(plan, counted, store, 1, MPI_COMM_SELF, {},
                         [&](MPI_Comm) {
                           if (started == 3) throw Stop();
                         }),
               Stop);
  EXPECT_EQ(store.pending(plan).size(), 3u);
  const auto kept = store.load(plan.points[0]);
  const StudyStore again(folder, stamp);
  run_study(plan, counted, again, 1, MPI_COMM_SELF, {});
  EXPECT_EQ(started, 3 + 3);
  EXPECT_TRUE(again.pending(plan).empty());
  EXPECT_EQ(again.load(plan.points[0]).quantities.front().value, kept.quantities.front().value);
  // A higher occlusion pumps more.
  double before = 0;
  for (const auto& values : plan.points) {
    const StudyRecord record = again.load(values);
    EXPECT_EQ(record.values, values);
    EXPECT_EQ(record.quantities.front().name, "flow_l_per_min");
    EXPECT_GT(record.quantities.front().value, before);
    before = record.quantities.front().value;
  }
}

TEST_F(Study, FailuresAndRefusalsAreRecords) {
  const StudyStore store(folder, stamp);
  run_study(plan,
            [&](const std::vector<double>& values) {
              if (values[0] < 0.55) throw InputError("a roller does not fit", "0.5", "more", "[rollers]");
              if (values[0] > 0.85) throw NumericsError("no outflow", "step 3", "shorter steps");
              return at(values);
            },
            store, 1, MPI_COMM_SELF, {});
  EXPECT_TRUE(store.pending(plan).empty());
  const auto refused = store.load(plan.points.front()), failed = store.load(plan.points.back());
  EXPECT_EQ(refused.state, "refused");
  EXPECT_EQ(refused.reason, "a roller does not fit; seen:    0.5; allowed: more; where:   [rollers]");
  EXPECT_TRUE(refused.quantities.empty());
  EXPECT_EQ(failed.state, "failed");
  EXPECT_TRUE(failed.quantities.empty());
  EXPECT_FALSE(store.load(plan.points[2]).quantities.empty());
}

TEST_F(Study, DamagedRecordsCountAsNotDone) {
  const StudyStore store(folder, stamp);
  run_study(plan, at, store, 1, MPI_COMM_SELF, {});
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename() == "0.5.h5") std::filesystem::resize_file(entry.path(), 1000);
  std::vector<std::string> damaged;
  const StudyStore reopened(folder, stamp);
  EXPECT_EQ(reopened.pending(plan, &damaged), std::vector<std::size_t>{0});
  EXPECT_EQ(damaged.size(), 1u);
}

TEST_F(Study, AFolderBelongsToOneSceneAndItsKeys) {
  { const StudyStore store(folder, stamp); }
  Scene other = hose();
  other.fluid.viscosity *= 2;
  try {
    const StudyStore store(folder, stamp_study(other, plan.keys));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("fluid.viscosity_poise"), std::string::npos) << error.what();
  }
  const std::vector<std::string> keys = {"hose.bore_mm"};
  EXPECT_THROW(StudyStore(folder, stamp_study(hose(), keys)), InputError);
  Scene longer = hose();
  longer.time.periods += 1;
  EXPECT_THROW(StudyStore(folder, stamp_study(longer, plan.keys)), InputError);
}

TEST(StudyMpi, RanksShareThePlan) {
  int rank = 0, process = static_cast<int>(::getpid());
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Bcast(&process, 1, MPI_INT, 0, MPI_COMM_WORLD);
  const auto folder =
      std::filesystem::temp_directory_path() / ("undula_study_mpi_" + std::to_string(process));
  const auto plan = plan_study(hose(), std::vector<StudyRange>{{"rollers.occlusion", 0.5, 0.9, 9}}, 0);
  const SceneStamp stamp = stamp_study(hose(), plan.keys);
  std::optional<StudyStore> store;
  if (rank == 0) store.emplace(folder, stamp);
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank != 0) store.emplace(folder, stamp);
  int computed = 0;
  run_study(plan,
            [&](const std::vector<double>& values) {
              ++computed;
              return read_scene(UNDULA_SOURCE_DIR "/data/scenes/peristaltic_pump.toml",
                                std::vector<std::string>{"rollers.occlusion=" + std::to_string(values[0]),
                                                         "time.steps_per_period=96", "time.periods=3"});
            },
            *store, 1, MPI_COMM_WORLD, {});
  MPI_Barrier(MPI_COMM_WORLD);
  int together = 0;
  MPI_Allreduce(&computed, &together, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(together, 9);
  EXPECT_GT(computed, 0);
  EXPECT_TRUE(store->pending(plan).empty());
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) std::filesystem::remove_all(folder);
}

} // namespace
} // namespace undula::training
